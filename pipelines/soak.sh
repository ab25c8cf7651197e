#!/bin/bash
# Hard cases at full length, a line for each part: how long it took and how it ended. PARTS="rest turning" runs some of them, on another day the others.
# pipelines/out/soak/PART.log holds what a part said, PART.jsonl what it found; docs/evidence/soak.md is made of all parts that have been run, once none is
# missing. Two hours on one core.
#
#   kills     a run killed with SIGKILL at 200 (KILLS) random moments: frames, what is left, and the resumed run
#   rest      ten million steps of heaps at rest
#   pressed   ten million steps of grains pressed together at 0.95 of the critical step
#   turning   a million turns of a loaded grain; each for every normal law
set -uo pipefail
cd "$(dirname "$0")/.." || exit 1
out=pipelines/out/soak
mkdir -p "$out"
export GRAINPIPE_KILLS=${KILLS:-200}
all="kills rest pressed turning"
cargo build --workspace --bins --tests --locked --quiet || exit 1
tests() { cargo test -p grainpipe-tests --locked --quiet "$@"; }

part() {
    case $1 in
        kills) tests --test faults kill ;;
        rest) tests --test hard -- --ignored a_heap_at_rest ;;
        pressed) tests --test hard -- --ignored pressed_grains ;;
        turning) tests --test hard -- --ignored million_times ;;
        *) echo "no such part: kills, rest, pressed or turning" && false ;;
    esac
}

failed=0
printf '%-10s %8s %s\n' part seconds outcome
for name in ${PARTS:-$all}; do
    start=$SECONDS
    outcome=passed
    rm -f "$out/$name.jsonl" "$out/$name.jsonl.new"
    GRAINPIPE_FINDINGS="$PWD/$out/$name.jsonl.new" part "$name" > "$out/$name.log" 2>&1 || { outcome="see $out/$name.log" && failed=1; }
    [ "$outcome" != passed ] || mv "$out/$name.jsonl.new" "$out/$name.jsonl"
    printf '%-10s %8s %s\n' "$name" $((SECONDS - start)) "$outcome"
done
missing=
for name in $all; do [ -s "$out/$name.jsonl" ] || missing="$missing $name"; done
if [ -z "$missing" ]; then
    for name in $all; do cat "$out/$name.jsonl"; done > "$out/findings.jsonl"
    cargo run -p grainpipe-studies --bin stability --locked --quiet -- "$out/findings.jsonl" docs/evidence/soak.md Soak || failed=1
    grep '^| ' docs/evidence/soak.md || true
else
    echo "docs/evidence/soak.md is not written yet; these parts are missing:$missing"
fi
exit $failed
