#!/usr/bin/env bash
# A half pipe along x, 0.5 m long, of radius 50 mm, open upwards (160° of it): `halfpipe.sh cloud` prints points on it, 1 mm apart, as
# XYZ; `halfpipe.sh mesh` the surface itself as PLY of flat strips that stray from it by less than 4 µm.
set -euo pipefail
awk -v what="$1" 'BEGIN {
  r = 0.05; span = 0.5; pi = atan2(0, -1); from = pi * 190 / 180; arc = pi * 160 / 180
  if (what == "cloud") {
    for (i = 0; i < 140; i++) for (k = 0; k <= 500; k++) {
      a = from + arc * (i + 0.25 + 0.5 * (k % 2)) / 140
      printf "%.6f %.6f %.6f\n", 0.001 * k, r * cos(a), r * sin(a)
    }
    exit
  }
  n = 128
  printf "ply\nformat ascii 1.0\ncomment half pipe of radius 50 mm along x; metres\nelement vertex %d\n", 2 * (n + 1)
  printf "property double x\nproperty double y\nproperty double z\nelement face %d\n", 2 * n
  printf "property list uchar uint vertex_indices\nend_header\n"
  for (i = 0; i <= n; i++) for (k = 0; k < 2; k++) {
    a = from + arc * i / n
    printf "%g %.9f %.9f\n", k * span, r * cos(a), r * sin(a)
  }
  for (i = 0; i < n; i++) printf "3 %d %d %d\n3 %d %d %d\n", 2*i, 2*i+1, 2*i+3, 2*i, 2*i+3, 2*i+2
}'
