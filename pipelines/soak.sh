#!/bin/bash
# Hard cases at full length, a line for each part: how long it took and how it ended. PARTS="rest turning" runs some of them.
# pipelines/out/soak/PART.log holds what a part said; what was found goes to docs/soak.md when all parts ran, else to soak.md there. About an hour on
# one core.
#
#   kills     a run killed with SIGKILL at 200 (KILLS) random moments: frames, what is left, and the resumed run
#   rest      ten million steps of heaps at rest
#   pressed   ten million steps of grains pressed together at 0.95 of the critical step
#   turning   a million turns of a loaded grain; each for every normal law
set -uo pipefail
cd "$(dirname "$0")/.."
out=pipelines/out/soak
mkdir -p "$out"
rm -f "$out/findings.jsonl"
page=docs/soak.md
[ -z "${PARTS:-}" ] || page=$out/soak.md
export GRAINPIPE_FINDINGS="$PWD/$out/findings.jsonl" GRAINPIPE_KILLS=${KILLS:-200}
cargo build --workspace --bins --examples --tests --locked --quiet || exit 1
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
for name in ${PARTS:-kills rest pressed turning}; do
    start=$SECONDS
    outcome=passed
    part "$name" > "$out/$name.log" 2>&1 || { outcome="see $out/$name.log" && failed=1; }
    printf '%-10s %8s %s\n' "$name" $((SECONDS - start)) "$outcome"
done
if [ -s "$out/findings.jsonl" ]; then
    cargo run -p grainpipe-tests --example stability --locked --quiet -- "$out/findings.jsonl" "$page" Soak || failed=1
    grep '^| ' "$page" || true
fi
exit $failed
