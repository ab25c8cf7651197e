#!/bin/bash
# Whether wallgen's widest gap is one: a grain of 0.98 and one of 1.02 of its width are let go over it, one after the other.
# leak.sh SCAN SPACING ROUGHNESS FOLDER; writes two lines: "0.98 DIAMETER through" (or held) and "1.02 …".
set -euo pipefail
scan=$1 spacing=$2 roughness=$3 out=$4
bluenoise-sample "$scan" --spacing "$spacing" -q \
  | wallgen --roughness "$roughness" --radius uniform --smallest-particle "$spacing" --report "$out/wall.json" -q -o "$out/wall.mcap"
cp "$(dirname "$0")/leak.toml" "$out/leak.toml"
read -r width x y z radius < <(tr -d ' \n' < "$out/wall.json" \
  | sed -E 's/.*"radius_range":\[([^],]*).*"widest_gap":\{"at":\[([^],]*),([^],]*),([^],]*)\],"diameter":([^,}]*).*/\5 \2 \3 \4 \1/' && echo)
for share in 0.98 1.02; do
  # The second grain falls beside the wall: it shows that grains do fall.
  awk -v w="$width" -v s=$share -v x="$x" -v y="$y" -v z="$z" -v r="$radius" 'BEGIN { print "x,y,z,diameter"
    printf "%.9g,%.9g,%.9g,%.9g\n%.9g,%.9g,%.9g,%.9g\n", x, y, z + 1.2 * r, s * w, x - 100, y, z + 1.2 * r, s * w }' > "$out/grain.csv"
  dem-run "$out/leak.toml" "$out/wall.mcap" -q -o "$out/leak-$share.mcap"
  # Held, it lies above the middles of the spheres, and never passes their plane.
  passed=$(dem-measure --flow "$x,$y,$z,0,0,-1" "$out/leak-$share.mcap" -q | awk -F, 'NR > 1 { n += $3 } END { print n + 0 }')
  case $passed in 1) word=held ;; 2) word=through ;; *) echo "leak.sh: $passed of 2 grains fell" >&2; exit 1 ;; esac
  echo "$share $(awk -v w="$width" -v s=$share 'BEGIN { printf "%.6g", s * w }') $word"
done
