"""Other programs' readers, each of one path to Data; what they do not say is None."""
import contextlib
import io

import numpy as np
from data import Data

# Differences that are known to be the peer's: kind (a part of its name), peer, why.
PEER_FAULTS = [
    ("binary_big_endian/quads", "pymeshlab", "reads big-endian quads of double corners wrongly"),
    ("pcd/binary/position F 8", "open3d", "reads positions of 8 bytes as those of 4"),
]


def plyfile(path):
    import plyfile as peer
    vertices = peer.PlyData.read(path)["vertex"].data
    lower = {name.lower(): name for name in vertices.dtype.names}
    names = [name for name in vertices.dtype.names if name.lower() not in "xyz" and vertices.dtype[name] != object]
    points = np.stack([vertices[lower[axis]].astype(float) for axis in "xyz"], axis=1)
    return Data(points, {name: vertices[name].astype(float) for name in names})


def laspy(path):
    import laspy as peer
    cloud = peer.read(path)
    columns, names = {}, set(cloud.point_format.dimension_names)
    for name in cloud.point_format.extra_dimension_names:
        columns[name] = np.asarray(cloud[name], float)
    for name in ["intensity", "return_number", "number_of_returns", "classification", "user_data", "point_source_id",
                 "gps_time", "red", "green", "blue", "nir"]:
        if name in names:
            columns[name] = np.asarray(cloud[name], float)
    angle = "scan_angle" if "scan_angle" in names else "scan_angle_rank"
    columns["scan_angle"] = np.asarray(cloud[angle], float) * (0.006 if angle == "scan_angle" else 1)
    # Bits as the formats from 6 on have them.
    bits = {"synthetic": 1, "key_point": 2, "withheld": 4, "overlap": 8, "scanner_channel": 16, "scan_direction_flag": 64, "edge_of_flight_line": 128}
    columns["scan_flags"] = sum(np.asarray(cloud[name], float) * bit for name, bit in bits.items() if name in names)
    return Data(np.asarray(cloud.xyz, float), columns)


def pye57(path):
    import pye57 as peer
    file = peer.E57(path)
    points = []
    for scan in range(file.scan_count):
        raw = file.read_scan(scan, ignore_missing_fields=True, intensity=False, colors=False, row_column=False)
        points.append(np.stack([raw["cartesianX"], raw["cartesianY"], raw["cartesianZ"]], axis=1))
    file.close()
    return Data(np.concatenate(points) if points else np.zeros((0, 3)))


def open3d(path):
    import open3d as peer
    peer.utility.set_verbosity_level(peer.utility.VerbosityLevel.Error)
    cloud = peer.io.read_point_cloud(path, remove_nan_points=False, remove_infinite_points=False)
    return Data(np.asarray(cloud.points, float))


def open3d_mesh(path):
    import open3d as peer
    peer.utility.set_verbosity_level(peer.utility.VerbosityLevel.Error)
    mesh = peer.io.read_triangle_mesh(path)
    if not len(mesh.triangles):
        raise ValueError("no triangles")
    return Data(np.asarray(mesh.vertices, float), faces=np.asarray(mesh.triangles))


def trimesh(path):
    import trimesh as peer
    mesh = peer.load(path, process=False, force="mesh")
    return Data(np.asarray(mesh.vertices, float), faces=np.asarray(mesh.faces))


def meshio(path):
    import meshio as peer
    with contextlib.redirect_stdout(io.StringIO()):
        mesh = peer.read(path)
    faces = [np.zeros((0, 3), int)]
    for block in mesh.cells:
        if block.type not in ("triangle", "quad", "polygon"):
            continue
        corners = np.asarray(block.data)
        faces += [corners[:, [0, k, k + 1]] for k in range(1, corners.shape[1] - 1)]
    return Data(np.asarray(mesh.points, float), faces=np.concatenate(faces))


def pymeshlab(path):
    import pymeshlab as peer
    meshes = peer.MeshSet(verbose=False)
    meshes.load_new_mesh(path)
    mesh = meshes.current_mesh()
    return Data(mesh.vertex_matrix(), faces=mesh.face_matrix())


def numpy(path):
    values = np.loadtxt(path, comments=["#", "//"], ndmin=2)
    return Data(values[:, :3])
