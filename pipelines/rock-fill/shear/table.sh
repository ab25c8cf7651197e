#!/bin/sh
# A table of the figures of some cases: table.sh OUT CASE…
set -eu
out=$1; shift
echo '| case | peak angle | residual angle | dilation angle | cracks |'
echo '|---|---|---|---|---|'
for case; do
    figure() { sed -n "s/^| $1 | \(.*\) |$/\1/p" "$out/$case.md"; }
    cracks=$(awk -F, 'NR == 1 { for (k = 1; k <= NF; k++) if ($k == "cracks") at = k } at && NR > 1 && $at > most { most = $at } END { print at ? most + 0 : "–" }' "$out/$case.csv")
    echo "| $case | $(figure 'peak angle') | $(figure 'residual angle') | $(figure 'dilation angle') | $cracks |"
done
