"""What other programs put into holes of a cloud: Poisson surfaces and ball pivoting of Open3D and of pymeshlab.
usage: cloud-fill-peers.py CLOUD.ply CUTS.csv OUT.csv   CUTS.csv: x,y,z,radius,spacing of balls without points
Writes lines of peer,cut,x,y,z: points of each surface within the balls, about one for each square of the spacing."""
import sys
import time

import numpy
import open3d
import pymeshlab

cloud, cuts, out = sys.argv[1:4]
cuts = numpy.atleast_2d(numpy.loadtxt(cuts, delimiter=",", skiprows=1))
points = open3d.io.read_point_cloud(cloud)
spacing = float(numpy.median(cuts[:, 4]))
radii = [spacing * r for r in (1.5, 3, 6, 12, 24, 36)]
points.estimate_normals(open3d.geometry.KDTreeSearchParamKNN(30))
points.orient_normals_consistent_tangent_plane(20)


def open3d_poisson():
    return open3d.geometry.TriangleMesh.create_from_point_cloud_poisson(points, depth=9)[0]


def open3d_pivoting():
    return open3d.geometry.TriangleMesh.create_from_point_cloud_ball_pivoting(points, open3d.utility.DoubleVector(radii))


def meshlab(work):
    meshes = pymeshlab.MeshSet()
    mesh = pymeshlab.Mesh(vertex_matrix=numpy.asarray(points.points), v_normals_matrix=numpy.asarray(points.normals))
    meshes.add_mesh(mesh)
    work(meshes)
    found = meshes.current_mesh()
    return open3d.geometry.TriangleMesh(
        open3d.utility.Vector3dVector(found.vertex_matrix()), open3d.utility.Vector3iVector(found.face_matrix()))


def meshlab_poisson():
    return meshlab(lambda m: m.generate_surface_reconstruction_screened_poisson(depth=9))


def meshlab_pivoting():
    def work(meshes):
        for radius in radii:
            meshes.generate_surface_reconstruction_ball_pivoting(ballradius=pymeshlab.PureValue(radius), deletefaces=False)
    return meshlab(work)


peers = {"Open3D, Poisson": open3d_poisson, "Open3D, ball pivoting": open3d_pivoting,
         "pymeshlab, Poisson": meshlab_poisson, "pymeshlab, ball pivoting": meshlab_pivoting}
with open(out, "w") as file:
    for name, work in peers.items():
        start = time.perf_counter()
        mesh = work()
        print(f"{name}: {time.perf_counter() - start:.1f} s, {len(mesh.triangles)} faces", file=sys.stderr)
        if not len(mesh.triangles):
            continue
        corners = numpy.asarray(mesh.vertices)[numpy.asarray(mesh.triangles)]
        middles = corners.mean(axis=1)
        reach = numpy.linalg.norm(corners - middles[:, None], axis=2).max(axis=1)
        for number, (x, y, z, radius, local) in enumerate(cuts):
            off = numpy.linalg.norm(middles - (x, y, z), axis=1) - reach
            part = open3d.geometry.TriangleMesh(
                mesh.vertices, open3d.utility.Vector3iVector(numpy.asarray(mesh.triangles)[off < radius]))
            if not len(part.triangles) or part.get_surface_area() <= 0:
                continue
            open3d.utility.random.seed(number)
            count = int(min(100_000, part.get_surface_area() / local**2)) + 1
            some = numpy.asarray(part.sample_points_uniformly(count).points)
            some = some[numpy.linalg.norm(some - (x, y, z), axis=1) < radius]
            file.writelines(f"{name.replace(',', ':')},{number},{p[0]},{p[1]},{p[2]}\n" for p in some)
