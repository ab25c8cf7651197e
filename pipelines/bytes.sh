#!/bin/bash
# bytes.sh note FILE   notes hashes of all that the scenes and examples of the tests write, and the pipelines chute, boulders and furnace
# bytes.sh same FILE   does it again, prints what has another hash, and fails if anything has
# For changes that are to change no byte. What differs between two runs of one program (times in reports) is left out, and counted.
set -euo pipefail
cd "$(dirname "$0")"
case "${1-} ${2-}" in "note "?* | "same "?*) ;; *) sed -n '2,4s/^# //p' "$0" >&2; exit 2 ;; esac
todo=$1 file=$(realpath -m "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# hashes THREADS LIST: runs everything on so many cores.
hashes() {
    rm -rf "$work/notes" "$work/out"
    mkdir "$work/notes" "$work/out"
    (cd .. && GRAINPIPE_WRITTEN=$work/notes taskset -c "0-$(($1 - 1))" cargo test --locked -q -p grainpipe-tests --test tools -- every_scene_runs every_example_runs >&2)
    taskset -c "0-$(($1 - 1))" make --no-print-directory OUT="$work/out" chute boulders furnace >&2
    { cat "$work"/notes/*.txt; (cd "$work/out" && find . -type f | sort | xargs -d '\n' sha256sum | awk '{ print "out" substr($2, 2), $1 }'); } | sort > "$2"
}

cores=$(nproc)
hashes "$cores" "$work/all"
if [ "$todo" = note ]; then
    hashes 1 "$work/one"
    comm -12 "$work/all" "$work/one" > "$file"
    echo "$(wc -l < "$file") hashes in $file; $(comm -23 "$work/all" "$work/one" | wc -l) differ from run to run and are left out" >&2
else
    comm -23 "$file" "$work/all" | tee "$work/other"
    echo "$(wc -l < "$work/other") of $(wc -l < "$file") hashes differ" >&2
    [ ! -s "$work/other" ]
fi
