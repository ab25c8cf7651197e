#!/usr/bin/env bash
# costs.sh RENDER COMPARE DIR STONE: what photographs that are missing cost in volume. Photographs of the stone are rendered, their masks found, and a
# table of hulls of some of them is printed.
set -euo pipefail
render=$1 compare=$2 stone=$(realpath "$4")
mkdir -p "$3"
out=$(cd "$3" && pwd)

# hull NAME WORDS TURNTABLE PATTERN…: a row, of the photographs that match.
hull() {
  local name=$1 words=$2 table=$3
  shift 3
  rm -rf "${out:?}/$name"
  mkdir "$out/$name"
  for pattern in "$@"; do ln -s "$out"/*/photographs/$pattern "$out/$name"; done
  stone-hull "$out/$name" --masks "$out/masks" --turntable "$table" --cells 150 -q -o "$out/$name.ply"
  read -r _ volume _ <<< "$($compare "$stone" "$out/$name.ply")"
  echo "| $words | $(find "$out/$name" -name '*.jpg' | wc -l) | $volume |"
}
# rings TABLE PATTERN: a turntable with those rings only whose photographs match.
rings() { awk -v RS= -v wanted="$2" 'NR == 1 || $0 ~ wanted { print $0 "\n" }' "$1"; }

rm -rf "$out/10" "$out/30" "$out/masks"
for step in 10 30; do $render "$stone" "$out/$step" 480 $step >&2; done
# Photographs of both steps have their own names.
for file in "$out"/30/photographs/[uo]*.jpg; do mv "$file" "${file%/*}/s$(basename "$file")"; done
sed -i 's/photographs = "/photographs = "s/' "$out/30/turntable.toml"
stone-mask "$out/10/photographs" "$out/30/photographs" -o "$out/masks" -q
rings "$out/10/turntable.toml" 'up-' > "$out/one.toml"
rings "$out/10/turntable.toml" '-00-' > "$out/level.toml"
echo "| photographs | number | volume of the hull [%] |"
echo "|---|---|---|"
hull all "two tilts, both sides of the stone, steps of 10°" "$out/10/turntable.toml" 'up-*' 'over-*'
hull coarse "steps of 30°" "$out/30/turntable.toml" 'sup-*' 'sover-*'
hull one "one side only" "$out/one.toml" 'up-*'
hull level "tilt of 0° only" "$out/level.toml" 'up-00-*' 'over-00-*'
