#!/usr/bin/env bash
# Silo of the benchmark of open-source codes: silo.sh prints the table. SEEDS are the packings at a modulus of 3e6 Pa, HARD those at 1e7 Pa.
set -euo pipefail
cd "$(dirname "$0")"
source ./runs.sh
SEEDS=${SEEDS:-1 2 3 4 5} HARD=${HARD-}
# The inner surface of the benchmark's silo: a cylinder of 0.1 m and a cone down to the orifice of 0.03 m, 100 facets around.
awk -v n=100 'BEGIN { pi = atan2(0, -1); split("0.1 0.1 0.03", r, " "); split("0.314578 0.0145778 -0.0554222", z, " ")
  print "ply\nformat ascii 1.0\nelement vertex " 3 * n "\nproperty double x\nproperty double y\nproperty double z"
  print "element face " 2 * n "\nproperty list uchar int vertex_indices\nend_header"
  for (k = 1; k <= 3; k++) for (i = 0; i < n; i++) printf "%.9g %.9g %.9g\n", r[k] * cos(2 * pi * i / n), r[k] * sin(2 * pi * i / n), z[k]
  for (k = 0; k < 2; k++) for (i = 0; i < n; i++) { j = (i + 1) % n; print 4, k * n + i, k * n + j, (k + 1) * n + j, (k + 1) * n + i } }' > silo.ply
# Grains per second while 32 000 to 24 000 remain in the silo, and while 80 000 to 60 000, with 1e9 Pa: from the curves that the page "peclet.dem vs the
# DEM8 bulk-process benchmark" publishes (github.com/computational-chemical-engineering/peclet-examples, benchmarks/dem-bulk-dosta2024/data,
# case1_large_M1_*.npz).
PEERS='MUSEN,23787,24583
LIGGGHTS,24003,24868
Peclet (Hertz),23819,24785'

# rate NAME: grains per second while 32 000 to 24 000 of the 36 000 remain.
rate() {
  dem-measure "$OUT/$1.mcap" --flow=0,0,-0.08,0,0,-1 --span 0.01 -q | awk -F, '
    NR == 1 { for (i = 1; i <= NF; i++) { if ($i ~ /^forward/) f = i; if ($i ~ /^to /) u = i; if ($i ~ /^from /) s = i } next }
    { for (k = 4000; k <= 12000; k += 8000) if (out < k && out + $f >= k) at[k] = $s + ($u - $s) * (k - out) / $f; out += $f }
    END { printf "%.6g\n", 8000 / (at[12000] - at[4000]) }'
}
# silo MODULUS SEED
silo() {
  local soft="--set material.0.young=$1 --set material.1.young=$1"
  scene silo-fill-$1-$2 silo-fill $soft --set insert.0.seed=$2
  scene silo-$1-$2 silo $soft --set particles.0.source="\"$OUT/silo-fill-$1-$2.mcap\""
  echo "$1 $(rate silo-$1-$2)"
}
for seed in $SEEDS; do silo 3e6 $seed; done > "$OUT/silo.values"
for seed in $HARD; do silo 1e7 $seed; done >> "$OUT/silo.values"
intervals < "$OUT/silo.values" | awk -v peers="$(tr '\n' ';' <<< "$PEERS")" '
  BEGIN {
    print "| | modulus [Pa] | packings | grains per second, 32 000 to 24 000 left | difference from the mean of the three | 80 000 to 60 000 left |\n|---|---|---|---|---|---|"
    m = split(peers, p, ";"); for (j = 1; j <= m; j++) if (split(p[j], v, ",") == 3) { n++; sum += v[2]; printf "| %s, 100 000 grains | 1e9 | 1 | %.0f | | %.0f |\n", v[1], v[2], v[3] }
  }
  { printf "| **Grainpipe**, 36 000 grains | %s | %d | **%.0f ± %.0f** | %+.1f %% | |\n", $1, $2, $3, $4, 100 * ($3 / sum * n - 1) }'
