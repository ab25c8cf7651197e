#!/usr/bin/env bash
# Oblique impact of one sphere: impact.sh prints the table. Measured points of Kharaz et al. (2001) and the curve of MFIX (case DEM05), as the
# example "Oblique wall impact" of Lethe publishes them: angle from the normal [°], value.
set -euo pipefail
cd "$(dirname "$0")"
source ./runs.sh
MEASURED='
rebound 4.096 2.962
rebound 9.826 6.518
rebound 20.567 12.208
rebound 30.29 21.67
rebound 39.535 32.613
rebound 49.747 45.125
rebound 60.208 57.474
tangential 3.703 0.74533
tangential 9.496 0.67257
tangential 20.012 0.59691
tangential 30.127 0.68756
tangential 39.382 0.77148
tangential 49.694 0.84761
tangential 60.02 0.90142
spin 6.143 136.18
spin 10.991 265.69
spin 21.251 577.65
spin 31.157 612.88
spin 39.143 595.49
spin 50.348 453.21
spin 60.328 382.09'
MFIX='3.203 .965 4.522 .94 8.984 .72 9.775 .70475 19.777 .617 22.932 .626 28.02 .658 30.416 .687 39.107 .7773 49.977 .844 60.747 .897'

echo '| | angle | measured | MFIX | Grainpipe | difference from measured |'
echo '|---|---|---|---|---|---|'
while read -r kind angle value; do
  velocity=$(awk -v a="$angle" 'BEGIN { a *= atan2(0, -1) / 180; printf "[%.12g,0,%.12g]", 3.9 * sin(a), -3.9 * cos(a) }')
  scene "impact-$angle" impact --set "fill.0.velocity=$velocity"
  dem-measure "$OUT/impact-$angle.mcap" --profile --axis z --bins 1 --field wy --last -q | tail -1 | tr , ' ' |
    awk -v kind="$kind" -v angle="$angle" -v value="$value" -v mfix="$MFIX" '{
      pi = atan2(0, -1)
      names["rebound"] = "angle of rebound [°]"; names["tangential"] = "v_t′/v_t"; names["spin"] = "spin [rad/s]"
      digits = kind == "tangential" ? 3 : 1
      found = kind == "rebound" ? atan2($7, $9) * 180 / pi : kind == "spin" ? $NF : $7 / (3.9 * sin(angle * pi / 180))
      other = "–"
      n = split(mfix, m, " ")
      if (kind == "tangential") for (i = 1; i + 3 <= n; i += 2) if (m[i] <= angle && angle < m[i + 2])
        other = sprintf("%.3f", m[i + 1] + (m[i + 3] - m[i + 1]) * (angle - m[i]) / (m[i + 2] - m[i]))
      printf "| %s | %.1f° | %.*f | %s | **%.*f** | %+.1f %% |\n", names[kind], angle, digits, value, other, digits, found, 100 * (found / value - 1)
    }'
done <<< "${MEASURED#?}"
