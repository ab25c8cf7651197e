#!/bin/sh
# Crushes stones of three sizes and writes the tables, the plot and the picture of docs/evidence/stones.md: run.sh OUT PAGE.md [STONES]
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$1; page=$2; stones=${3:-${STONES:-200}}
docs=$(dirname "$page")
mkdir -p "$out"
"$here/stones.sh" "$out/strengths.csv" "$stones" 0.005 0.007 0.010
stones_study "$docs/stones-weibull.svg" "$out/strengths.csv" > "$out/tables.md"
"$here/../stages/section.sh" "$page" strengths < "$out/tables.md"
# The picture.
cp "$here/crush.toml" "$out/"
measured=$(awk -v seed=3 -v diameter=0.007 -v grain=0.001 -v missing=0.15 -f "$here/stone.awk" 2>&1 > "$out/stone.csv")
dem-run "$out/crush.toml" --set "wall.1.plane=0,0,${measured% *},0,0,-1" -q -o "$out/crushed.mcap"
dem-view "$out/crushed.mcap" --bonds --colour broken --camera front --size 960x540 -o "$docs/stones-crushed.png"
