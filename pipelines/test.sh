#!/bin/bash
# Runs all tests and ends with their sum: N passed, N failed, N skipped (a test whose optional program is missing).
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
logs=$(mktemp -d)
trap 'rm -rf "$logs"' EXIT
export LOGS=$logs GRAINPIPE_SKIPS=$logs/skips
touch "$GRAINPIPE_SKIPS"

# Tools and tests in one go: their dependencies are then built once, with the features that both ask for.
cargo build --workspace --bins --tests --locked || exit 1

# Each test program, after the folder it runs in; the longest are among the first.
programs() {
    cargo test --workspace --locked --no-run --message-format=json 2> /dev/null |
        sed -nE 's|.*"manifest_path":"([^"]*)/Cargo.toml".*"profile":\{[^}]*"test":true\}.*"executable":"([^"]*)".*|\1\t\2|p' |
        sort -r | tr '\t\n' '\0\0'
}

# logged NAME COMMAND…: what it prints is kept, and shown when it has ended; a failure is noted.
logged() {
    local log=$LOGS/$1.log
    echo "     Running ${*:2}" > "$log"
    "${@:2}" >> "$log" 2>&1 || echo "$1 failed" >> "$LOGS/failures"
    cat "$log"
}
export -f logged

# Two at a time: the last tests of a program leave cores idle, a quarter of the time on two of them.
programs > "$logs/programs"
[ -s "$logs/programs" ] || { echo "cargo names no test program" >&2; exit 1; }
xargs -0 -P 2 -n 2 bash -c 'cd "$0" && logged "$(basename "$1")" "$1"' < "$logs/programs"
logged doc cargo test --doc --workspace --locked --no-fail-fast
sort -u "$GRAINPIPE_SKIPS"
skipped=$(sort -u "$GRAINPIPE_SKIPS" | wc -l)
[ ! -e "$logs/failures" ]
status=$?
[ $status = 0 ] || cat "$logs/failures"
cat "$logs"/*.log | awk -v skipped="$skipped" '/^test result:/ { passed += $4; failed += $6 }
    END { printf "%d passed, %d failed, %d skipped\n", passed - skipped, failed, skipped; if (passed == 0) exit 1 }' || status=1
exit $status
