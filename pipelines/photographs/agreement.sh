#!/usr/bin/env bash
# agreement.sh HULL.json REFINED.json LEAST: a row for each photograph that did not carve, with its intersection over union in percent;
# fails when the mean after refinement is below LEAST.
set -euo pipefail
hull=$1 refined=$2 least=$3
# Lines of NAME PERCENT from the part held_out of a report.
held_out() {
  awk -F'"' '/"held_out"/ { inside = 1 } inside && /"photograph"/ { name = $4 }
    inside && /"union"/ { split($3, value, /[:, ]+/); printf "%s %.1f\n", name, 100 * value[2] }' "$1"
}
echo "| photograph | hull [%] | refined [%] |"
echo "|---|---|---|"
join <(held_out "$hull") <(held_out "$refined") | awk -v least="$least" '
  { printf "| %s | %s | %s |\n", $1, $2, $3; hull += $2; refined += $3 }
  END {
    if (NR == 0) { print "agreement.sh: no photograph was held out: give --hold-out" > "/dev/stderr"; exit 1 }
    printf "| mean | %.1f | %.1f |\n", hull / NR, refined / NR
    if (refined / NR < least) { print "agreement.sh: the mean is below " least " %" > "/dev/stderr"; exit 1 }
  }'
