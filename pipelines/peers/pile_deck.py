#!/usr/bin/env python3
"""Writes the bench pile as a LIGGGHTS data file.  usage: pile_deck.py pile50k.ply OUT"""
import struct
import sys

raw = open(sys.argv[1], "rb").read()
head, body = raw.split(b"end_header\n", 1)
count = int(next(line.split()[2] for line in head.split(b"\n") if line.startswith(b"element vertex")))
row = struct.Struct("<I3d7f")  # id, x, y, z, radius, velocity, spin
rows = list(row.iter_unpack(body[: count * row.size]))
with open(sys.argv[2], "w") as out:
    out.write(f"pile\n\n{count} atoms\n1 atom types\n\n0 0.1196 xlo xhi\n0 0.1196 ylo yhi\n0 0.504 zlo zhi\n\nAtoms\n\n")
    for i, x, y, z, r, *_ in rows:
        out.write(f"{i} 1 {2 * r:.9g} 3300 {x:.9g} {y:.9g} {z:.9g}\n")
    out.write("\nVelocities\n\n")
    for i, _x, _y, _z, _r, *v in rows:
        out.write(f"{i} " + " ".join(f"{c:.9g}" for c in v) + "\n")
