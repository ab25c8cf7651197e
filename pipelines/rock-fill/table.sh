#!/bin/sh
# How well spheres stand for a stone, by their number and the method of stone-clump: table.sh STONE.ply
set -eu
work=$(mktemp -d); trap 'rm -rf "$work"' EXIT
echo "| method | spheres | volume outside | mean distance | largest distance | inertia |"
echo "|---|---|---|---|---|---|"
for method in distance tangent; do
    for spheres in 3 10 30 100 300; do
        stone-clump "$1" --spheres "$spheres" --method "$method" -q --report "$work/report.json" -o "$work/clump.toml"
        # Keys of the report, one a line.
        value() { sed -n "s/^ *\"$1\": \([0-9.e-]*\),*\$/\1/p" "$work/report.json" | head -n 1; }
        awk -v m="$method" -v n="$(grep -c '^  \[' "$work/clump.toml")" -v v="$(value volume_error)" -v a="$(value mean_distance)" -v b="$(value most_distance)" -v i="$(value inertia)" \
            'BEGIN { printf "| %s | %d | %.1f %% | %.2f %% | %.1f %% | %.1f %% |\n", m, n, 100 * v, 100 * a, 100 * b, 100 * i }'
    done
done
