#!/usr/bin/env bash
# Penetration of a ball: penetration.sh prints the table. SEEDS are the packings.
set -euo pipefail
cd "$(dirname "$0")"
source ./runs.sh
SEEDS=${SEEDS:-1 2 3 4 5}
RADIUS=0.008
# Height of fall [m] and density [kg/m³] of each impact.
IMPACTS='0.03 7800
0.1 7800
0.3 7800
0.1 2500'

# impact SEED HEIGHT DENSITY: "HEIGHT DENSITY DEPTH DROP" in metres; the drop is from the release to the deepest point. The ball starts 8 mm above the
# median of the surface, with the speed that it has there.
impact() {
  local name=penetration-$1-$2-$3 top
  top=$(dem-measure "$OUT/penetration-bed-$1.mcap" --bed-height -q | tail -1 | cut -d, -f2)
  awk -v top="$top" -v r=$RADIUS -v h="$2" 'BEGIN { print "id,x,y,z,radius,vx,vy,vz"; printf "100000,0.04,0.04,%.9g,%g,0,0,%.9g\n", top + r + 0.008, r, -sqrt(2 * 9.81 * (h - 0.008)) }' \
    > "$OUT/$name.csv"
  scene "$name" penetration --set particles.0.source="\"$OUT/penetration-bed-$1.mcap\"" --set particles.1.source="\"$OUT/$name.csv\"" --set material.1.density="$3"
  dem-measure "$OUT/$name.mcap" --track 100000 -q | awk -F, -v top="$top" -v r=$RADIUS -v h="$2" -v rho="$3" '
    NR > 1 && (low == "" || $5 < low) { low = $5 } END { d = top - low + r; print h, rho, d, h + d }'
}
for seed in $SEEDS; do
  scene penetration-bed-$seed penetration-bed --set insert.0.seed=$seed
  while read -r height density; do line=$(impact $seed "$height" "$density"); echo "$seed $line"; done <<< "$IMPACTS"
done > "$OUT/penetration.values"

echo "| height of fall [mm] | density of the ball [kg/m³] | depth [mm] |"
echo "|---|---|---|"
awk '{ print $2 "," $3, 1000 * $4 }' "$OUT/penetration.values" | intervals | awk '{ split($1, p, ","); printf "| %g | %g | **%.1f ± %.1f** |\n", 1000 * p[1], p[2], $3, $4 }'
# Exponents of each packing: of the drop by least squares, of the density by two balls.
echo
echo "| exponent of the depth | Ambroso et al. 2005 | Grainpipe |"
echo "|---|---|---|"
awk '{ x = log($5); y = log($4); if (!($1 in n)) order[++m] = $1; if ($2 == 0.1) of[$1, $3] = y
    if ($3 == 7800) { n[$1]++; sx[$1] += x; sy[$1] += y; sxx[$1] += x * x; sxy[$1] += x * y } if ($2 == 0.1) drop[$1, $3] = x }
  END { for (i = 1; i <= m; i++) { s = order[i]; e = (n[s] * sxy[s] - sx[s] * sy[s]) / (n[s] * sxx[s] - sx[s] * sx[s]); print "drop", e
      print "density", (of[s, 7800] - of[s, 2500] - e * (drop[s, 7800] - drop[s, 2500])) / log(7800 / 2500) } }' "$OUT/penetration.values" | intervals |
  awk '{ packings = $2; printf "| %s | %s | **%.2f ± %.2f** |\n", $1 == "drop" ? "total drop" : "density of the ball", $1 == "drop" ? "1/3" : "1/2", $3, $4 }
    END { printf "\n%d packings; intervals are 95 %% (Student).\n", packings }'
