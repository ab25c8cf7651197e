# The bench pile in YADE.  Environment: PILE (CSV: id, x, y, z, radius, velocity, spin), WARM and STEPS.
import csv, math, os, time
from yade import *
rows = [[float(x) for x in r] for r in csv.reader(open(os.environ["PILE"]))]
warm, steps = int(os.environ["WARM"]), int(os.environ["STEPS"])
# The floor is of boxes: walls without end have no place in a periodic cell, nor has a body wider than half of it.
SIDE, HEIGHT, LIFT, TILES = 0.1196, 0.504, 0.02, 4  # m
O.periodic = True
O.cell.setBox(SIDE, SIDE, HEIGHT + LIFT)
half = 20 * 5.53e-5  # gamma m* of two mean grains [N s/m], as in lammps-pile.in; springs and dashpots of two materials stand in a row
grain = O.materials.append(ViscElMat(kn=2e4, ks=2e4 * 2 / 7, cn=2 * half, cs=half, density=3300, frictionAngle=math.atan(0.5)))
for r in rows:
    b = utils.sphere((r[1], r[2], r[3] + LIFT), r[4], material=grain)
    b.state.vel, b.state.angVel = Vector3(*r[5:8]), Vector3(*r[8:11])
    O.bodies.append(b)
tile = SIDE / TILES
for k in range(TILES * TILES):
    centre = (tile * (k % TILES + 0.5), tile * (k // TILES + 0.5), LIFT / 2)
    O.bodies.append(utils.box(centre, (tile / 2, tile / 2, LIFT / 2), fixed=True, material=grain))
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Box_Aabb()], verletDist=0.0003),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Box_Sphere_ScGeom()], [Ip2_ViscElMat_ViscElMat_ViscElPhys()],
                    [Law2_ScGeom_ViscElPhys_Basic()]),
    NewtonIntegrator(gravity=(0, 0, -9.81), damping=0),
]
O.dt = 1e-5
O.run(warm, True)
start = time.time()
O.run(steps, True)
seconds = time.time() - start
translation = sum(0.5 * b.state.mass * b.state.vel.squaredNorm() for b in O.bodies if isinstance(b.shape, Sphere))
print(f"{len(rows) * steps / seconds / 1e6:.4f} {translation:.6e}")
