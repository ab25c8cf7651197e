#!/usr/bin/env bash
# Slot hopper: slot.sh prints the table. SEEDS are the packings at a modulus of 1e6 Pa, HARD those at 1e7 Pa.
set -euo pipefail
cd "$(dirname "$0")"
source ./runs.sh
SEEDS=${SEEDS:-1 2 3 4 5} HARD=${HARD-1 2 3 4 5}
# Mass that has left [g] after the gate opened [s], as Lethe's example publishes it for Anand et al. (2008): from 0.25 to 0.75 s.
PUBLISHED='0.26721 21.084 0.33346 26.292 0.39929 31.4 0.46142 36.69 0.52397 41.939 0.58611 47.209 0.65194 52.499 0.71737 57.809'

rate() { dem-measure "$OUT/$1.mcap" --flow=0,0,-0.03,0,0,-1 --from 1.25 --until 1.75 --json -q > "$OUT/$1.flow"; summary "$OUT/$1.flow" mass_flow; }
for seed in $SEEDS; do scene slot-1e6-$seed slot --set insert.0.seed=$seed; echo "1e6 $(rate slot-1e6-$seed)"; done > "$OUT/slot.values"
for seed in $HARD; do
  scene slot-1e7-$seed slot --set insert.0.seed=$seed --set material.0.young=1e7 --set material.1.young=1e7
  echo "1e7 $(rate slot-1e7-$seed)"
done >> "$OUT/slot.values"
intervals < "$OUT/slot.values" | awk -v points="$PUBLISHED" '
  BEGIN {
    n = split(points, p, " ")
    for (i = 1; i < n; i += 2) { s++; x += p[i]; y += p[i + 1]; xx += p[i]^2; xy += p[i] * p[i + 1] }
    paper = (s * xy - x * y) / (s * xx - x * x)
    print "| | modulus [Pa] | packings | flow [g/s] | difference from the paper |\n|---|---|---|---|---|"
    printf "| Anand et al. 2008: line through the points from 0.25 to 0.75 s | | | %.1f | |\n", paper
    printf "| Lethe, periodic slice | 1e6 | 1 | 91.73 | %+.1f %% |\n", 100 * (91.73 / paper - 1)
    printf "| Lethe, six times as deep, with walls | 1e6 | 1 | 85.09 | %+.1f %% |\n", 100 * (85.09 / paper - 1)
  }
  { printf "| **Grainpipe**, periodic slice | %s | %d | **%.1f ± %.1f** | %+.1f %% |\n", $1, $2, 1000 * $3, 1000 * $4, 100 * (1000 * $3 / paper - 1) }'
