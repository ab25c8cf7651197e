#!/usr/bin/env bash
# Rotating drum: drum.sh prints the table. SEEDS are the packings.
set -euo pipefail
cd "$(dirname "$0")"
source ./runs.sh
SEEDS=${SEEDS:-1 2 3 4 5}
# The drum: a cylinder of 0.12 m with 90 grooves of 1.5 mm, half a bead, one period deep.
awk -v n=180 -v w=0.012 'BEGIN { pi = atan2(0, -1)
  print "ply\nformat ascii 1.0\nelement vertex " 2 * n "\nproperty double x\nproperty double y\nproperty double z"
  print "element face " n "\nproperty list uchar int vertex_indices\nend_header"
  for (i = 0; i < n; i++) for (k = 0; k < 2; k++) { r = i % 2 ? 0.1185 : 0.12; printf "%.9g %g %.9g\n", r * cos(2 * pi * i / n), k * w, r * sin(2 * pi * i / n) }
  for (i = 0; i < n; i++) { j = (i + 1) % n; print 4, 2 * i, 2 * j, 2 * j + 1, 2 * i + 1 } }' > drum.ply
# Speed along the surface [m/s], positive downhill, at heights [m] on the normal through the axis: measured (particle tracking), as Lethe's example
# publishes it. It changes sign at -0.05943 m.
MEASURED='-0.0413034623217923 0.2544513457556936
-0.04496945010183302 0.19523809523809524
-0.04949083503054992 0.1546583850931677
-0.05389002036659882 0.09089026915113874
-0.06953156822810595 -0.07101449275362326
-0.0818737270875764 -0.11821946169772257
-0.10118126272912428 -0.13602484472049686'

# drum NAME: angle of the surface, height where the speed changes sign, speeds at the measured heights. Cells of 3 mm. The surface is where the
# solid fraction is 0.3, fitted by a line for |x| < 0.07 m; speeds are means of the cells within 3 mm of the normal.
drum() {
  dem-measure "$OUT/$1.mcap" --profile --bins 80,1,80 --within box:-0.12,0,-0.12,0.12,0.012,0.12 --mean --from 1.6 -q | sed 1d | tr , ' ' |
    awk -v heights="$(cut -d' ' -f1 <<< "$MEASURED" | tr '\n' ' ')" '
      { x = $2; z = $4; c++; px[c] = x; pz[c] = z; vx[c] = $7; vz[c] = $9; f[c] = $5; mass[c] = $5 }
      END {
        for (i = 1; i <= c; i++) at[sprintf("%.4f %.4f", px[i], pz[i])] = f[i]
        for (i = 1; i <= c; i++) if (px[i] > -0.07 && px[i] < 0.07 && f[i] >= 0.3) { above = at[sprintf("%.4f %.4f", px[i], pz[i] + 0.003)]
          if (above < 0.3) { z = pz[i] + 0.003 * (f[i] - 0.3) / (f[i] - above); k = sprintf("%.4f", px[i]); if (!(k in top) || z > top[k]) top[k] = z } }
        for (k in top) { n++; sx += k; sz += top[k]; sxx += k * k; sxz += k * top[k] }
        slope = (n * sxz - sx * sz) / (n * sxx - sx * sx); b = atan2(-slope, 1); cb = cos(b); sb = sin(b)
        print "angle", b * 180 / atan2(0, -1)
        for (i = 1; i <= c; i++) { t = px[i] * cb - pz[i] * sb; s = px[i] * sb + pz[i] * cb
          if (t > -0.003 && t < 0.003 && f[i] > 0.1) { k = int((s + 0.15) / 0.003); w[k] += f[i]; ws[k] += f[i] * s; wu[k] += f[i] * (vx[i] * cb - vz[i] * sb) } }
        m = split(heights, h, " "); before = 0
        for (k = 0; k < 100; k++) if (k in w) { s = ws[k] / w[k]; u = wu[k] / w[k]
          if (before) {
            if (last_u < 0 && u >= 0) print "zero", last_s - last_u * (s - last_s) / (u - last_u)
            for (j = 1; j <= m; j++) if (last_s <= h[j] && h[j] < s) print "u" j, last_u + (u - last_u) * (h[j] - last_s) / (s - last_s) }
          before = 1; last_s = s; last_u = u }
      }'
}
for seed in $SEEDS; do scene drum-$seed drum --set fill.0.seed=$seed; drum drum-$seed; done > "$OUT/drum.values"
intervals < "$OUT/drum.values" | awk -v measured="$(tr '\n' ' ' <<< "$MEASURED")" '
  BEGIN { split(measured, p, " ") }
  { mean[$1] = $3; off[$1] = $4; packings = $2 }
  END {
    print "| | measured | Grainpipe | difference | turning with the drum |\n|---|---|---|---|---|"
    printf "| dynamic angle of repose | 27° | **%.1f° ± %.1f°** | %+.1f %% | |\n", mean["angle"], off["angle"], 100 * (mean["angle"] / 27 - 1)
    printf "| depth below the axis where the speed changes sign [mm] | %.1f | **%.1f ± %.1f** | %+.1f %% | |\n", 59.43, -1000 * mean["zero"], 1000 * off["zero"], 100 * (mean["zero"] / -0.05943 - 1)
    for (j = 1; j <= 7; j++) { turning = p[2 * j - 1] * 11.6 * 2 * atan2(0, -1) / 60
      printf "| speed along the surface, %.1f mm below the axis [m/s] | %.3f | **%.3f ± %.3f** | %+.0f %% | %s |\n", -1000 * p[2 * j - 1], p[2 * j],
        mean["u" j], off["u" j], 100 * (mean["u" j] / p[2 * j] - 1), (p[2 * j] < 0 ? sprintf("%.3f", turning) : "") }
    printf "\n%d packings; intervals are 95 %% (Student).\n", packings
  }'
if [ -n "${PAGE:-}" ]; then
  dem-view "$OUT/drum-${SEEDS%% *}.mcap" --time 2.5 --camera front --size 290x242 -o "$(dirname "$PAGE")/validation-drum.png" -q
  printf '\n![The drum after 2.1 s of turning](validation-drum.png)\n'
fi
