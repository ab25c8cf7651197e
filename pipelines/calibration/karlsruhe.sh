#!/usr/bin/env bash
# karlsruhe.sh FOUND.csv FOLDER: what parameters from karlsruhe.toml say of triaxial tests at stresses that they were not fitted to, beside the measured
# ones: a table. GRAINS=1000 and SEEDS=3 set the specimens.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
data=$here/../../sample-data/karlsruhe-sand
best() { awk -F, -v name="$1" '$1 == name { print $6 }' "$found"; }
found=$1
lab-test triaxial-periodic "$here/fine-sand.toml" --stress '50 kPa,100 kPa,200 kPa,400 kPa' --strain 0.15 --grains "${GRAINS:-1000}" --seeds "${SEEDS:-3}" --seed 5001 \
  --friction "$(best packing)" --set material.0.young="$(best young)" --set contact.0.sliding_friction="$(best sliding)" \
  --set contact.0.rolling_resistance="$(best rolling)" -q --dir "$2" -o "$2.csv"
# Of each stress: largest q/(q + 2 σ3) as an angle, secant stiffness to half of the peak, and dilation at 15 % strain; simulated: mean and range.
awk -F, '
  function asin(x) { return 57.29578 * atan2(x, sqrt(1 - x * x)) }
  FNR == 1 { measured = FILENAME ~ /tmd[0-9]+-[0-9]+kPa.csv$/; scale = measured ? 1 : 0.001; percent = measured ? 1 : 100
    if (measured) { match(FILENAME, /[0-9]+kPa.csv$/); stress = substr(FILENAME, RSTART, RLENGTH - 7) }
    for (k = 1; k <= NF; k++) { name = $k; sub(/ .*/, "", name); column[name] = k }
    next }
  { if (!measured) stress = $1 / 1000
    key = stress " " (measured ? "m" : $2); strain = percent * $column["axial_strain"]
    if (strain > 15) next
    q = scale * $column["deviator_stress"]; volume = percent * $column["volumetric_strain"]
    if (!(key in peak)) { keys[++n] = key }
    if (q > peak[key]) peak[key] = q
    rows[key]++; e[key, rows[key]] = strain; s[key, rows[key]] = q; end[key] = volume }
  END {
    for (k = 1; k <= n; k++) { key = keys[k]; split(key, part, " "); p = part[1]
      half = peak[key] / 2
      for (r = 1; r <= rows[key] && s[key, r] < half; r++);
      # Between two rows, from no stress at no strain.
      q0 = r > 1 ? s[key, r - 1] : 0; e0 = r > 1 ? e[key, r - 1] : 0
      at = e0 + (e[key, r] - e0) * (half - q0) / (s[key, r] - q0)
      v[1] = asin(peak[key] / (peak[key] + 2 * p)); v[2] = half / at / 10; v[3] = -end[key]
      kind = part[2] == "m" ? "m" : "s"
      for (f = 1; f <= 3; f++) { count[p, kind, f]++; sum[p, kind, f] += v[f]
        if (!((p, kind, f) in low) || v[f] < low[p, kind, f]) low[p, kind, f] = v[f]
        if (!((p, kind, f) in high) || v[f] > high[p, kind, f]) high[p, kind, f] = v[f] } }
    print "| stress [kPa] | peak angle [°], measured | simulated | stiffness E50 [MPa], measured | simulated | dilation at 15 % [%], measured | simulated |"
    print "|---|---|---|---|---|---|---|"
    split("50 100 200 400", all, " ")
    for (k = 1; k <= 4; k++) { p = all[k]; line = "| " p (p == 100 ? " (fitted)" : "")
      for (f = 1; f <= 3; f++) line = line sprintf(" | %.1f | %.1f (%.1f to %.1f)", sum[p, "m", f], sum[p, "s", f] / count[p, "s", f], low[p, "s", f], high[p, "s", f])
      print line " |" } }' "$data"/tmd*.csv "$2.csv"
