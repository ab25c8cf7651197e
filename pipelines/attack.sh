#!/bin/bash
# Attacks every tool: FILES damaged files, every key and option with 14 values, KILLS kills for each pipe, all drawn with SEED.
# Prints each bad case with its command, and writes docs/evidence/reliability.md.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo build --bins --locked --quiet
cargo build -p grainpipe-studies --bin attack --locked --quiet
target/debug/attack "${FILES:-24000}" "${KILLS:-100}" "${SEED:-1}" docs/evidence/reliability.md
