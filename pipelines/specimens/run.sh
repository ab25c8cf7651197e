#!/bin/sh
# Compresses cylinders of glued grains, two at a time, and writes the table, the plot and the picture of docs/evidence/specimens.md: run.sh OUT PAGE.md
# PACKINGS=5 sets how many of each kind there are.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$1; page=$2; docs=$(dirname "$page"); packings=${PACKINGS:-5}
mkdir -p "$out"
# The same packings with bonds and contacts of another ratio of stiffnesses.
pair() {
    "$here/cylinder.sh" "$out/$1" "$1"
    mkdir -p "$out/even-$1"
    cp "$out/$1/pack.mcap" "$out/even-$1/"
    "$here/cylinder.sh" "$out/even-$1" "$1" bond.0.stiffness_ratio=1 contact.0.tangential_ratio=1
}
uneven=; even=
for seed in $(seq "$packings"); do
    pair "$seed" &
    [ $((seed % 2)) = 1 ] || wait
    uneven=$uneven,$out/$seed even=$even,$out/even-$seed
done
wait
specimens_study "$docs/specimens-curves.svg" "k_n/k_s = 2.5=${uneven#,}" "k_n/k_s = 1=${even#,}" > "$out/table.md"
"$here/../stages/section.sh" "$page" table < "$out/table.md"
dem-view "$out/1/run.mcap" --time 0.0087 --bonds --colour broken --camera front --size 720x720 -o "$docs/specimens-broken.png"
