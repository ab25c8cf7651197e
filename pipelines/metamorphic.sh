#!/bin/bash
# Draws SCENES random scenes with SEED and asks each the same question in other words. Prints how many answers of each relation were compared and
# differ, writes the smallest scene of each failure into out/metamorphic with the command that shows it, and writes its part of docs/evidence/reliability.md.
# DEM_RUN=… runs another dem-run.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build -p dem-run --locked --quiet
cargo build -p grainpipe-studies --bin metamorphic --locked --quiet
out=pipelines/out/metamorphic
rm -rf "$out"
mkdir -p "$out"
status=0
target/debug/metamorphic --scenes "${SCENES:-2000}" --seed "${SEED:-1}" ${DEM_RUN:+--dem-run "$DEM_RUN"} --keep "$out" --page "$out/table.md" || status=$?
[ ! -s "$out/table.md" ] || pipelines/stages/section.sh docs/evidence/reliability.md metamorphic < "$out/table.md"
exit "$status"
