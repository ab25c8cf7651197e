#!/usr/bin/env bash
# The sinter box in full, cut at the hopper's mouth: sinter-box.sh FOLDER PAGE.md runs both stages at once through a pipe, keeps the record, measures the
# slope, and writes the part "sinter-box" of the page and its picture. The tools must be on the path.
#
# Both stages use THREADS threads each (2): in the beginning nearly all grains are upstream, in the end nearly all downstream.
# What is there already is used: a record that is whole, and a downstream run that was stopped, which goes on from its last checkpoint.
set -euo pipefail
mkdir -p "$1"
OUT=$(cd "$1" && pwd) PAGE=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
cd "$(dirname "$0")"
SCENE=sinter-box.toml
CUT=0,0,0.6,0,0,-1
LENGTH=0.006
TIMEFORMAT='%R %U %S'
THREADS=${THREADS:-2}

# Along recorded paths: in the mouth the fast pass the slow, and where each goes back on its own parabola one in some thousands comes in through another.
# Behind the plane grains fall: at constant velocity the slow ones dam up the mouth.
for keep in upstream downstream; do
  stage-split $SCENE --at=$CUT --length $LENGTH --motion recorded --keep $keep -o "$OUT/$keep.toml" -q
done
SAMPLES=outlet.0.samples=2e-4 # s
cd "$OUT"
if [ -e downstream.mcap ] && [ -e upstream.mcap ]; then
  echo "sinter-box: both runs exist and are only measured (after make clean they are run again)" >&2
elif [ -e upstream.mcap ]; then
  echo "sinter-box: replaying the existing record" >&2
  on=()
  [ -e downstream.mcap.part ] && on=(--resume downstream.mcap)
  { time stage-replay upstream.mcap --keep-times -q | dem-run downstream.toml - "${on[@]}" --threads "$THREADS" -q --report down.json -o downstream.mcap; } 2>> times
else
  rm -f times
  { time { dem-run upstream.toml --set $SAMPLES --threads "$THREADS" -q --report up.json | tee upstream.new | stage-replay --keep-times -q \
    | dem-run downstream.toml - --threads "$THREADS" -q --report down.json -o downstream.mcap; }; } 2>> times
  mv upstream.new upstream.mcap
fi

# number FILE KEY: a number of a report, or of the JSON of a measure.
number() { tr -d ' \n' < "$1" | grep -o "\"$2\":[^,}]*" | head -1 | cut -d: -f2; }
value() { tr -d ' \n' < "$1" | grep -o "\"$2\":{\"unit\":\"[^\"]*\",\"value\":[^}]*" | head -1 | sed 's/.*"value"://'; }
dem-measure downstream.mcap --repose --side x+ --sectors 8 --ground 0 --json --plot slope.svg -q > slope.json
dem-measure downstream.mcap --flow=0,0,0.35,0,0,-1 --json -q > into.json
dem-measure upstream.mcap --flow=$CUT --from 0.3 --until 0.9 --json -q > flow.json
dem-view upstream.mcap downstream.mcap --time 1.2 --camera -60/18 --size 640x720 -o box.png -q
cp box.png "$(dirname "$PAGE")/stages-sinter-box.png"
cp slope.svg "$(dirname "$PAGE")/stages-sinter-slope.svg"
awk -v angle="$(value slope.json angle)" -v off="$(value slope.json angle_interval)" -v height="$(value slope.json height)" \
  -v into="$(value into.json mass)" -v flow="$(value flow.json mass_flow)" -v steps="$(number up.json steps)" -v dt="$(number up.json dt)" \
  -v mu="$(awk '/sliding_friction/ {print $3; exit}' upstream.toml)" -v roll="$(awk '/rolling_resistance/ {print $3; exit}' upstream.toml)" '
  {wall += $1; cpu += $2 + $3}
  END {
    printf "| | |\n|---|---|\n"
    printf "| **slope of the heap** | **%.1f° ± %.1f°** (mean of eight lanes, 95 %% interval); experiment 35.5°, analysis of the source 35.9° |\n", angle, off
    printf "| friction between grains, sliding and rolling | %s, %s |\n", mu, roll
    printf "| height of the heap | %.0f mm |\n| mass that came into the box | %.2f kg |\n", 1000 * height, into
    printf "| flow at the mouth | %.1f kg/s |\n| step | %.3g s, %d steps in each stage |\n", flow, dt, steps
    printf "| run time of both stages | %.0f s of processor time; %.0f s on the clock of a machine with other work on it |\n", cpu, wall
  }' times > box.md
printf '\n![Slope of the heap, lane by lane](stages-sinter-slope.svg)\n\n![Sinter in the box](stages-sinter-box.png)\n' >> box.md
cd "$OLDPWD"
./section.sh "$PAGE" sinter-box < "$OUT/box.md"
cat "$OUT/box.md"
