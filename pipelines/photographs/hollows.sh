#!/usr/bin/env bash
# hollows.sh RENDER COMPARE DIR WIDTH STEP MESH…: photographs of each mesh are rendered, their masks found, and a row of a table is printed:
# errors of the volume and of the surface, of the hull and after refinement.
set -euo pipefail
render=$1 compare=$2 out=$3 width=$4 step=$5
shift 5
echo "| stone | photographs | volume of the hull [%] | refined [%] | mean distance of the hull [% of the longest side] | refined [%] |"
echo "|---|---|---|---|---|---|"
for stone in "$@"; do
  name=$(basename "$stone" .ply)
  dir=$out/$name
  mkdir -p "$dir"
  dir=$(cd "$dir" && pwd) stone=$(realpath "$stone")
  $render "$stone" "$dir" "$width" "$step" >&2
  stone-mask "$dir/photographs" -o "$dir/masks" >&2
  stone-hull "$dir/photographs" --masks "$dir/masks" --turntable "$dir/turntable.toml" -o "$dir/hull.ply" >&2
  stone-hull "$dir/photographs" --masks "$dir/masks" --turntable "$dir/turntable.toml" --refine -o "$dir/refined.ply" >&2
  rows=$($compare "$stone" "$dir/hull.ply" "$dir/refined.ply")
  count=$(find "$dir/photographs" -name '*.jpg' | wc -l)
  read -r _ volume distance <<< "$(head -n 1 <<< "$rows")"
  read -r _ volume_refined distance_refined <<< "$(tail -n 1 <<< "$rows")"
  echo "| \`$name\` | $count of $width px | $volume | $volume_refined | $distance | $distance_refined |"
done
