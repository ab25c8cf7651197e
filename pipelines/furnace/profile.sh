#!/usr/bin/env bash
# Tables of burdens over the radius, of one or more seeds: means, with 95 % intervals (Student) where there are several.
#
#   profile.sh NAME… -- SEED-FOLDER…      reads SEED-FOLDER/NAME.csv, which dem-measure --radial wrote
set -euo pipefail
names=()
while [ "$1" != -- ]; do names+=("$1"); shift; done
shift
files=()
for name in "${names[@]}"; do for folder in "$@"; do files+=("$folder/$name.csv"); done; done
awk -F, -v names="${names[*]}" '
function shown(name, ring, what, digits,    n, k, sum, square, mean, half) {
  n = split(seen[name, ring, what], value, " ")
  for (k = 1; k <= n; k++) sum += value[k]
  mean = sum / n
  if (n < 2) return sprintf("%." digits "f", mean)
  for (k = 1; k <= n; k++) square += (value[k] - mean) ^ 2
  half = (n in student ? student[n] : 1.96) * sqrt(square / (n - 1) / n)
  return sprintf("%." digits "f ± %." digits "f", mean, half)
}
BEGIN { split("0 12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262", student, " ") }
FNR == 1 {
  split("", column); for (k = 1; k <= NF; k++) { head = $k; sub(/ *\[.*/, "", head); column[head] = k }
  name = FILENAME; sub(/.*\//, "", name); sub(/\.csv$/, "", name)
  next
}
{
  ring = FNR - 1; if (ring > rings) rings = ring
  range[ring] = sprintf("%.1f–%.1f", $column["inner"], $column["outer"])
  seen[name, ring, "height"] = seen[name, ring, "height"] " " 1000 * $column["height"]
  seen[name, ring, "share"] = seen[name, ring, "share"] " " 100 * $column["share_ore"]
  seen[name, ring, "mass"] = seen[name, ring, "mass"] " " $column["mass"]
}
END {
  count = split(names, name_of, " ")
  split("height mass share", what_of, " "); split("Height [mm]|Mass [kg]|Ore, share of the mass [%]", title, "|")
  for (w = 1; w <= 3; w++) {
    printf "%s:\n\n| r [m] |", title[w]
    for (k = 1; k <= count; k++) printf " %s |", name_of[k]
    printf "\n|---|"; for (k = 1; k <= count; k++) printf "---|"
    print ""
    for (ring = 1; ring <= rings; ring++) {
      printf "| %s |", range[ring]
      for (k = 1; k <= count; k++) printf " %s |", shown(name_of[k], ring, what_of[w], 0)
      print ""
    }
    print ""
  }
}' "${files[@]}"
