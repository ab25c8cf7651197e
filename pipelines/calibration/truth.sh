#!/usr/bin/env bash
# Measures of the scenes of free-flowing.toml at known parameters, as if they were of a laboratory: truth.sh FOLDER SLIDING ROLLING SEEDS…
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd) out=$1 sliding=$2 rolling=$3
shift 3
mkdir -p "$out"
echo "angle" > "$out/angles.csv"
echo "mass_flow" > "$out/rates.csv"
number() { grep -o "\"$1\": [^,]*" "$2" | cut -d' ' -f2; }
for seed; do
  set -- --set "contact.0.sliding_friction=$sliding" --set "contact.0.rolling_resistance=$rolling" --set "fill.0.seed=$seed" --threads 1 -q
  dem-run "$here/heap.toml" "$@" -o "$out/run.mcap"
  dem-measure "$out/run.mcap" --repose --side x- --sectors 2 --ground 0 -q --report "$out/r.json" > /dev/null
  number angle "$out/r.json" >> "$out/angles.csv"
  dem-run "$here/discharge.toml" "$@" -o "$out/run.mcap"
  dem-measure "$out/run.mcap" --flow 0,0,-0.02,0,0,-1 --from 0.1 --until 0.3 -q --report "$out/r.json" > /dev/null
  number mass_flow "$out/r.json" >> "$out/rates.csv"
done
rm -f "$out/run.mcap" "$out/r.json"
