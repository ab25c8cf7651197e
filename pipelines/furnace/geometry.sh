#!/usr/bin/env bash
# Draws a shell of round rings, one above the other, such as a hopper, a throat or a stock line.
#
#   geometry.sh X,Y,Z,RADIUS X,Y,Z,RADIUS … > PART.ply      [m], 48 facets around
set -euo pipefail
awk -v words="$*" 'BEGIN {
  facets = 48; count = split(words, ring, " ")
  if (count < 2) { print "geometry.sh: give at least two rings X,Y,Z,RADIUS" > "/dev/stderr"; exit 2 }
  printf "ply\nformat ascii 1.0\ncomment rings %s; metres\nelement vertex %d\n", words, count * facets
  printf "property double x\nproperty double y\nproperty double z\nelement face %d\n", (count - 1) * facets
  printf "property list uchar uint vertex_indices\nend_header\n"
  for (i = 1; i <= count; i++) {
    if (split(ring[i], c, ",") != 4) { print "geometry.sh: " ring[i] " is not X,Y,Z,RADIUS" > "/dev/stderr"; exit 2 }
    for (k = 0; k < facets; k++) { a = 8 * atan2(1, 1) * k / facets; printf "%.7g %.7g %.7g\n", c[1] + c[4] * cos(a), c[2] + c[4] * sin(a), c[3] }
  }
  for (i = 0; i < count - 1; i++) for (k = 0; k < facets; k++) {
    n = (k + 1) % facets; printf "4 %d %d %d %d\n", i * facets + k, i * facets + n, (i + 1) * facets + n, (i + 1) * facets + k
  }
}'
