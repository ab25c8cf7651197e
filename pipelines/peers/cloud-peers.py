"""What a user would pick instead of the cloud tools: Poisson-disk thinning by pymeshlab, surface first by Open3D.
usage: cloud-peers.py CLOUD.ply COUNT WHAT...   WHAT: thin (pymeshlab) | surface (Open3D: normals, ball pivoting)
Prints lines of: name, seconds, points or faces that came out."""
import sys
import time


def timed(work):
    start = time.perf_counter()
    result = work()
    return result, time.perf_counter() - start


def thin(cloud, count):
    import pymeshlab
    meshes = pymeshlab.MeshSet()
    _, seconds = timed(lambda: meshes.load_new_mesh(cloud))
    print(f"pymeshlab, read|{seconds:.3f}|{meshes.current_mesh().vertex_number()}")
    sample = dict(samplenum=count, subsample=True, exactnumflag=False)
    _, seconds = timed(lambda: meshes.generate_sampling_poisson_disk(**sample))
    print(f"pymeshlab, Poisson-disk thinning|{seconds:.3f}|{meshes.current_mesh().vertex_number()}")


def surface(cloud, count):
    import open3d
    points, seconds = timed(lambda: open3d.io.read_point_cloud(cloud))
    print(f"Open3D, read|{seconds:.3f}|{len(points.points)}")
    _, seconds = timed(lambda: points.estimate_normals(open3d.geometry.KDTreeSearchParamHybrid(radius=0.02, max_nn=30)))
    print(f"Open3D, normals|{seconds:.3f}|{len(points.normals)}")
    radii = open3d.utility.DoubleVector([0.004, 0.008])
    mesh, seconds = timed(lambda: open3d.geometry.TriangleMesh.create_from_point_cloud_ball_pivoting(points, radii))
    print(f"Open3D, ball pivoting|{seconds:.3f}|{len(mesh.triangles)}")


for what in sys.argv[3:]:
    {"thin": thin, "surface": surface}[what](sys.argv[1], int(sys.argv[2]))
