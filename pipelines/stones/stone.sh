#!/bin/sh
# Crushes one stone between plates and prints a row for stones.sh: stone.sh DIAMETER SEED
# Strength is the largest force on the upper plate up to a strain of 4 %, over the square of the diameter (Jaeger 1967, doi:10.1016/0148-9062(67)90046-0).
set -eu
here=$(cd "$(dirname "$0")" && pwd)
diameter=$1; seed=$2
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
cp "$here/crush.toml" "$work/"
measured=$(awk -v seed="$seed" -v diameter="$diameter" -v grain=0.001 -v missing=0.15 -f "$here/stone.awk" 2>&1 > "$work/stone.csv")
height=${measured% *}; grains=${measured#* }
until=$(awk -v d="$diameter" 'BEGIN { print 0.04 * d / 0.1 }')
dem-run "$work/crush.toml" --set "wall.1.plane=0,0,$height,0,0,-1" --set "time.until=$until" --threads 1 -q -o "$work/run.mcap"
force=$(dem-measure "$work/run.mcap" --wall-force all --instants --wall upper 2> "$work/words" | awk -F, 'NR > 1 && $6 > most { most = $6 } END { print most }')
cracks=$(dem-measure "$work/run.mcap" --cracks 2> "$work/words" | awk 'END { print NR - 1 }')
awk -v d="$diameter" -v s="$seed" -v n="$grains" -v f="$force" -v c="$cracks" 'BEGIN { printf "%s,%d,%d,%.6g,%.6g,%d\n", d, s, n, f, f / d / d, c }'
