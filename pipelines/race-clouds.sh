#!/bin/bash
# Measures the chain from scan to wall spheres, tool by tool and as one pipe, and pymeshlab and Open3D on the same scans.
# usage: race-clouds.sh OUT   (the tools on PATH)   environment: SIZES ("277647 2989048"; above 5000000, such as 50000000, by one pipe
# alone, from a file of 14 bytes a point), ROUNDS (3), LIMIT (6: memory that each tool may use [GB]), PEERS (folder of the virtual
# environment with pymeshlab and Open3D)
# If none of SIZES, ROUNDS and LIMIT is set, the table is also written to docs/evidence/cost.md.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$(cd "$1" && pwd)
whole=$([ -z "${SIZES+x}${ROUNDS+x}${LIMIT+x}" ] && echo yes || echo no)
sizes=${SIZES:-277647 2989048} rounds=${ROUNDS:-3} limit=${LIMIT:-6} peers=${PEERS:-$here/build/peers}
folder=$(mktemp -d "$out/race-clouds.XXXXXX")
trap 'rm -rf "$folder"' EXIT
cd "$folder"

spacing=0.005 roughness=0.001
stages=(cloud-crop cloud-fill bluenoise-sample wallgen)
options_cloud_crop=(--remove halfspace:0,0,0,-1,0,0)
options_cloud_fill=()
# Without the spectrum, which pymeshlab does not measure either.
options_bluenoise_sample=(--spacing $spacing --no-measures)
options_wallgen=(--roughness $roughness)

now() { date +%s.%N; }
median() { sort -g | awk '{ a[NR] = $1 } END { print NR % 2 ? a[(NR + 1) / 2] : (a[NR / 2] + a[NR / 2 + 1]) / 2 }'; }
field() { awk -F'[:,]' -v key="\"$2\"" '{ gsub(/ /, "", $1) } $1 == key { print $2 + 0; exit }' "$1"; }

# run TOOL INPUT OUTPUT: wall seconds, processor seconds; leaves report.json. A tool that wants more memory than the limit fails.
run() {
    local -n options=options_${1//-/_}
    local TIMEFORMAT='%R %U %S'
    { (ulimit -v $((limit * 1000 * 1000)); time "$1" -q "$2" "${options[@]}" -o "$3" --report report.json); } 2> log || { cat log >&2; return 1; }
    awk 'END { print $1, $2 + $3 }' log
}

# The same by one pipe, from a file; each tool leaves its times in TOOL.time and its report in TOOL.json, and the most memory that all had
# together is in `memory` [GB].
large() {
    local size=$1 tool pipe TIMEFORMAT='%R %U %S'
    chute-scan --points "$size" -q -o scan.ply
    local start; start=$(now)
    stage cloud-crop scan.ply | stage cloud-fill | stage bluenoise-sample | stage wallgen > walls.mcap &
    pipe=$!
    echo 0 > memory
    while kill -0 $pipe 2> /dev/null; do
        together >> memory
        sleep 0.05
    done
    wait $pipe
    whole_pipe=$(awk -v a="$start" -v b="$(now)" 'BEGIN { print b - a }')
    for tool in "${stages[@]}"; do
        cp $tool.json report.json
        line "$size" "$tool, in the pipe" "$(awk 'END { print $1 }' $tool.time)" "$(awk 'END { print $2 + $3 }' $tool.time)" \
            "$(awk -v b="$(field report.json peak_memory_bytes)" 'BEGIN { printf "%.2f", b / 1e9 }')" "$(came_out "$tool")"
    done
    line "$size" "**the chain, one pipe**" "$(printf %.3f "$whole_pipe")" "–" "$(sort -g memory | tail -1)" "$(field report.json spheres)"
}

# A tool of the pipe.
stage() {
    local -n options=options_${1//-/_}
    { (ulimit -v $((limit * 1000 * 1000)); time "$1" -q ${2:+"$2"} "${options[@]}" --report "$1.json"); } 2> "$1.time"
}

# Memory that the tools of this folder have now, together [GB].
together() {
    local status total=0 kib
    for status in /proc/[0-9]*; do
        [ "$status/cwd" -ef . ] || continue
        kib=$(awk '/^RssAnon:/ { print $2 }' "$status/status" 2> /dev/null) || continue
        total=$((total + ${kib:-0}))
    done
    awk -v k=$total 'BEGIN { printf "%.2f\n", k * 1024 / 1e9 }'
}

# The whole chain by one pipe, from a file [s].
pipe() {
    local start; start=$(now)
    cloud-crop -q "$1" "${options_cloud_crop[@]}" | cloud-fill -q | bluenoise-sample -q "${options_bluenoise_sample[@]}" \
        | wallgen -q "${options_wallgen[@]}" > walls.mcap
    awk -v a="$start" -v b="$(now)" 'BEGIN { print b - a }'
}

# Tools that only start and stop, by the same pipe [s].
starts() {
    local start; start=$(now)
    cloud-crop --version | cloud-fill --version | bluenoise-sample --version | wallgen --version > /dev/null
    awk -v a="$start" -v b="$(now)" 'BEGIN { print b - a }'
}

repeat() { local k; for ((k = 0; k < rounds; k++)); do "$@"; done | median; }

line() { echo "| $1 | $2 | $3 | $4 | $5 | $6 |" | tee -a table; }

ours() {
    local size=$1 input=scan.ply tool k
    chute-scan --points "$size" -q -o scan.ply
    for tool in "${stages[@]}"; do
        for ((k = 0; k < rounds; k++)); do run "$tool" "$input" "$tool.ply"; done > times
        # The spheres go on in their own format.
        [ "$tool" = wallgen ] && for ((k = 0; k < rounds; k++)); do run wallgen "$input" walls.mcap; done > times
        line "$size" "$tool" "$(cut -d' ' -f1 times | median)" "$(cut -d' ' -f2 times | median)" \
            "$(awk -v b="$(field report.json peak_memory_bytes)" 'BEGIN { printf "%.2f", b / 1e9 }')" "$(came_out "$tool")"
        input=$tool.ply
    done
    kept=$(field report.json spheres)
    whole_pipe=$(repeat pipe scan.ply) start=$(repeat starts)
    line "$size" "**the chain, one pipe**" "$(printf %.3f "$whole_pipe")" "–" "–" "$kept"
    line "$size" "of that, starting four processes" "$(printf %.3f "$start")" "–" "–" "–"
}

came_out() {
    case $1 in
        wallgen) field report.json spheres ;;
        bluenoise-sample) field report.json points_after ;;
        *) field report.json points_out ;;
    esac
}

peer() {
    local size=$1 module=$2 what=$3 missing="is left out: make -C pipelines peers installs it"
    if ! "$peers/bin/python" -c "import $module" 2> /dev/null; then echo "$module $missing" | tee -a remarks; return; fi
    "$peers/bin/python" "$here/peers/cloud-peers.py" cloud-fill.ply "$kept" "$what" 2> /dev/null | grep '|' > peer || {
        echo "$module failed on $size points" | tee -a remarks; return; }
    while IFS='|' read -r name seconds count; do line "$size" "$name" "$seconds" "–" "–" "$count"; done < peer
}

touch table remarks
echo "load before: $(cut -d' ' -f1 /proc/loadavg 2> /dev/null || echo unknown) (an idle machine is below 0.3)"
head='| points | work | seconds | processor seconds | peak memory [GB] | points or faces out |
|---|---|---|---|---|---|'
echo "$head"
for size in $sizes; do
    if [ "$size" -gt 5000000 ]; then large "$size"; continue; fi
    ours "$size"
    peer "$size" pymeshlab thin
    [ "$size" -gt 500000 ] || peer "$size" open3d surface
done

words() {
    echo "Medians of $rounds rounds on $(nproc) cores. Here each tool reads and writes files, and may use $limit GB. The scans are made by"
    echo "\`chute-scan\` and thinned to $spacing m; the roughness is $roughness m. pymeshlab thins to the number of points from bluenoise-sample."
    echo "The times of pymeshlab and Open3D do not include their start; reading has its own row."
    sort -u remarks | sed 's/^/- /'
}
words | tee words

page=$here/../docs/evidence/cost.md
if [ "$whole" = yes ] && grep -q 'race-clouds begins' "$page"; then
    { echo "$head"; cat table; echo; cat words; } > new
    awk '/<!-- race-clouds begins -->/ { print; print ""; while ((getline line < "new") > 0) print line; print ""; skip = 1 }
        /<!-- race-clouds ends -->/ { skip = 0 } !skip' "$page" > page
    cp page "$page"
    echo "written to docs/evidence/cost.md"
fi
