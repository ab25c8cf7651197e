#!/bin/bash
# Real scans and drawings as walls of spheres

What the tools make of real scans and drawings. `make -C pipelines data-pictures DATA=FOLDER` writes this page. The sources and licences of the files are at the head of
`tests/tests/tools/real_clouds.rs`; the tests there check counts, spacing, coverage and leaks of the same files.

## Scans
HEAD
scan Otira_1cm_grains.ply 0.03
scan stonepile2_depthcam_120k.ply 0.01 --camera 35/40
scan autzen_trim.laz 8 --camera 35/40
printf '\n## Drawings\n' >>"$out/data.md"
drawing deme_cone.obj 0.05
drawing deme_funnel.obj 10
drawing deme_hourglass.obj 1 --cut
drawing deme_internal_mixer.obj 0.04
drawing deme_silo.obj 1
drawing dosta_penetration_walls.txt 0.003 --cut
drawing dosta_silo_walls_large_orifice.txt 0.003 --cut
cp "$out/data.md" "$docs/data.md"
