#!/usr/bin/env python3
"""Writes the bench pile for the other engines, pile.lammps, pile.liggghts and pile.csv, and says how far their damping is from ours.

usage: pile_deck.py pile50k.ply OUTDIR
"""
import math
import os
import struct
import sys

DENSITY, STIFFNESS, RESTITUTION, GAMMA = 3300.0, 1e4, 0.9977, 20.0
BOX = "0 0.1196 xlo xhi\n0 0.1196 ylo yhi\n0 0.504 zlo zhi"


def read(path):
    """Rows of id, x, y, z, radius, velocity, spin."""
    head, body = open(path, "rb").read().split(b"end_header\n", 1)
    count = int(next(line.split()[2] for line in head.split(b"\n") if line.startswith(b"element vertex")))
    row = struct.Struct("<I3d7f")
    return list(row.iter_unpack(body[: count * row.size]))


def write_data(path, rows, title):
    """A data file of LAMMPS or LIGGGHTS."""
    with open(path, "w") as out:
        out.write(f"pile\n\n{len(rows)} atoms\n1 atom types\n\n{BOX}\n\n{title}\n\n")
        for i, x, y, z, r, *_ in rows:
            out.write(f"{i} 1 {2 * r:.9g} {DENSITY} {x:.9g} {y:.9g} {z:.9g}\n")
        out.write("\nVelocities\n\n")
        for i, _x, _y, _z, _r, *v in rows:
            out.write(f"{i} " + " ".join(f"{c:.9g}" for c in v) + "\n")


def say_damping(radii):
    """c of two equal grains: ours from the restitution, √m*; theirs γ m*."""
    log = math.log(RESTITUTION)
    ratio = -2 * log / math.hypot(math.pi, log)
    for name, r in (("smallest", min(radii)), ("mean", sum(radii) / len(radii)), ("largest", max(radii))):
        reduced = DENSITY * 4 / 3 * math.pi * r**3 / 2
        ours, theirs = ratio * math.sqrt(STIFFNESS * reduced), GAMMA * reduced
        print(f"damping of two {name} grains: ours {ours:.3e}, peers' {theirs:.3e} N·s/m, ours/theirs {ours / theirs:.3f}")


def main():
    rows, out = read(sys.argv[1]), sys.argv[2]
    write_data(os.path.join(out, "pile.lammps"), rows, "Atoms # sphere")
    write_data(os.path.join(out, "pile.liggghts"), rows, "Atoms")
    with open(os.path.join(out, "pile.csv"), "w") as file:
        file.writelines(",".join(f"{c:.9g}" for c in row) + "\n" for row in rows)
    say_damping([row[4] for row in rows])


main()
