#!/usr/bin/env bash
# Collapse of a column: collapse.sh prints the table. COUNTS are the numbers of grains, which set the height; SEEDS the packings.
set -euo pipefail
cd "$(dirname "$0")"
source ./runs.sh
COUNTS=${COUNTS:-565 1130 2260 3390} SEEDS=${SEEDS:-1 2 3 4 5}

# column NAME: aspect ratio, run-out to the edge of a full layer and of half a layer, final height, all over the first width. The deposit is the
# solid thickness in bins of one diameter; a full layer is 0.6 diameters of solid. The final height is that at the back, at the first density.
column() {
  local box=box:0,0,0,0.4,0.01,0.4
  dem-measure "$OUT/$1.mcap" --bed-height --time 0.45 --json -q > "$OUT/$1.height"
  { dem-measure "$OUT/$1.mcap" --profile --axis x --bins 160 --within $box --time 0.45 -q | sed 1d
    dem-measure "$OUT/$1.mcap" --profile --axis x --bins 160 --within $box --last -q | sed 1d; } | tr , ' ' |
    awk -v start="$(summary "$OUT/$1.height" height)" '
      { solid = $5 * 0.4 }
      NR <= 16 { before += solid / 16 }
      NR == 161 || NR == 162 { back += solid / 2 }
      NR > 160 { for (k = 1; k <= 2; k++) { level = 0.0015 / k; if (!edge[k] && solid < level) edge[k] = last_x + 0.0025 * (last - level) / (last - solid) }
        last = solid; last_x = $2 }
      END { w = 0.04; print start / w, edge[1] / w - 1, edge[2] / w - 1, back / before * start / w }'
}
for count in $COUNTS; do
  top=$(awk -v n="$count" 'BEGIN { printf "%.3f", 0.001 + n * 1e-4 }')
  for seed in $SEEDS; do
    scene collapse-$count-$seed collapse --set fill.0.seed=$seed --set fill.0.count=$count --set "fill.0.shape=\"box:0,0,0.001,0.04,0.01,$top\""
    column collapse-$count-$seed | awk -v n="$count" '{ print n ".a", $1; print n ".full", $2; print n ".half", $3; print n ".height", $4 }'
  done
done > "$OUT/collapse.values"
intervals < "$OUT/collapse.values" | awk '
  { split($1, key, "."); if (key[2] == "a") order[++n] = key[1]; mean[$1] = $3; off[$1] = $4; packings = $2 }
  END {
    print "| aspect ratio a | run-out, law of Lube et al. 2005 | Grainpipe, to the edge of a full layer | difference | to the edge of half a layer | final height, law | Grainpipe | difference |\n|---|---|---|---|---|---|---|---|"
    for (i = 1; i <= n; i++) { c = order[i]; a = mean[c ".a"]
      tall = a > 2.8; law = tall ? 1.9 * a^(2/3) : 1.2 * a; high = a > 1 ? a^0.4 : a
      printf "| %.2f ± %.2f | %s = %.2f | **%.2f ± %.2f** | %+.0f %% | %.2f ± %.2f | %s = %.2f | **%.2f ± %.2f** | %+.0f %% |\n", a, off[c ".a"],
        (tall ? "1.9 a^(2/3)" : "1.2 a"), law, mean[c ".full"], off[c ".full"], 100 * (mean[c ".full"] / law - 1), mean[c ".half"], off[c ".half"],
        (a > 1 ? "a^0.4" : "a"), high, mean[c ".height"], off[c ".height"], 100 * (mean[c ".height"] / high - 1) }
    printf "\n%d packings each; intervals are 95 %% (Student). Run-out and height are over the first width.\n", packings
  }'

# Exponents of the columns with a > 0.9: of the run-out, and of the first height over the last.
echo
echo '| exponent of a, for a > 0.9 | Balmforth & Kerswell 2005, wide channels | Grainpipe |'
echo '|---|---|---|'
awk '
  BEGIN { split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262 2.228 2.201 2.179 2.160 2.145 2.131 2.120 2.110 2.101", t, " ") }
  { split($1, key, "."); v[key[2]] = $2 }
  key[2] == "height" && v["a"] > 0.9 { n++; x[n] = log(v["a"]); y[1 "," n] = log(v["full"]); y[2 "," n] = log(v["a"] / v["height"]) }
  END {
    names[1] = "run-out | 0.9 ± 0.1"; names[2] = "first height over final height | 0.6"
    for (k = 1; k <= 2; k++) { sx = sy = sxx = sxy = rest = 0
      for (i = 1; i <= n; i++) { sx += x[i]; sy += y[k "," i]; sxx += x[i]^2; sxy += x[i] * y[k "," i] }
      b = (n * sxy - sx * sy) / (n * sxx - sx * sx)
      for (i = 1; i <= n; i++) { off = y[k "," i] - sy / n - b * (x[i] - sx / n); rest += off * off }
      printf "| %s | **%.2f ± %.2f** (%d runs) |\n", names[k], b, t[(n > 20 ? 18 : n - 2)] * sqrt(rest / (n - 2) / (sxx - sx * sx / n)), n }
  }' "$OUT/collapse.values"
