"""LAS, LAZ and PCD: every version, point format, property, type and encoding, by the peers' writers and by own ones."""
import struct

import numpy as np
from data import Case, Data

LAS_TYPES = ["u1", "i1", "u2", "i2", "u4", "i4", "u8", "i8", "f4", "f8"]
VERSIONS = {"1.0": (0, 1), "1.1": (0, 1), "1.2": (0, 1, 2, 3), "1.3": (0, 1, 2, 3), "1.4": tuple(range(11))}


FLAGS = {"synthetic", "key_point", "withheld", "overlap", "scanner_channel", "scan_direction_flag", "edge_of_flight_line"}


def las(rng, target, version, number, packed, extra=(), scale=0.001, offset=0.0, count=None, spread=100.0, patch=None):
    """A file by laspy; extra are (name, type, scale, offset)."""
    import laspy
    header = laspy.LasHeader(version="1.2" if version < "1.2" else version, point_format=number)
    header.scales, header.offsets = np.full(3, scale), np.full(3, offset)
    for name, type_, s, o in extra:
        vector = {} if s is None else dict(scales=np.array([s]), offsets=np.array([o]))
        header.add_extra_dim(laspy.ExtraBytesParams(name=name, type=type_, **vector))
    cloud = laspy.LasData(header)
    count = int(rng.integers(1, 80)) if count is None else count
    points = np.round(rng.uniform(-spread, spread, (count, 3)) / scale) * scale + offset
    cloud.xyz = points
    names = set(cloud.point_format.dimension_names)
    for name, most in [("intensity", 65535), ("classification", 31), ("user_data", 255), ("point_source_id", 65535),
                       ("red", 65535), ("green", 65535), ("blue", 65535), ("nir", 65535)]:
        if name in names:
            cloud[name] = rng.integers(0, most, count, endpoint=True)
    returns = rng.integers(1, 5, count, endpoint=True)
    cloud["number_of_returns"], cloud["return_number"] = returns, np.minimum(returns, rng.integers(1, 5, count))
    angle = "scan_angle" if "scan_angle" in names else "scan_angle_rank"
    cloud[angle] = rng.integers(-90, 90, count)
    for flag in FLAGS & names:
        cloud[flag] = rng.integers(0, 4 if flag == "scanner_channel" else 2, count)
    if "gps_time" in names:
        cloud["gps_time"] = rng.uniform(0, 1e9, count)
    for name, type_, s, o in extra:
        if s is not None:
            cloud[name] = np.round(rng.uniform(0, 100, count)) * s + o
        elif type_[0] == "f":
            cloud[name] = rng.normal(0, 10, count)
        else:
            # Whole numbers of 8 bytes go on as double, which has 53 bits.
            low, high = np.iinfo(type_).min, np.iinfo(type_).max
            cloud[name] = rng.integers(max(low, -(1 << 52)), min(high, 1 << 52), count, dtype=type_)
    cloud.write(target, do_compress=packed)
    with open(target, "rb") as file:
        data = bytearray(file.read())
    if version < "1.2":
        data[25] = int(version[-1])
    if patch:
        data = patch(data)
    with open(target, "wb") as file:
        file.write(data)


def las_kinds(rng):
    import peers
    kinds = {}

    def kind(name, version="1.2", number=1, packed=False, refuse=None, **how):
        name = f"{'laz' if packed else 'las'}/{name}"
        def make(target):
            las(rng, target, version, number, packed, **how)
            if refuse is not None:
                return Case(name, target, "cloud", None, refuse=refuse)
            # What laspy reads is the truth: it knows how scales round.
            truth = peers.laspy(target)
            if not len(truth.points):
                truth.columns = None
            return Case(name, target, "cloud", truth, ("laspy",), 1e-9, rename={"d e": "d_e"})
        kinds[name] = make

    for packed in (False, True):
        for version, numbers in VERSIONS.items():
            for number in numbers:
                if number not in (4, 5, 9, 10):
                    kind(f"{version} format {number}", version, number, packed)
        for type_ in LAS_TYPES:
            kind(f"extra bytes {type_}", "1.4", 6, packed, extra=[("value", type_, None, None)])
        kind("extra bytes, several", "1.4", 7, packed, extra=[("Amplitude", "u2", None, None), ("Reflectance", "i2", 0.01, 0.0), ("d e", "f4", None, None)])
        kind("extra bytes scaled", "1.2", 3, packed, extra=[("height", "i4", 0.001, 5.0)])
        kind("map coordinates", "1.2", 3, packed, offset=5.5e6)
        kind("coarse", "1.2", 0, packed, scale=0.5)
        kind("fine", "1.4", 6, packed, scale=1e-6, spread=1.0)
        kind("no points", "1.2", 0, packed, count=0)
        kind("many points", "1.4", 7, packed, count=20_000)
    # Two bytes at 107 (to 1.3) hold the number of points.
    fewer = lambda data: data[:107] + struct.pack("<I", struct.unpack_from("<I", data, 107)[0] // 2) + data[111:]
    more = lambda data: data[:107] + struct.pack("<I", struct.unpack_from("<I", data, 107)[0] * 2 + 9) + data[111:]
    kind("header counts fewer", patch=fewer, refuse="header promises", count=50)
    kind("header counts more", patch=more, refuse="header promises", count=50)
    kind("header counts more", patch=more, refuse="", packed=True, count=50)
    return kinds


PCD_TYPES = {"F 4": "f4", "F 8": "f8", "U 1": "u1", "U 2": "u2", "U 4": "u4", "I 1": "i1", "I 2": "i2", "I 4": "i4"}


def pcd_file(rng, target, data, fields, count=None, comments=b"", height=1, version="0.7", viewpoint="0 0 0 1 0 0 0"):
    """An own writer; fields are (name, type, values of one). Returns the columns."""
    n = int(rng.integers(1, 60)) * height if count is None else count
    columns = []
    for name, type_, width in fields:
        code = np.dtype("<" + PCD_TYPES[type_])
        shape = (n, width)
        if code.kind == "f":
            columns.append(rng.normal(0, 10, shape).astype(code))
        else:
            columns.append(rng.integers(np.iinfo(code).min, np.iinfo(code).max, shape, dtype=code.newbyteorder("="), endpoint=True).astype(code))
    text = "".join([
        f"VERSION {version}\n", "FIELDS " + " ".join(f[0] for f in fields) + "\n",
        "SIZE " + " ".join(f[1].split()[1] for f in fields) + "\n", "TYPE " + " ".join(f[1].split()[0] for f in fields) + "\n",
        "COUNT " + " ".join(str(f[2]) for f in fields) + "\n", f"WIDTH {n // height}\nHEIGHT {height}\n",
        f"VIEWPOINT {viewpoint}\nPOINTS {n}\nDATA {data}\n"])
    if data == "ascii":
        numbers = [[v for c in columns for v in c[k].tolist()] for k in range(n)]
        body = "".join(" ".join(map(repr, row)) + "\n" for row in numbers).encode()
    else:
        record = np.dtype([(str(k), c.dtype, (c.shape[1],)) for k, c in enumerate(columns)])
        table = np.zeros(n, record)
        for k, c in enumerate(columns):
            table[str(k)] = c
        body = table.tobytes()
    with open(target, "wb") as file:
        file.write(b"# .PCD v0.7 - Point Cloud Data file format\n" + comments + text.encode() + body)
    return columns


def pcd_kinds(rng):
    kinds = {}
    position = [("x", "F 4", 1), ("y", "F 4", 1), ("z", "F 4", 1)]

    def kind(name, data, fields, peers=("open3d",), refuse=None, **how):
        name = f"pcd/{data}/{name}"
        def make(target):
            columns = pcd_file(rng, target, data, fields, **how)
            if refuse is not None:
                return Case(name, target, "cloud", None, refuse=refuse)
            table = {}
            for (field, _, width), values in zip(fields, columns):
                if field == "_":
                    continue
                table |= {field if width == 1 else f"{field}_{k}": values[:, k].astype(float) for k in range(width)}
            points = np.stack([table.pop(axis) for axis in "xyz"], axis=1)
            return Case(name, target, "cloud", Data(points, table), peers)
        kinds[name] = make

    for data in ("ascii", "binary"):
        for type_ in PCD_TYPES:
            kind(f"property {type_}", data, [*position, ("value", type_, 1)])
        for type_ in ("F 4", "F 8"):
            kind(f"position {type_}", data, [(a, type_, 1) for a in "xyz"])
        kind("property in front", data, [("i", "U 4", 1), *position])
        kind("order z y x", data, position[::-1])
        kind("COUNT 3", data, [*position, ("histogram", "F 4", 3)])
        kind("padding", data, [*position, ("_", "U 1", 4), ("intensity", "F 4", 1)], ("open3d",))
        kind("paddings", data, [*position, ("_", "U 1", 4), ("i", "F 4", 1), ("_", "U 1", 12)], ())
        kind("comments", data, position, comments=b"# made by a scanner\n\n# twice\n")
        kind("organized", data, position, height=4)
        kind("version .7", data, position, version=".7")
        kind("one point", data, position, count=1)
    for binary, packed in ((False, False), (True, False), (True, True)):
        name = f"pcd/by Open3D, {'packed' if packed else 'binary' if binary else 'ascii'}"
        def make(target, binary=binary, packed=packed, name=name):
            import open3d
            points = rng.normal(0, 10, (int(rng.integers(1, 3000)), 3)).astype("f4").astype(float)
            cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
            open3d.io.write_point_cloud(target, cloud, write_ascii=not binary, compressed=packed)
            return Case(name, target, "cloud", Data(points), ("open3d",), 1e-6)
        kinds[name] = make
    return kinds


def kinds(rng, path):
    return {**las_kinds(rng), **pcd_kinds(rng)}
