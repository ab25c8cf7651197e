#!/usr/bin/env bash
# Studies of calibrate, for docs/evidence/calibration.md: run.sh FOLDER PAGE.md
# REPEATS=30 sets how often the intervals are tested, JOBS=2 how many runs go on at once. What is there is used again.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
mkdir -p "$1"
out=$(cd "$1" && pwd) page=$2 docs=$(dirname "$2") repeats=${REPEATS:-30} jobs=${JOBS:-2}
truth="stiffness=65 strength=28 spread=0.45 friction=0.62 envelope=0.7"

# compared TRUTH FOUND.csv: a table of what was found beside the truth, `name=value …`.
compared() {
  awk -F, -v truth="$1" '
    BEGIN { n = split(truth, pairs, " "); for (k = 1; k <= n; k++) { split(pairs[k], pair, "="); value[pair[1]] = pair[2] }
      print "| parameter | truth | found | error | 90 % interval |\n|---|---|---|---|---|" }
    !/^#/ && ++row > 1 { printf "| %s | %s | %.4g | %+.1f %% | %.4g to %.4g |\n", $1, value[$1], $3, 100 * ($3 / value[$1] - 1), $4, $5 }' "$2"
}

# specimens FOLDER FIRST COUNT: curves of specimens FIRST, FIRST + 1 … at each load, and in `data` the options that name them.
specimens() {
  mkdir -p "$1"
  data=()
  for load in 50 100 200; do for k in $(seq "$2" $(($2 + $3 - 1))); do
    # shellcheck disable=SC2086
    awk -v load=$load $(printf -- '-v %s ' $truth) -v seed="$k" -f "$here/shear-model.awk" > "$1/$load-$k.csv"
    data+=(--data "$load kPa=$1/$load-$k.csv")
  done; done
}

specimens "$out/synthetic" 200001 3
calibrate "$here/synthetic.toml" "${data[@]}" --jobs "$jobs" --dir "$out/synthetic/trials" -q \
  --plot "$docs/calibration-synthetic.png" -o "$out/synthetic/found.csv"
compared "$truth" "$out/synthetic/found.csv" > "$out/synthetic.md"
"$here/../stages/section.sh" "$page" synthetic < "$out/synthetic.md"

# Trials in all, and how many of them come first: few, and as many as it takes.
cp "$here/shear-model.awk" "$out"
for trials in 12:8 20:12 70:30; do
  recipe=$out/intervals-${trials%:*}.toml
  sed "s/^trials = .*/trials = ${trials%:*}/; s/^first = .*/first = ${trials#*:}/" "$here/intervals.toml" > "$recipe"
  for k in $(seq "$repeats"); do
    folder=$out/repeat-${trials%:*}-$k
    [ -e "$folder/found.csv" ] && continue
    mkdir -p "$folder"
    # shellcheck disable=SC2086
    awk -v load=100 $(printf -- '-v %s ' $truth) -v seed=$((100001 + 100 * k)) -f "$here/shear-model.awk" > "$folder/lab.csv"
    calibrate "$recipe" --data "$folder/lab.csv" --seed $((1000 * k)) --jobs "$jobs" --dir "$folder/trials" -q -o "$folder/found.csv"
    rm -rf "$folder/trials"
  done
  for k in $(seq "$repeats"); do grep -v '^#' "$out/repeat-${trials%:*}-$k/found.csv" | tail -n +2; done | awk -F, -v truth="$truth" -v trials="${trials%:*}" '
    BEGIN { n = split(truth, pairs, " "); for (k = 1; k <= n; k++) { split(pairs[k], pair, "="); value[pair[1]] = pair[2]; name[k] = pair[1] }
      if (trials == 12) print "| trials | parameter | repeats | interval holds the truth | error (root mean square) | half width of the interval |\n|---|---|---|---|---|---|" }
    { v = value[$1]; all[$1]++; holds[$1] += $4 <= v && v <= $5; off = $3 / v - 1; squares[$1] += off * off; width[$1] += ($5 - $4) / 2 / v }
    END { for (k = 1; k <= n; k++) { p = name[k]; m = all[p]; h += holds[p]; a += m
        if (m) printf "| %d | %s | %d | %d | %.1f %% | %.1f %% |\n", trials, p, m, holds[p], 100 * sqrt(squares[p] / m), 100 * width[p] / m }
      printf "| %d | all | %d | %d (%.0f %%) | | |\n", trials, a, h, 100 * h / a }'
done > "$out/intervals.md"
"$here/../stages/section.sh" "$page" intervals < "$out/intervals.md"

[ -e "$out/lab/rates.csv" ] || "$here/truth.sh" "$out/lab" 0.5 0.15 1001 1002 1003 1004
calibrate "$here/free-flowing.toml" --data "heap=$out/lab/angles.csv" --data "discharge=$out/lab/rates.csv" --jobs "$jobs" --dir "$out/grains" -q \
  --plot "$docs/calibration-grains.png" --words "$out/grains.md" -o "$out/grains.csv"
"$here/../stages/section.sh" "$page" grains < "$out/grains.md"

# Cores on lab-test: 54 of them.
calibrate "$here/rock.toml" --jobs "$jobs" --dir "$out/rock" -q --plot "$docs/calibration-rock.png" --words "$out/rock.md" -o "$out/rock.csv"
"$here/../stages/section.sh" "$page" rock < "$out/rock.md"

# Soil on lab-test: specimens with known parameters, three at each of three stresses, stand for those of a laboratory.
soil="contact.0.contact_modulus=4e7 bond.0.modulus=4e7 contact.0.tangential_ratio=0.6 bond.0.tensile_strength=4e5 bond.0.deviation=0.25
  contact.0.sliding_friction=0.6 bond.0.strength_ratio=1.5"
known="modulus=4e7 tangential_ratio=0.6 tensile_strength=4e5 strength_deviation=0.25 friction=0.6 strength_ratio=1.5"
mkdir -p "$out/soil"
# shellcheck disable=SC2086
[ -e "$out/soil/curves.csv" ] || lab-test direct-shear "$here/cemented-soil.toml" --grains 1000 --strain 0.09 --stress '100 kPa,200 kPa,400 kPa' \
  --seeds 3 --seed 1001 $(printf -- '--set %s ' $soil) -q --dir "$out/soil/specimens" -o "$out/soil/curves.csv"
data=()
for stress in 100 200 400; do for seed in 1001 1002 1003; do
  awk -F, -v stress=${stress}000 -v seed=$seed 'NR == 1 || $1 == stress && $2 == seed' "$out/soil/curves.csv" > "$out/soil/$stress-$seed.csv"
  data+=(--data "$stress kPa=$out/soil/$stress-$seed.csv")
done; done
calibrate "$here/soil.toml" "${data[@]}" --jobs "$jobs" --dir "$out/soil/trials" -q --plot "$docs/calibration-soil.png" --words "$out/soil.md" -o "$out/soil.csv"
compared "$known" "$out/soil.csv" > "$out/soil-found.md"
"$here/../stages/section.sh" "$page" soil < "$out/soil-found.md"

# A real sand: parameters from its test at 100 kPa, then predictions of those at other stresses.
calibrate "$here/karlsruhe.toml" --jobs "$jobs" --dir "$out/karlsruhe" -q --plot "$docs/calibration-karlsruhe.png" --words "$out/karlsruhe.md" -o "$out/karlsruhe.csv"
"$here/../stages/section.sh" "$page" karlsruhe < "$out/karlsruhe.md"
"$here/karlsruhe.sh" "$out/karlsruhe.csv" "$out/predicted" > "$out/predicted.md"
"$here/../stages/section.sh" "$page" karlsruhe-predicted < "$out/predicted.md"

# Sinter in the sinter box: one slope of an experiment whose frictions and mouth are not known.
calibrate "$here/sinter-box.toml" --jobs "$jobs" --dir "$out/sinter-box" -q --plot "$docs/calibration-sinter.png" --words "$out/sinter-box.md" -o "$out/sinter-box.csv"
"$here/../stages/section.sh" "$page" sinter-box < "$out/sinter-box.md"

# Soil and stones together, small.
whole="soil_friction=0.6 soil_strength=8e4 stone_friction=0.4 rock_strength=8e5"
# shellcheck disable=SC2086
JOBS=$jobs "$here/whole.sh" "$out/whole" $whole
cp "$out/whole/fit.png" "$docs/calibration-whole.png"
compared "$whole" "$out/whole/found.csv" > "$out/whole.md"
"$here/../stages/section.sh" "$page" whole < "$out/whole.md"
