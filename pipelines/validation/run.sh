#!/usr/bin/env bash
# Compares with experiments and other codes: run.sh FOLDER PAGE.md runs each case of CASES and writes its part of the page. The tools must be on
# the path. Runs are kept in FOLDER; finished ones are used again. SEEDS and HARD choose the packings (at least two).
set -euo pipefail
mkdir -p "$1"
export OUT PAGE
OUT=$(cd "$1" && pwd) PAGE=$(cd "$(dirname "$2")" && pwd)/$(basename "$2")
cd "$(dirname "$0")"
CASES=${CASES:-impact slot silo collapse drum penetration projectile}
for case in $CASES; do
  echo "validation: $case" >&2
  "./$case.sh" > "$OUT/$case.md"
  ../stages/section.sh "$PAGE" "$case" < "$OUT/$case.md"
  cat "$OUT/$case.md"
done
