#!/usr/bin/env bash
# stamp.sh SCENE.toml TIME [FILE ...]: a comment for a page whose numbers come from a scene: the hash of the scene and of the files that it names, and of what
# dem-run makes of its first TIME seconds. A page whose comment differs from that of today is of other programs, or of another scene.
set -euo pipefail
scene=$1 time=$2
shift 2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
dem-run "$scene" --until "$time" --threads 1 -q -o "$folder/run.mcap" 2> "$folder/words" || { cat "$folder/words" >&2; exit 1; }
made=$(dem-measure "$folder/run.mcap" --profile --axis z --bins 50 --last -q | sha256sum)
files=$(cat "$scene" "$@" | sha256sum)
printf '<!-- stamp: %s %.8s; after %s s: %.8s -->\n' "$(basename "$scene")" "$files" "$time" "$made"
