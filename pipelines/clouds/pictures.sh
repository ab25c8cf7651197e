#!/bin/bash
# Runs the chain on real scans and drawings; writes docs/evidence/data.md with a picture of each wall and the reports of the tools.
# pictures.sh DATA OUT DOCS: DOCS is docs/evidence; DATA has the folders clouds and walls; tests/tests/tools/real_clouds.rs says where the files come from.
set -euo pipefail
data=$1 out=$2 docs=$3
mkdir -p "$out" "$docs/data"

# The words of a tool's report line, without its name.
words() { grep "^$1: " "$2" | grep -v ' warning: ' | tail -1 | sed "s/^$1: //"; }

show() { # NAME CAMERA...
  local name=$1
  shift
  dem-view "$out/$name.mcap" -o "$docs/data/$name.png" --size 340x212 -q --wall-opacity 1 "$@"
}

scan() { # FILE SPACING VIEW...
  local file=$1 spacing=$2 name=${1%%.*} ends
  shift 2
  ends=$(awk -v s="$spacing" 'BEGIN { print 20 * s, s / 6, 2 * s }')
  read -r hole zeta particle <<<"$ends"
  cloud-fill "$data/clouds/$file" --max-hole "$hole" --bridge 2>"$out/$name.fill" |
    bluenoise-sample --spacing "$spacing" 2>"$out/$name.sample" |
    wallgen --roughness "$zeta" --radius uniform --smallest-particle "$particle" -o "$out/$name.mcap" 2>"$out/$name.wall"
  show "$name" "$@"
  {
    echo
    echo "**$file** (\`cloud-fill --max-hole $hole --bridge | bluenoise-sample --spacing $spacing | wallgen --roughness $zeta --radius uniform\`):"
    echo "$(words cloud-fill "$out/$name.fill"); $(words bluenoise-sample "$out/$name.sample"); $(words wallgen "$out/$name.wall")."
    grep -h 'warning: the wall leaks' "$out/$name.wall" | sed 's/^wallgen: warning: \(.*\)$/For particles of twice the spacing: \1./' || true
    echo
    echo "![$file](data/$name.png)"
  } >>"$out/data.md"
}

drawing() { # FILE RADIUS VIEW...
  local file=$1 radius=$2 name=${1%%.*} zeta
  shift 2
  zeta=$(awk -v r="$radius" 'BEGIN { print r / 6 }')
  wallgen --from-mesh "$data/walls/$file" --radius "$radius" --roughness "$zeta" -o "$out/$name.mcap" 2>"$out/$name.wall"
  show "$name" "$@"
  {
    echo
    echo "**$file** (\`wallgen --from-mesh … --radius $radius --roughness $zeta\`): $(words wallgen "$out/$name.wall")."
    echo
    echo "![$file](data/$name.png)"
  } >>"$out/data.md"
}

cat >"$out/data.md" <<'HEAD'
# Real scans and drawings as walls of spheres

The results of the tools for real scans and drawings: a picture of each wall, and the reports of the tools. `make -C pipelines data-pictures DATA=FOLDER` writes this page.
The head of `tests/tests/tools/real_clouds.rs` gives the sources and licences of the files; the tests there check counts, spacing, coverage and leaks of the same files.

## Scans
HEAD
scan Otira_1cm_grains.ply 0.03
scan stonepile2_depthcam_120k.ply 0.01 --camera 35/40
scan autzen_trim.laz 8 --camera 35/40
# For docs/reference/removal.md; its coordinates are in feet.
cloud-crop "$data/clouds/autzen_trim.laz" --scale 0.3048 --ground 20,0.3,0.1 --scattered 3,0.1 --mark -q -o "$out/marked.ply"
dem-view "$out/marked.ply" --colour removed --size 800x450 -q -o "$docs/../reference/removal-marked.png"
printf '\n## Drawings\n' >>"$out/data.md"
drawing deme_cone.obj 0.05
drawing deme_funnel.obj 10
drawing deme_hourglass.obj 1 --cut
drawing deme_internal_mixer.obj 0.04
drawing deme_silo.obj 1
drawing dosta_penetration_walls.txt 0.003 --cut
drawing dosta_silo_walls_large_orifice.txt 0.003 --cut
cp "$out/data.md" "$docs/data.md"
