"""Files that are cut, clouds by other programs' writers, meshes of polygons that are not convex, PTX, and LAS with records around the points."""
import os
import struct

import numpy as np
from data import Case, Data
from formats_ply import ENCODINGS, head, lists, rows, write

# Kinds that say how much they hold, and the last bytes of each without which nothing is missing.
CUT = {"las/1.2 format 3": 0, "las/1.4 format 7": 0, "laz/1.2 format 3": 0, "laz/1.4 format 7": 0, "laz/many points": 0, "e57/colours": 0,
       "e57/many packets": 0, "pcd/binary/property F 4": 0, "pcd/ascii/property F 4": 90, "pcd/by Open3D, packed": 0, "stl/text": 15,
       "stl/binary, head solid": 0, "stl/binary, head empty": 0, "text/PTS with intensity": 90, "stl/text, no name": 10}
CUT |= {f"{kind}/{e}/{name}": 90 if e == "ascii" else 0 for e in ENCODINGS for kind, name in (("ply", "property float"), ("ply", "a list in front"), ("ply-mesh", "floats"))}


def cuts(rng, kinds):
    """Each of these kinds, cut anywhere: to be refused."""
    found = {}
    for name, least in CUT.items():
        def make(target, name=name, least=least):
            case = kinds[name](target)
            with open(case.path, "rb") as file:
                data = file.read()
            most = len(data) - least
            if least and most > 0:
                # Whole lines of a text, so that no number ends early; the header is a part of it.
                most = data.rfind(b"\n", 0, most)
            length = int(rng.integers(1, max(2, most)))
            if rng.random() < 0.3:
                length = max(1, most - int(rng.integers(1, 40)))
            if least and b"\n" in data[:length]:
                length = data.rfind(b"\n", 0, length) + 1
            write(case.path, data[:length])
            return Case(f"cut {name}", case.path, case.mode, None, refuse="")
        found["cut " + name] = make
    return found


def star(rng, corners):
    """A simple polygon in a plane that is turned at random: corners around a centre at random distances."""
    angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
    while np.max(np.diff(np.append(angles, angles[0] + 2 * np.pi))) > 2.8:
        angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
    flat = np.stack([np.cos(angles), np.sin(angles), 0 * angles]) * rng.uniform(0.3, 2, corners)
    turn, _ = np.linalg.qr(rng.normal(0, 1, (3, 3)))
    x, y, _ = flat
    area = 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)
    return (turn @ flat).T + rng.normal(0, 5, 3), area * turn @ np.array([0, 0, np.sign(np.linalg.det(turn))])


def polygons(rng):
    """A face that is not convex: its area and normal, whichever corner is first."""
    found = {}
    for corners in (4, 5, 6, 8, 12, 30, 100):
        for form in ("obj", *ENCODINGS):
            def make(target, corners=corners, form=form):
                points, normal = star(rng, corners)
                order = np.roll(np.arange(corners), int(rng.integers(corners)))
                if form == "obj":
                    lines = [*("v " + " ".join(map(repr, p.tolist())) for p in points), "f " + " ".join(str(k + 1) for k in order)]
                    write(target, ("\n".join(lines) + "\n").encode())
                else:
                    elements = [("vertex", corners, [f"double {a}" for a in "xyz"]), ("face", 1, ["list uchar int vertex_indices"])]
                    write(target, head(form, elements), rows(form, list(points.T)), lists(form, "uchar", "int", [order.tolist()]))
                # One triangle and a copy turned over, so that the areas and normals are those of the polygon.
                a = np.linalg.norm(normal)
                n = normal / a
                u = np.cross(n, [1, 0, 0] if abs(n[0]) < 0.9 else [0, 1, 0])
                u /= np.linalg.norm(u)
                v = np.cross(n, u)
                truth = Data(np.stack([0 * n, 2 * a * u, v]), faces=np.array([[0, 1, 2]]))
                name = f"polygon/{form}, {corners} corners"
                return Case(name, target, "mesh", truth, (), area=True)
            ending = "obj" if form == "obj" else "ply"
            found[f"polygon/{form}, {corners} corners"] = make
    return found


def by_writers(rng):
    """Clouds that other programs wrote."""
    found = {}

    def kind(name, ending, write_, tolerance=1e-6, columns=lambda points, normals, colors: {}):
        def make(target):
            n = int(rng.integers(1, 60))
            points = rng.normal(0, 10, (n, 3)).astype("f4").astype(float)
            normals = rng.normal(0, 1, (n, 3))
            normals /= np.linalg.norm(normals, axis=1)[:, None]
            colors = rng.integers(0, 255, (n, 3), endpoint=True)
            out = os.path.splitext(target)[0] + "." + ending
            write_(out, points, normals, colors)
            return Case(f"writer/{name}", out, "cloud", Data(points, columns(points, normals, colors)), (), tolerance)
        found[f"writer/{name}"] = make

    def open3d(out, points, normals, colors, ascii_=False, packed=False, further=True):
        import open3d as peer
        cloud = peer.geometry.PointCloud(peer.utility.Vector3dVector(points))
        if further:
            cloud.normals = peer.utility.Vector3dVector(normals)
            cloud.colors = peer.utility.Vector3dVector(colors / 255)
        peer.io.write_point_cloud(out, cloud, write_ascii=ascii_, compressed=packed)

    both = lambda p, n, c: {**{f"n{a}": n[:, k] for k, a in enumerate("xyz")}, **{a: c[:, k] for k, a in enumerate(("red", "green", "blue"))}}
    for ascii_ in (False, True):
        word = "text" if ascii_ else "binary"
        # It writes six digits.
        loose = 1e-4 if ascii_ else 1e-6
        kind(f"Open3D, PLY, {word}", "ply", lambda o, p, n, c, a=ascii_: open3d(o, p, n, c, a), loose, both)
        kind(f"trimesh, PLY, {word}", "ply", lambda o, p, n, c, a=ascii_: trimesh_cloud(o, p, c, a), columns=colours_of)
    for name, how in {"binary": {}, "text": dict(ascii_=True), "packed": dict(packed=True)}.items():
        kind(f"Open3D, PCD, {name}, points", "pcd", lambda o, p, n, c, h=how: open3d(o, p, n, c, further=False, **h))
    kind("Open3D, XYZ", "xyz", lambda o, p, n, c: open3d(o, p, n, c, further=False), 1e-5)
    kind("Open3D, PTS", "pts", lambda o, p, n, c: open3d(o, p, n, c, further=False), 1e-5)
    kind("numpy, CSV", "csv", lambda o, p, n, c: np.savetxt(o, p, delimiter=","))
    kind("numpy, CSV with names", "csv", lambda o, p, n, c: np.savetxt(o, p, delimiter=",", header="x,y,z"))
    kind("numpy, TXT", "txt", lambda o, p, n, c: np.savetxt(o, p))
    kind("plyfile, text", "ply", lambda o, p, n, c: plyfile(o, p, n, True), columns=normals_of)
    kind("plyfile, little-endian", "ply", lambda o, p, n, c: plyfile(o, p, n, False, "<"), columns=normals_of)
    kind("plyfile, big-endian", "ply", lambda o, p, n, c: plyfile(o, p, n, False, ">"), columns=normals_of)
    return found


def normals_of(points, normals, colors):
    return {f"n{a}": normals[:, k].astype("f4") for k, a in enumerate("xyz")}


def colours_of(points, normals, colors):
    return {**{a: colors[:, k] for k, a in enumerate(("red", "green", "blue"))}, "alpha": np.full(len(colors), 255.0)}


def trimesh_cloud(out, points, colors, ascii_):
    import trimesh
    cloud = trimesh.PointCloud(points, colors=np.c_[colors, np.full(len(colors), 255)].astype("u1"))
    data = trimesh.exchange.ply.export_ply(cloud, encoding="ascii" if ascii_ else "binary")
    write(out, data if isinstance(data, bytes) else data.encode())


def plyfile(out, points, normals, text, order="="):
    import plyfile as peer
    names = [(a, "f4") for a in ("x", "y", "z", "nx", "ny", "nz")]
    table = np.array([tuple(row) for row in np.c_[points, normals]], names)
    peer.PlyData([peer.PlyElement.describe(table, "vertex")], text=text, byte_order=order, comments=["by plyfile"]).write(out)


def ptx(rng):
    """Grids of a scanner, each in its pose; 0 0 0 is no echo."""
    found = {}

    def kind(name, scans=1, posed=False, colour=False, missing=False, cut=False):
        def make(target):
            lines, points, intensity, color, scan_of, grid = [], [], [], [], [], []
            for scan in range(scans):
                columns, rows_ = (int(v) for v in rng.integers(2, 8, 2))
                n = columns * rows_
                grid.append(np.stack([np.tile(np.arange(rows_), columns), np.repeat(np.arange(columns), rows_)]))
                local = np.round(rng.normal(0, 9, (n, 3)), 6)
                if missing:
                    local[rng.random(n) < 0.2] = 0
                turn, shift = np.eye(3), np.zeros(3)
                if posed:
                    turn, _ = np.linalg.qr(rng.normal(0, 1, (3, 3)))
                    turn *= np.linalg.det(turn)
                    shift = np.round(rng.normal(0, 50, 3), 6)
                lines += [str(columns), str(rows_), " ".join(map(repr, shift.tolist()))]
                lines += [" ".join(map(repr, column.tolist())) for column in turn.T]
                lines += [" ".join(map(repr, [*turn[:, k].tolist(), 0.0])) for k in range(3)] + [" ".join(map(repr, [*shift.tolist(), 1.0]))]
                tone, rgb = np.round(rng.random(n), 3), rng.integers(0, 255, (n, 3), endpoint=True)
                rgb_text = [" " + " ".join(map(str, c.tolist())) if colour else "" for c in rgb]
                lines += [f"{' '.join(map(repr, p.tolist()))} {t!r}{c}" for p, t, c in zip(local, tone.tolist(), rgb_text)]
                posed_points = local @ turn.T + shift
                posed_points[(local == 0).all(axis=1)] = np.nan
                points.append(posed_points), intensity.append(tone), color.append(rgb), scan_of.append(np.full(n, float(scan)))
            text = "\n".join(lines[:-1] if cut else lines) + "\n"
            write(target, text.encode())
            if cut:
                return Case(f"ptx/{name}", target, "cloud", None, refuse="")
            columns = {"intensity": np.concatenate(intensity), "row": np.concatenate(grid, 1)[0], "column": np.concatenate(grid, 1)[1]}
            if colour:
                columns |= {c: np.concatenate(color)[:, k] for k, c in enumerate(("red", "green", "blue"))}
            if scans > 1:
                columns["scan"] = np.concatenate(scan_of)
            return Case(f"ptx/{name}", target, "cloud", Data(np.concatenate(points), columns), (), 1e-9)
        found[f"ptx/{name}"] = make

    for posed in (False, True):
        for scans in (1, 3):
            for colour in (False, True):
                kind(f"{scans} scans{', posed' if posed else ''}{', colours' if colour else ''}", scans, posed, colour)
    kind("points without an echo", 2, True, True, True)
    kind("cut", 2, True, False, False, True)
    return found


def las_records(rng, kinds):
    """LAS with more around the points: longer headers, records in front and behind, bytes between."""
    found = {}

    def kind(name, base, change):
        def make(target):
            case = kinds[base](target)
            with open(target, "rb") as file:
                data = change(bytearray(file.read()))
            write(target, data)
            return Case(f"las/{name}", target, "cloud", case.truth, (), 1e-9, rename=case.rename)
        found[f"las/{name}"] = make

    def gap(data, size):
        """Bytes between the records and the points."""
        start = struct.unpack_from("<I", data, 96)[0]
        struct.pack_into("<I", data, 96, start + size)
        return data[:start] + bytes(size) + data[start:]

    def record(data, user=b"a program", number=7, body=b"a body"):
        """A further record in front of the points."""
        start, count = struct.unpack_from("<I", data, 96)[0], struct.unpack_from("<I", data, 100)[0]
        more = struct.pack("<H16sHH32s", 0, user, number, len(body), b"") + body
        struct.pack_into("<II", data, 96, start + len(more), count + 1)
        return data[:start] + more + data[start:]

    for base in ("las/1.2 format 3", "las/1.4 format 6", "las/1.0 format 1"):
        tag = base.split("/")[1]
        kind(f"{tag}, bytes in front of the points", base, lambda d: gap(d, 37))
        kind(f"{tag}, the mark of 1.0 in front of the points", base, lambda d: gap(d, 2))
        kind(f"{tag}, a further record", base, record)
        kind(f"{tag}, an empty record", base, lambda d: record(d, body=b""))
        kind(f"{tag}, a wrong bounding box", base, lambda d: d[:179] + struct.pack("<6d", *range(6)) + d[227:])
        kind(f"{tag}, no bounding box", base, lambda d: d[:179] + bytes(48) + d[227:])
        kind(f"{tag}, a name of the system in Latin-1", base, lambda d: d[:26] + "Größe".encode("latin-1").ljust(32, b"\0") + d[58:])
    return found


def kinds(rng, path, others):
    return {**cuts(rng, others), **polygons(rng), **by_writers(rng), **ptx(rng), **las_records(rng, others)}
