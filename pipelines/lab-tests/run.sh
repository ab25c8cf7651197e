#!/bin/sh
# Runs every laboratory test on the samples here and writes tables, plots and pictures of docs/how-to/lab-tests.md: run.sh OUT PAGE.md [GRAINS]
# Finished specimens in OUT are used again.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$1; page=$2; grains=${3:-${GRAINS:-1000}}; seeds=${SEEDS:-3}
docs=$(dirname "$page")
mkdir -p "$out"
run() { # NAME TEST SAMPLE [OPTION…]
    name=$1; test=$2; sample=$3; shift 3
    lab-test "$test" "$sample" --seeds "$seeds" --dir "$out/$name" --plot "$docs/lab-$name.svg" --words "$out/$name.md" -q -o "$out/$name.csv" "$@"
    "$here/../stages/section.sh" "$page" "$name" < "$out/$name.md"
}
run direct-shear direct-shear "$here/sand.toml" --grains "$grains"
run triaxial triaxial "$here/sand.toml" --grains "$grains" --stress 25000,100000
run triaxial-periodic triaxial-periodic "$here/sand.toml" --set "gravity=[0,0,0]" --grains "$grains" --stress 25000,100000
run oedometer oedometer "$here/sand.toml" --grains "$grains"
run uniaxial uniaxial "$here/rock.toml" --grains "$grains"
for test in repose heap drum; do
    run $test $test "$here/sand.toml" --grains "$grains" --set material.0.young=2e6
done
awk -v seed=1 -v diameter=0.007 -v grain=0.001 -v missing=0.15 -f "$here/../stones/stone.awk" > "$out/stone.csv" 2> "$out/stone.words"
seeds=${STONES:-40}
run crush crush "$here/stone.toml" --set "particles.0.source=$(cd "$out" && pwd)/stone.csv"
# Pictures of the first specimens.
dem-view "$out/direct-shear/stress=100000,seed=0/test.mcap" --size 1200x675 -q -o "$docs/lab-direct-shear.png"
dem-view "$out/heap/seed=0/test.mcap" --size 800x600 -q -o "$docs/lab-heap.png"
dem-view "$out/drum/seed=0/test.mcap" --camera front --size 800x600 -q -o "$docs/lab-drum.png"
