#!/bin/bash
# What takes too long for every day: each line is a part, and the first that fails ends it.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --workspace --bins --locked --quiet
tests() { cargo test -p grainpipe-tests --locked --quiet "$@"; }

# A run killed with SIGKILL at 200 random moments: frames, what is left, and the resumed run.
GRAINPIPE_KILLS=${KILLS:-200} tests --test faults kill
