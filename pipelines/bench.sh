#!/bin/bash
# Times the chain from scan to walls and the engine on the bench pile; beside it LIGGGHTS, where it is installed, in turn.
# usage: bench.sh OUT   (the tools on PATH)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$(cd "$1" && pwd)
pile=$here/scenes/pile.toml

now() { date +%s.%N; }
since() { awk -v a="$1" -v b="$(now)" 'BEGIN { printf "%.2f", b - a }'; }

echo "chain: 277 647 points -> wall spheres, one pipe"
chute-scan --points 277647 -q -o "$out/bench.ply"
for _ in 1 2 3; do
    start=$(now)
    cloud-crop -q "$out/bench.ply" --remove halfspace:0,0,0,-1,0,0 | cloud-fill -q | bluenoise-sample -q --spacing 0.005 \
        | wallgen -q --roughness 0.001 -o "$out/bench.mcap"
    echo "  $(since "$start") s"
done

# Steps of the whole run less those of a run of one step: reading, listing and writing are in both.
ours() {
    local reports=("$out/bench-long.json" "$out/bench-short.json")
    dem-run "$pile" -q --threads "$1" -o "$out/bench.mcap" --report "${reports[0]}"
    dem-run "$pile" -q --threads "$1" --until 1e-5 -o "$out/bench.mcap" --report "${reports[1]}"
    awk -F'[:,]' '/"seconds"/ { s[n++] = $2 } END { printf "%.2f", 50000 * 999 / (s[0] - s[1]) / 1e6 }' "${reports[@]}"
}

theirs() {
    (cd "$out" && mpirun --allow-run-as-root -np "$1" liggghts -in "$here/peers/liggghts-pile.in" \
        | awk '/Loop time/ { t = $4 } END { printf "%.2f", 50000 * 1000 / t / 1e6 }')
}

echo "engine: bench pile, 50 000 spheres, 1000 steps, millions of particle-steps a second"
command -v liggghts > /dev/null && python3 "$here/peers/pile_deck.py" "$here/../sample-data/pile/pile50k.ply" "$out/pile.liggghts"
for threads in 1 2; do
    for _ in 1 2 3; do
        a=$(ours "$threads")
        if command -v liggghts > /dev/null; then
            b=$(theirs "$threads")
            echo "  $threads core(s): dem-run $a, LIGGGHTS $b, ratio $(awk -v a="$a" -v b="$b" 'BEGIN { printf "%.2f", a / b }')"
        else
            echo "  $threads core(s): dem-run $a (LIGGGHTS is not installed)"
        fi
    done
done
rm -f "$out"/bench* "$out/pile.liggghts"
