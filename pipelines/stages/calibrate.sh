#!/usr/bin/env bash
# Calibrates the rolling resistance between grains: calibrate.sh FOLDER PAGE.md runs the slice of the sinter box (sinter-slice.toml) for each value of ROLLING and
# each seed, puts a line through the slopes of the heaps, solves it for ANGLE, and writes the part "calibration" of the page. Sliding friction stays as
# the scene has it. Then runs the small plant (small.toml) with other stiffnesses, for the part "stiffness".
#
# Environment: ROLLING="0.4 0.6 1.0", SEEDS="1", ANGLE=35.5 [deg], STIFFNESS="1000 2500 10000 40000" [N/m], MORE="1 2 3 4 5" the seeds of those,
# JOBS=2. Runs that are there are used: take another folder for another scene. A run whose hopper jams has no slope, and is
# left out.
set -euo pipefail
mkdir -p "$1"
OUT=$(cd "$1" && pwd) PAGE=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
cd "$(dirname "$0")"
ROLLING=${ROLLING-0.4 0.6 1.0} SEEDS=${SEEDS:-1} ANGLE=${ANGLE:-35.5}
STIFFNESS=${STIFFNESS-1000 2500 10000 40000} MORE=${MORE-1 2 3 4 5}
runs=$(($(wc -w <<< "$ROLLING") * $(wc -w <<< "$SEEDS")))
[ "$runs" -ge 3 ] || { echo "calibrate: ROLLING=\"$ROLLING\" SEEDS=\"$SEEDS\" make $runs runs: a line with an interval needs three or more" >&2; exit 2; }

# slope NAME SEED SCENE SETTINGS…: runs a scene unless that is done, and keeps its slope [deg] and step [s].
slope() {
  local name=$1 seed=$2 scene=$3 run=$OUT/$1-$2 own=() fills
  shift 3
  fills=$(grep -c '^\[\[fill\]\]' "$scene")
  for ((k = 0; k < fills; k++)); do own+=(--set "fill.$k.seed=$((10 * seed + k))"); done
  # Several processes may share the folder; the others wait for a run, and then use it.
  exec 9>> "$run.lock"
  if command -v flock > /dev/null; then flock 9; fi
  ../once.sh "$run.mcap" dem-run "$scene" "${own[@]}" "$@" --threads 1 -q --report "$run.json"
  rm -f "$run.slope"
  # A small hopper may jam: grains that hang in it are no heap.
  if ! dem-measure "$run.mcap" --repose --side x+ --sectors 2 --ground 0 -q --report "$run.angle" > /dev/null 2> "$run.why"; then
    echo "calibrate: $name, seed $seed is left out: $(cat "$run.why")" >&2
    return
  fi
  printf '%s %s %s %s\n' "$name" "$seed" "$(grep -o '"angle": [^,]*' "$run.angle" | cut -d' ' -f2)" \
    "$(grep -o '"dt": [^,]*' "$run.json" | cut -d' ' -f2)" > "$run.slope"
}
export -f slope
export OUT
{
  for roll in $ROLLING; do for seed in $SEEDS; do
    printf '%s\n' "slope rolling-$roll $seed sinter-slice.toml --set contact.0.rolling_resistance=$roll"
  done; done
  for k in $STIFFNESS; do for seed in $MORE; do
    printf '%s\n' "slope stiffness-$k $seed small.toml --set output.contacts=false --set contact.0.stiffness=$k --set contact.1.stiffness=$k"
  done; done
} | xargs -P "${JOBS:-2}" -I LINE bash -c 'set -e; LINE'

# Student's t for 95 %, degrees of freedom 1 to 12.
T='split("12.706 4.303 3.182 2.776 2.571 2.447 2.365 2.306 2.262 2.228 2.201 2.179", t, " ")'
# slopes KIND VALUES SEEDS: those that were found.
slopes() { for value in $2; do for seed in $3; do cat "$OUT/$1-$value-$seed.slope" 2> /dev/null || true; done; done | sed "s/^$1-//"; }
slopes rolling "$ROLLING" "$SEEDS" | awk -v angle="$ANGLE" '
  {n++; x[n] = $1; y[n] = $3; sx += $1; sy += $3; sxx += $1 * $1; sxy += $1 * $3
   if (!($1 in count)) order[++values] = $1
   count[$1]++; sum[$1] += $3; squares[$1] += $3 * $3}
  END {
    '"$T"'
    if (n < 3) { print "calibrate: " n " slopes were found, and a line with an interval wants three" > "/dev/stderr"; exit 1 }
    print "| rolling resistance | seeds | slope, mean and deviation between seeds |\n|---|---|---|"
    for (i = 1; i <= values; i++) { v = order[i]; m = sum[v] / count[v]
      off = count[v] > 1 ? sprintf(" ± %.1f°", sqrt((squares[v] - count[v] * m * m) / (count[v] - 1))) : ""
      printf "| %s | %d | %.1f°%s |\n", v, count[v], m, off }
    slope = (n * sxy - sx * sy) / (n * sxx - sx * sx); mean = sx / n; level = sy / n
    for (i = 1; i <= n; i++) rest += (y[i] - level - slope * (x[i] - mean))^2
    s = sqrt(rest / (n - 2)); at = mean + (angle - level) / slope
    off = t[n - 2 > 12 ? 12 : n - 2] * s / (slope < 0 ? -slope : slope) * sqrt(1 / n + (at - mean)^2 / (sxx - sx * sx / n))
    printf "\nThe line has %.1f° at %.2f, and rises by %.1f° for each 0.1. It reaches %.1f° at a **rolling resistance of %.2f ± %.2f** (95 %% interval, from the scatter of the runs about the line).\n", level, mean, slope / 10, angle, at, off
  }' > "$OUT/calibration.md"
slopes stiffness "$STIFFNESS" "$MORE" | awk '
  {if (!($1 in count)) order[++values] = $1
   count[$1]++; sum[$1] += $3; squares[$1] += $3 * $3; dt[$1] = $4}
  END {
    '"$T"'
    print "| stiffness [N/m] | step [s] | runs | slope, mean and 95 % interval (Student) |\n|---|---|---|---|"
    for (i = 1; i <= values; i++) { v = order[i]; n = count[v]; m = sum[v] / n
      off = n > 1 ? sprintf("%.1f°", t[n - 1] * sqrt((squares[v] - n * m * m) / (n - 1) / n)) : "–"
      printf "| %s | %.2g | %d | %.1f° ± %s |\n", v, dt[v], n, m, off }
  }' > "$OUT/stiffness.md"
for part in calibration stiffness; do
  ./section.sh "$PAGE" $part < "$OUT/$part.md"
  cat "$OUT/$part.md"
done
