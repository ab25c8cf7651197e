#!/bin/sh
# Makes a run once: once.sh RUN.mcap COMMAND… runs COMMAND -o RUN.mcap unless RUN.mcap exists.
# A run that a guard stopped leaves a file, too. It is renamed to RUN-stopped.mcap, so that it does not count as made.
set -eu
run=$1
shift
[ ! -e "$run" ] || exit 0
code=0
"$@" -o "$run" || code=$?
if [ "$code" -ne 0 ] && [ -e "$run" ]; then
  mv "$run" "${run%.mcap}-stopped.mcap"
  echo "once.sh: ${run%.mcap}-stopped.mcap is what the run wrote until it was stopped" >&2
fi
exit "$code"
