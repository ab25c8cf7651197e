#!/bin/bash
# Fuzzes every parser: RUNS inputs for each of TARGETS, made from small valid files of every format. A target ends at the first input that makes it
# panic, take more than 10 s, or take more than 1 GB. Needs a nightly compiler and cargo-fuzz; prints how many inputs each target really got.
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
runs=${RUNS:-1000000}
targets=${TARGETS:-$(cargo +nightly fuzz list)}
out=pipelines/out/fuzz
for program in "cargo +nightly --version" "cargo fuzz --version"; do
    $program > /dev/null 2>&1 || { echo "fuzz: '$program' fails: rustup toolchain install nightly; cargo install cargo-fuzz" >&2; exit 1; }
done
mkdir -p "$out"
cargo run -p grainpipe-studies --bin fuzz_seeds --locked --quiet -- fuzz/corpus > "$out/seeds.txt" || exit 1

# Lengths in reach of a million inputs in minutes; a packed or checked file needs its whole head.
length() {
    case $1 in
        options | xyz) echo 512 ;;
        pcd | las) echo 1024 ;;
        regions | ply) echo 2048 ;;
        mcap | replay | measures | particles) echo 32768 ;;
        *) echo 4096 ;;
    esac
}

# Tracing each comparison takes up to three quarters of the time, in tables that decode packed points without end.
plain=(--no-trace-compares --target-dir fuzz/target/plain)

printf '%-12s %10s %8s %s\n' target inputs seconds outcome
for target in $targets; do
    start=$SECONDS
    RAYON_NUM_THREADS=1 cargo +nightly fuzz run "${plain[@]}" "$target" -- -runs="$runs" -timeout=10 -rss_limit_mb=1024 -seed=1 \
        -max_len="$(length "$target")" -print_final_stats=1 > "$out/$target.log" 2>&1
    rc=$?
    inputs=$(sed -n 's/.*number_of_executed_units: *//p' "$out/$target.log")
    outcome=clean
    [ $rc = 0 ] || { outcome="see $out/$target.log"; }
    printf '%-12s %10s %8s %s\n' "$target" "${inputs:-0}" $((SECONDS - start)) "$outcome"
done | tee "$out/summary.txt"
! grep -q "see $out" "$out/summary.txt"
