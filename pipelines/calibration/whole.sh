#!/usr/bin/env bash
# Soil and stones together, small: whole.sh FOLDER TRUTH… packs specimens, shears two of them at known parameters (`name=value`) as a laboratory would, and
# calibrates a third one by them. Leaves found.csv, words.md and fit.png in FOLDER. JOBS=2 sets how many runs go on at once. What is there is used again.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd) jobs=${JOBS:-2}
shift
for pair; do declare "${pair%%=*}=${pair#*=}"; done

# specimen SEED: FOLDER/SEED with specimen.ply and its sample.
specimen() {
  local folder=$out/$1
  [ -e "$folder/soil-and-stones.toml" ] && return
  mkdir -p "$folder"
  dem-run "$here/../rock-fill/soil.toml" --set fill.0.shape=box:0,0,0,0.04,0.04,0.2 --set wall.2.plane=0.04,0,0,-1,0,0 \
    --set wall.4.plane=0,0.04,0,0,-1,0 --set fill.0.count=350 --set "fill.0.seed=$1" --threads 1 -q -o "$folder/soil.mcap"
  printf 'from,to,share\n0.013,0.018,1\n' > "$folder/grading.csv"
  stone-pack "$folder/soil.mcap" "$here/../../sample-data/stones" --content 0.3 --stone-density 2650 --grading "$folder/grading.csv" --seed "$1" -q \
    --report "$folder/report.json" -o "$folder/specimen.ply"
  # The density at which the grains of the stones weigh what the stones do.
  density=$(sed -n 's/.*"grain_density": \([0-9.e+]*\).*/\1/p' "$folder/report.json")
  awk -v density="$density" '/^name/ { rock = /"rock"/ } rock && /^density/ { $0 = "density = " density } { print }' "$here/soil-and-stones.toml" \
    > "$folder/soil-and-stones.toml"
}

for seed in 1 2 3; do specimen $seed; done
data=()
for load in 100 200 400; do for seed in 2 3; do
  curve=$out/$load-$seed.csv
  # shellcheck disable=SC2154  # by declare
  [ -e "$curve" ] || lab-test direct-shear "$out/$seed/soil-and-stones.toml" --stress "$load kPa" --strain 0.06 --seed $((1000 + seed)) --threads 1 -q \
    --set "contact.0.sliding_friction=$soil_friction" --set "bond.0.tensile_strength=$soil_strength" \
    --set "contact.1.sliding_friction=$stone_friction" --set "bond.1.shear_strength=$rock_strength" -o "$curve"
  data+=(--data "$load kPa=$curve")
done; done
# The recipe with fewer trials, and shorter tests.
sed 's/^trials = .*/trials = 24/; s/^first = .*/first = 16/; s/^batch = .*/batch = 4/; s/ --stress / --strain 0.06 --stress /' "$here/whole.toml" > "$out/1/whole.toml"
calibrate "$out/1/whole.toml" "${data[@]}" --jobs "$jobs" --dir "$out/trials" -q --plot "$out/fit.png" --words "$out/words.md" -o "$out/found.csv"
