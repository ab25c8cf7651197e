#!/bin/bash
# Compares the engine with LAMMPS, LIGGGHTS and YADE, in turn: the same pile, contact law, time step and cores.
# usage: race.sh OUT   (the tools on PATH)   environment: ROUNDS (3), CORES ("1 2"), WARM (500) and STEPS (1000), PEERS (folder of
# the virtual environment with LAMMPS)
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$(cd "$1" && pwd)
rounds=${ROUNDS:-3} cores=${CORES:-1 2} warm=${WARM:-500} steps=${STEPS:-1000} peers=${PEERS:-$here/build/peers}
# YADE is the slowest by far: it gets a tenth of the steps.
yade_warm=$((warm / 10)) yade_steps=$((steps / 10))
pile=$here/scenes/pile.toml skin=0.0006 grains=50000 dt=1e-5
# Damping goes with √m* here and with m* there, equal for mean grains; and the pile is chaotic.
tolerance=0.03
work=$(mktemp -d "$out/race.XXXXXX")
trap 'rm -rf "$work"' EXIT
cd "$work"

at() { awk -v n="$1" -v dt=$dt 'BEGIN { printf "%.8g", n * dt }'; }
rate() { awk -v g=$grains -v n="$1" -v s="$2" 'BEGIN { printf "%.3f", g * n / s / 1e6 }'; }
seconds() { awk -F'[:,]' '/"seconds":/ { print $2 }' "$1"; }

# Time of a long run less that of a short one: reading, first lists and the last frame are in both. Frames go nowhere.
ours() {
    local threads=$1; shift
    dem-run "$pile" -q --threads "$threads" --set output.every=1e9 "$@" --until "$(at $((warm + steps)))" --report long.json > /dev/null
    dem-run "$pile" -q --threads "$threads" --set output.every=1e9 "$@" --until "$(at $warm)" --report short.json > /dev/null
    rate "$steps" "$(awk -v a="$(seconds long.json)" -v b="$(seconds short.json)" 'BEGIN { print a - b }')"
}
run_dem-run() { echo "$(ours "$1") -"; }
run_dem-run-skin() { echo "$(ours "$1" --set neighbours.skin=$skin) -"; }

# Speed by the engine's own clock, and kinetic energy [J], both of the second run of a log.
of_log() {
    awk -v g=$grains -v n="$steps" '/^Loop time of/ { time = $4; energy = last } /^ *[0-9]+ +[0-9.e+-]+ *$/ { last = $2 }
        END { printf "%.3f %s\n", g * n / time / 1e6, energy }'
}
run_LAMMPS() {
    LD_LIBRARY_PATH=$peers/lib OMP_NUM_THREADS=1 mpirun.mpich -np "$1" "$peers/bin/lmp" -log none -var warm "$warm" -var steps "$steps" \
        -in "$here/peers/lammps-pile.in" | of_log
}
# The deck that dem-lammps writes: the very same scene, dashpots and floor included; the race's own deck has LAMMPS' fastest style for this law.
export_deck() {
    dem-lammps "$pile" -q --set output.every=1e9 --set neighbours.skin=$skin --until "$(at $((warm + steps)))" --write-deck export
    # No dumps; two runs, of which the second is timed.
    sed -e '/^dump/d' -e "s/^thermo [0-9]*$/thermo $steps/" \
        -e "s/^run [0-9]* upto$/run $warm upto\nrun $((warm + steps)) upto/" export/run.in > export/race.in
    [ "$(grep -c '^run' export/race.in)" = 2 ] || { echo "race: the deck of dem-lammps has another form: export/run.in" >&2; exit 1; }
}
run_LAMMPS-export() {
    (cd export && LD_LIBRARY_PATH=$peers/lib OMP_NUM_THREADS=1 mpirun.mpich -np "$1" "$peers/bin/lmp" -log none -var keep 0 -in race.in) | of_log
}
run_LIGGGHTS() {
    OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 mpirun.openmpi -np "$1" liggghts -log none -var warm "$warm" -var steps "$steps" \
        -in "$here/peers/liggghts-pile.in" | of_log
}
run_YADE() {
    PILE=pile.csv WARM=$yade_warm STEPS=$yade_steps yade -j"$1" -n -x "$here/peers/yade-pile.py" 2> /dev/null | tail -n 1
}

# Which peers are here; the others are named and left out.
has() { command -v "$1" > /dev/null; }
engines=(dem-run dem-run-skin)
missing() { echo "$1 is left out: $2"; }
if has python3; then
    python3 "$here/peers/pile_deck.py" "$here/../sample-data/pile/pile50k.ply" .
    if ! [ -x "$peers/bin/lmp" ]; then missing LAMMPS "make -C pipelines peers installs it"
    elif ! [ -e "$peers/lib/libmpi.so.12" ] || ! has mpirun.mpich; then missing LAMMPS "mpich is missing; then make -C pipelines peers"
    else export_deck; engines+=(LAMMPS LAMMPS-export); fi
    if has liggghts && has mpirun.openmpi; then engines+=(LIGGGHTS); else missing LIGGGHTS "liggghts or openmpi-bin is missing"; fi
    if has yade; then engines+=(YADE); else missing YADE "yade is missing"; fi
else
    missing "every peer" "python3, which writes their decks, is missing"
fi

echo
echo "$grains spheres, $steps steps after $warm (YADE: $yade_steps after $yade_warm), millions of particle-steps a second"
for c in $cores; do
    for ((round = 1; round <= rounds; round++)); do
        for engine in "${engines[@]}"; do
            read -r speed energy < <("run_$engine" "$c") || { echo "$engine failed on $c core(s)"; continue; }
            echo "$c $engine $round $speed $energy" >> results
            echo "  $c core(s), round $round: $engine $speed"
        done
    done
done

echo
awk -v rounds="$rounds" '
    function median(list,   n, i, j, t, a) {
        n = split(list, a, " ")
        for (i = 2; i <= n; i++) for (j = i; j > 1 && a[j] + 0 < a[j - 1] + 0; j--) { t = a[j]; a[j] = a[j - 1]; a[j - 1] = t }
        return n % 2 ? a[(n + 1) / 2] : (a[n / 2] + a[n / 2 + 1]) / 2
    }
    { key = $1 " " $2; if (!(key in speeds)) order[++n] = key; speeds[key] = speeds[key] " " $4; at[key, $3] = $4 }
    END {
        printf "%-5s %-14s %8s %22s %22s\n", "cores", "engine", "median", "dem-run : it", "dem-run, their skin : it"
        for (k = 1; k <= n; k++) {
            split(order[k], part, " "); own = ""; skin = ""
            for (r = 1; r <= rounds; r++) if (at[order[k], r] > 0) {
                own = own " " at[part[1] " dem-run", r] / at[order[k], r]
                skin = skin " " at[part[1] " dem-run-skin", r] / at[order[k], r]
            }
            printf "%-5s %-14s %8.3f %22.2f %22.2f\n", part[1], part[2], median(speeds[order[k]]), median(own), median(skin)
        }
        print "Ratios are medians of the ratios within each round; dem-run-skin has the peers'\'' list range of 0.6 mm."
    }' results

echo
every=$(awk -v a="$yade_warm" -v b="$yade_steps" -v c="$warm" -v d="$steps" 'function g(x, y) { return y ? g(y, x % y) : x }
    BEGIN { print g(g(a + b, c), d) }')
dem-run "$pile" -q --set output.energy=true --set output.every="$(at "$every")" --until "$(at $((warm + steps)))" -o ours.mcap
dem-measure -q ours.mcap --energy > ours.csv
energy_at() { awk -F, -v t="$(at "$1")" 'NR > 1 && ($1 - t) ^ 2 < 1e-14 { print $2 }' ours.csv; }
awk -v tolerance=$tolerance -v late="$(energy_at $((warm + steps)))" -v early="$(energy_at $((yade_warm + yade_steps)))" '
    $5 != "-" && !seen[$2]++ {
        ours = $2 == "YADE" ? early : late; off = $5 / ours - 1
        good = off < tolerance && off > -tolerance
        printf "kinetic energy of translation after the run: dem-run %.4e J, %s %.4e J, %+.1f %%: %s\n", ours, $2, $5, 100 * off, good ? "agrees" : "DIFFERS"
        bad += !good
    }
    END { printf "tolerance %.0f %%\n", 100 * tolerance; exit bad > 0 }' results
