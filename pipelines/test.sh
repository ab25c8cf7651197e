#!/bin/bash
# Runs all tests and ends with their sum: N passed, N failed, N skipped (a test whose optional program is missing).
set -uo pipefail
cd "$(dirname "$0")/.."
log=$(mktemp) skips=$(mktemp)
trap 'rm -f "$log" "$skips"' EXIT

# Tools and tests in one go: their dependencies are then built once, with the features that both ask for.
cargo build --workspace --bins --tests --locked || exit 1
GRAINPIPE_SKIPS=$skips cargo test --workspace --locked --no-fail-fast 2>&1 | tee "$log"
status=$?
sort -u "$skips"
skipped=$(wc -l < "$skips")
awk -v skipped="$skipped" '/^test result:/ { passed += $4; failed += $6 }
    END { printf "%d passed, %d failed, %d skipped\n", passed - skipped, failed, skipped; if (passed == 0) exit 1 }' "$log" || status=1
exit $status
