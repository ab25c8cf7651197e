#!/bin/bash
# What takes too long for every day: each line is a part, and the first that fails ends it.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --workspace --bins --locked --quiet
tests() { cargo test -p grainpipe-tests --locked --quiet "$@"; }

# A run killed with SIGKILL at 200 random moments: frames, what is left, and the resumed run.
GRAINPIPE_KILLS=${KILLS:-200} tests --test faults kill

# Ten million steps of heaps at rest and of grains pressed together at 0.95 of the critical step, a million turns of a loaded grain:
# for every normal law (and in mixed precision where it is offered). About an hour.
tests --test hard -- --ignored million
