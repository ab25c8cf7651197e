#!/usr/bin/env bash
# Grains of the scenes of this folder, as CSV: rows.sh oblique|chain|wave|gas.
set -euo pipefail
cd "$(dirname "$0")"
head="id,x,y,z,radius,vx,vy,vz"
case ${1:-} in
  # One of each pair is a radius aside.
  oblique) awk -F, -v OFS=, 'NR > 1 && $1 % 2 {$4 += 0.005} {print}' pairs.csv ;;
  # Gaps of 1 µm.
  chain) awk -v head=$head 'BEGIN {print head; for (i = 0; i < 20; i++) printf "%d,%.9f,0,0,0.005,%g,0,0\n", i, i * 0.010001, i == 0}' ;;
  # Overlaps of 20 µm.
  wave) awk -v head=$head 'BEGIN {print head; pi = atan2(0, -1)
    for (i = 0; i < 40; i++) printf "%d,%.9f,0,0,0.005,%.9g,0,0\n", i, (i + 0.5) * 0.00998, 1e-3 * sin(2 * pi * i / 40)}' ;;
  # On a lattice, with velocities that are nearly Gaussian and sum to nothing; Park and Miller's generator, the same in every awk.
  gas) awk -v head=$head 'function chance() {s = s * 16807 % 2147483647; return s / 2147483647}
    BEGIN {print head; s = 3; n = 8; m = n * n * n
      for (i = 0; i < m; i++) for (k = 0; k < 3; k++) {v[i, k] = chance() + chance() + chance() - 1.5; sum[k] += v[i, k]}
      for (i = 0; i < m; i++) printf "%d,%g,%g,%g,0.005,%.9f,%.9f,%.9f\n", i, (i % n + 0.5) * 0.014, (int(i / n) % n + 0.5) * 0.014,
        (int(i / n / n) + 0.5) * 0.014, v[i, 0] - sum[0] / m, v[i, 1] - sum[1] / m, v[i, 2] - sum[2] / m}' ;;
  *) echo "rows.sh: give oblique, chain, wave or gas" >&2; exit 2 ;;
esac
