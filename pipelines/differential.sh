#!/bin/bash
# Writes FILES files of every format and quirk with SEED, reads them with Grainpipe and with other programs (differential/peers.txt, in a virtual environment
# in the folder PEERS, which is made if it is not there), and compares. Prints each difference, keeps its file in out/differential, and writes its part of
# docs/evidence/reliability.md.
set -euo pipefail
cd "$(dirname "$0")/.."
peers=${PEERS:-pipelines/build/differential}
if [ ! -x "$peers/bin/python" ]; then
    python3 -m venv "$peers"
    "$peers/bin/pip" install --quiet --disable-pip-version-check -r pipelines/differential/peers.txt
fi
cargo build -p grainpipe-cloud --example read_files --locked --quiet
out=pipelines/out/differential
rm -rf "$out"
mkdir -p "$out"
target=${CARGO_TARGET_DIR:-target}
status=0
"$peers/bin/python" pipelines/differential/attack.py --reader "$target/debug/examples/read_files" --files "${FILES:-8000}" --seed "${SEED:-1}" \
    --keep "$out/files" --page "$out/table.md" 2> "$out/warnings.txt" || status=$?
[ ! -s "$out/table.md" ] || pipelines/stages/section.sh docs/evidence/reliability.md differential < "$out/table.md"
exit "$status"
