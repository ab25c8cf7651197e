#!/usr/bin/env python3
"""Makes the drawings of the examples: STL in millimetres, as CAD programs export them, and the grains of the beam."""
from math import cos, pi, sin
from pathlib import Path

HERE = Path(__file__).parent


def stl(name, triangles):
    with open(HERE / f"{name}.stl", "w") as out:
        out.write(f"solid {name}\n")
        for corners in triangles:
            out.write("facet normal 0 0 0\nouter loop\n")
            out.writelines("vertex %g %g %g\n" % tuple(round(x, 3) for x in corner) for corner in corners)
            out.write("endloop\nendfacet\n")
        out.write(f"endsolid {name}\n")


def quad(a, b, c, d):
    return [(a, b, c), (a, c, d)]


def strip(low, high):
    """The surface between two lines of the same number of points."""
    return [t for k in range(len(low) - 1) for t in quad(low[k], low[k + 1], high[k + 1], high[k])]


def box(x0, y0, z0, x1, y1, z1):
    p = [(x, y, z) for z in (z0, z1) for x, y in ((x0, y0), (x1, y0), (x1, y1), (x0, y1))]
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return [t for face in faces for t in quad(*(p[k] for k in face))]


def square(half, z):
    return [(x * half, y * half, z) for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1), (-1, -1))]


def circle(radius, y, steps=64):
    return [(radius * cos(2 * pi * k / steps), y, radius * sin(2 * pi * k / steps)) for k in range(steps + 1)]


# A hopper: 300 mm wide at the top, an outlet of 90 mm, 200 mm above the belt.
stl("hopper", strip(square(45, 120), square(45, 200)) + strip(square(45, 200), square(150, 400)) + strip(square(150, 400), square(150, 500)))
# Skirts beside the belt.
stl("skirts", box(-150, -80, 5, 700, -75, 100) + box(-150, 75, 5, 700, 80, 100) + box(-155, -80, 5, -150, 80, 100))

# A closed drum along y, 400 mm in diameter and 80 mm long, with eight lifters of 25 mm.
drum = strip(circle(200, 0), circle(200, 80))
for y in (0, 80):
    rim = circle(200, y)
    drum += [((0, y, 0), rim[k], rim[k + 1]) for k in range(64)]
for k in range(8):
    a = 2 * pi * k / 8
    foot, tip = (200 * cos(a), 200 * sin(a)), (175 * cos(a), 175 * sin(a))
    drum += quad((foot[0], 0, foot[1]), (foot[0], 80, foot[1]), (tip[0], 80, tip[1]), (tip[0], 0, tip[1]))
stl("drum", drum)

# A screw along x: a flight of 100 mm in diameter, pitch 80 mm, on a shaft of 30 mm, in a trough that is open at the top and at its end.
turns, steps = 5, 24
angle = [2 * pi * k / steps for k in range(turns * steps + 1)]
edge = lambda r: [(80 * a / (2 * pi), r * cos(a), r * sin(a)) for a in angle]
ring = lambda x, r: [(x, z, y) for y, _, z in circle(r, 0, 24)]
stl("screw", strip(edge(15), edge(50)) + strip(ring(0, 15), ring(400, 15)))
half = [pi + pi * k / 24 for k in range(25)]
section = [(-56, 100)] + [(56 * cos(a), 56 * sin(a)) for a in half] + [(56, 100)]
trough = strip([(0, y, z) for y, z in section], [(400, y, z) for y, z in section])
trough += [((0, 0, 0), (0, *section[k]), (0, *section[k + 1])) for k in range(len(section) - 1)] + [((0, 0, 0), (0, *section[-1]), (0, *section[0]))]
stl("trough", trough)

# A deck of 340 x 170 mm with square apertures of 12 mm between bars of 5 mm, inclined by 15 degrees downwards along x; sides of 60 mm.
pitch, bar, nx, ny = 17, 5, 20, 10
tilt = lambda x, y, z: (x * cos(pi / 12) + z * sin(pi / 12), y, -x * sin(pi / 12) + z * cos(pi / 12))
flat = lambda x0, y0, x1, y1: quad(tilt(x0, y0, 0), tilt(x1, y0, 0), tilt(x1, y1, 0), tilt(x0, y1, 0))
deck = [t for j in range(ny + 1) for t in flat(0, j * pitch, nx * pitch + bar, j * pitch + bar)]
deck += [t for i in range(nx + 1) for j in range(ny) for t in flat(i * pitch, j * pitch + bar, i * pitch + bar, (j + 1) * pitch)]
for y in (0, ny * pitch + bar):
    deck += quad(tilt(0, y, 0), tilt(nx * pitch + bar, y, 0), tilt(nx * pitch + bar, y, 60), tilt(0, y, 60))
deck += quad(tilt(0, 0, 0), tilt(0, ny * pitch + bar, 0), tilt(0, ny * pitch + bar, 60), tilt(0, 0, 60))
stl("deck", deck)

# Supports of the beam, and the edge that presses on it: triangular bars, below and above the centres of grains.
def edge_bar(x, z, up):
    y, low = (-5, 45), z - up * 20
    top, left, right = [[(xx, yy, zz) for yy in y] for xx, zz in ((x, z), (x - 12, low), (x + 12, low))]
    return quad(top[0], top[1], left[1], left[0]) + quad(top[0], top[1], right[1], right[0])


stl("supports", edge_bar(35, 0, 1) + edge_bar(265, 0, 1))
stl("press", edge_bar(155, 40, -1))
with open(HERE.parent / "beam.csv", "w") as out:
    out.write("x,y,z,radius\n")
    for i in range(30):
        for j in range(4):
            for k in range(4):
                out.write("%g,%g,%g,0.005\n" % (0.005 + 0.01 * i, 0.005 + 0.01 * j, 0.005 + 0.01 * k))
