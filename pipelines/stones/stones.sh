#!/bin/sh
# Crushes stones between plates: for each diameter so many, each with other flaws and another orientation, as many at once as there are cores.
#   stones.sh OUT.csv [STONES] [DIAMETER…]        columns diameter [m], seed, grains, force [N], strength [Pa], cracks
set -eu
here=$(cd "$(dirname "$0")" && pwd)
out=$1; stones=${2:-200}
[ $# -ge 2 ] && shift
shift
[ $# -gt 0 ] || set -- 0.005 0.007 0.010
rows=$(mktemp); trap 'rm -f "$rows"' EXIT
echo diameter,seed,grains,force,strength,cracks > "$out"
for diameter; do
    # Not through a pipe, which would hide that a stone failed.
    seq "$stones" | xargs -P "$(getconf _NPROCESSORS_ONLN)" -n 1 "$here/stone.sh" "$diameter" > "$rows"
    sort -t, -k 2n "$rows" >> "$out"
done
