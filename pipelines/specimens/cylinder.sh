#!/bin/sh
# Packs a cylinder of grains, glues it and compresses it along its axis: cylinder.sh FOLDER SEED [KEY=VALUE…]
# KEY=VALUE changes crush.toml. FOLDER gets pack.mcap, run.mcap, force.csv (on the upper plate), strain.csv (of the grains in the middle half of the height),
# cracks.csv, and size.csv with height [m], area [m²] and porosity of the packing.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$1; seed=$2; shift 2
mkdir -p "$out"
cp "$here/pack.toml" "$here/crush.toml" "$out/"
"$here/../once.sh" "$out/pack.mcap" dem-run "$out/pack.toml" --set "fill.0.seed=$seed" --threads 1 -q
# Where the lid has come to rest.
height=$(dem-measure "$out/pack.mcap" --wall-force all --instants --wall lid -q |
    awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k ~ /^shift_z/) at = k } { last = $at } END { printf "%.6g", 0.18 + last }')
porosity=$(dem-measure "$out/pack.mcap" --porosity "cylinder:0,0,0.01,0,0,$(awk -v h="$height" 'BEGIN { print h - 0.01 }'),0.02" --last -q | awk -F, 'END { print $2 }')
printf 'height,area,porosity\n%s,0.00196350,%s\n' "$height" "$porosity" > "$out/size.csv"
for set; do set -- "$@" --set "$set"; shift; done
dem-run "$out/crush.toml" --set "wall.1.plane=0,0,$height,0,0,-1" --set "bond.0.seed=$seed" "$@" --threads 1 -q -o "$out/run.mcap"
dem-measure "$out/run.mcap" --wall-force all --instants --wall upper -q -o "$out/force.csv"
middle=$(awk -v h="$height" 'BEGIN { printf "box:-1,-1,%g,1,1,%g", h / 4, 3 * h / 4 }')
dem-measure "$out/run.mcap" --strain --within "$middle" -q -o "$out/strain.csv"
dem-measure "$out/run.mcap" --cracks -q -o "$out/cracks.csv"
