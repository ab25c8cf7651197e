#!/bin/bash
# Adds the bench that `make bench` wrote last to a history, a line of JSON a run, and draws the speeds of its pile over the runs.
# usage: bench-history.sh PAGE.md HISTORY.jsonl [PLOT.svg]   environment: MACHINE (default: the processor's name), DATE, COMMIT
# bench/README.md lists the fields. The plot needs two lines.
set -euo pipefail
page=$1 history=$2 plot=${3:-}
date=${DATE:-$(date -u +%F)} commit=${COMMIT:-$(git rev-parse --short HEAD)}
machine=${MACHINE:-$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo 2> /dev/null | head -n 1)}
line=$(awk -F' *[|] *' -v date="$date" -v commit="$commit" -v machine="$machine" '
    function text(s) { gsub(/[\\"]/, "\\\\&", s); gsub(/[[:cntrl:]]/, " ", s); return "\"" s "\"" }
    /<!-- bench begins -->/ { inside = 1 } /<!-- bench ends -->/ { inside = 0 }
    inside && NF > 10 && $6 ~ /^[0-9.]+$/ {
        name = text($2 == "pile" ? "pile of " $3 : $2); rows++
        speed = speed (rows > 1 ? "," : "") name sprintf(":[%s,%s]", $6, $7)
        ratio = ratio (rows > 1 ? "," : "") name sprintf(":%.3f", $7 / $6)
    }
    inside && /wall spheres, one pipe: / { chain = $0; sub(/.*one pipe: /, "", chain); sub(/ s .*/, "", chain) }
    END {
        if (!rows) { print "no table of the bench" > "/dev/stderr"; exit 1 }
        printf "{\"date\":%s,\"commit\":%s,\"machine\":%s,\"source\":\"docs/evidence/cost.md\",", text(date), text(commit), text(machine ? machine : "unknown")
        printf "\"speed\":{%s},\"ratio\":{%s},\"chain\":%s}\n", speed, ratio, chain == "" ? "null" : chain + 0
    }' "$page") || { echo "bench-history.sh: $page: no table of the bench between its comments: run make bench" >&2; exit 1; }
if [ -e "$history" ] && grep -qxF "$line" "$history"; then
    echo "bench-history.sh: $history: this run is there already" >&2
else
    printf '%s\n' "$line" >> "$history"
fi
runs=$(wc -l < "$history")
[ -n "$plot" ] || exit 0
if [ "$runs" -lt 2 ]; then
    echo "bench-history.sh: $history has $runs line: a plot needs two" >&2
    exit 0
fi
# Speeds of "+ sliding friction", which is the bench pile, on one thread and on two.
sed -n 's/.*"date":"\([^"]*\)".*"+ sliding friction":\[\([0-9.]*\),\([0-9.]*\)\].*/\1 \2 \3/p' "$history" | awk '
    { date[NR] = $1; one[NR] = $2; two[NR] = $3; if ($3 > top) top = $3; if ($2 > top) top = $2 }
    function x(i) { return 60 + (NR > 1 ? (i - 1) * 560 / (NR - 1) : 0) }
    function y(v) { return 260 - v / top * 220 }
    function curve(values, colour, name,   i, path) {
        for (i = 1; i <= NR; i++) {
            path = path (i > 1 ? " L" : "M") sprintf("%.1f %.1f", x(i), y(values[i]))
            printf "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"3\" fill=\"%s\"/>\n", x(i), y(values[i]), colour
        }
        printf "<path d=\"%s\" fill=\"none\" stroke=\"%s\" stroke-width=\"1.5\"/>\n", path, colour
        printf "<text x=\"632\" y=\"%.1f\">%s</text>\n", y(values[NR]) + 4, name
    }
    END {
        print "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 310\" font-family=\"sans-serif\" font-size=\"12\">"
        print "<rect width=\"720\" height=\"310\" fill=\"white\"/>"
        print "<text x=\"60\" y=\"24\">bench pile: millions of particle-steps a second</text>"
        for (k = 0; k <= 4; k++) {
            printf "<path d=\"M60 %.1f H620\" stroke=\"#ddd\"/>\n", y(top * k / 4)
            printf "<text x=\"52\" y=\"%.1f\" text-anchor=\"end\">%.1f</text>\n", y(top * k / 4) + 4, top * k / 4
        }
        curve(one, "#2a6f97", "1 thread"); curve(two, "#c1121f", "2 threads")
        printf "<text x=\"60\" y=\"290\">%s</text>\n", date[1]
        printf "<text x=\"620\" y=\"290\" text-anchor=\"end\">%s</text>\n", date[NR]
        print "</svg>"
    }' > "$plot"
