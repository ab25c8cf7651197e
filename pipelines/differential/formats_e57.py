"""E57 by libE57Format's own writer: every type of field, state, pose, and properties of extensions."""
import numpy as np
from data import Case, Data

NORMALS = "http://www.libe57.org/E57_NOR_surface_normals.txt"
# Columns of the cloud that are named otherwise than the field.
NAMES = {"colorRed": "red", "colorGreen": "green", "colorBlue": "blue", "rowIndex": "row", "columnIndex": "column",
         "nor:normalX": "nx", "nor:normalY": "ny", "nor:normalZ": "nz", "ext:label": "label", "ext:deviation": "deviation"}


def single(values):
    return "single", np.asarray(values, "f4")


def double(values):
    return "double", np.asarray(values, "f8")


def whole(values, low=None, high=None):
    values = np.asarray(values, "i8")
    return ("integer", low if low is not None else int(values.min()), high if high is not None else int(values.max())), values


def scaled(values, scale, offset=0.0):
    raw = np.round((np.asarray(values) - offset) / scale).astype("i8")
    # The writer rounds in its own way.
    return ("scaled", int(raw.min()) - 1, int(raw.max()) + 1, scale, offset), raw * scale + offset


def write(target, scans):
    """Scans are (fields, pose): fields name → (type, values), pose None or (quaternion, shift)."""
    import pye57
    from pye57 import libe57 as lib
    file = pye57.E57(target, mode="w")
    image = file.image_file
    image.extensionsAdd("nor", NORMALS)
    image.extensionsAdd("ext", "http://example.org/ext")
    for number, (fields, pose) in enumerate(scans):
        scan = lib.StructureNode(image)
        scan.set("guid", lib.StringNode(image, f"scan {number}"))
        if pose:
            node = lib.StructureNode(image)
            for part, letters, numbers in (("rotation", "wxyz", pose[0]), ("translation", "xyz", pose[1])):
                inner = lib.StructureNode(image)
                for letter, value in zip(letters, numbers):
                    inner.set(letter, lib.FloatNode(image, float(value)))
                node.set(part, inner)
            scan.set("pose", node)
        prototype, buffers, arrays = lib.StructureNode(image), lib.VectorSourceDestBuffer(), []
        for name, (kind, values) in fields.items():
            if kind in ("single", "double"):
                precision = lib.E57_SINGLE if kind == "single" else lib.E57_DOUBLE
                node = lib.FloatNode(image, 0.0, precision)
            elif kind[0] == "integer":
                node = lib.IntegerNode(image, kind[1], kind[1], kind[2])
            else:
                node = lib.ScaledIntegerNode(image, kind[1], kind[1], kind[2], kind[3], kind[4])
            prototype.set(name, node)
            # Numbers of C's type long, which are those of numpy by default, are taken for 4-byte ones.
            values = values.astype(np.longlong) if values.dtype == np.dtype("i8") else values
            arrays.append(np.ascontiguousarray(values))
            buffers.append(lib.SourceDestBuffer(image, name, arrays[-1], len(values), True, True))
        points = lib.CompressedVectorNode(image, prototype, lib.VectorNode(image, True))
        scan.set("points", points)
        file.data3d.append(scan)
        writer = points.writer(buffers)
        if len(arrays[0]):
            writer.write(len(arrays[0]))
        writer.close()
    file.close()


def matrix(q):
    w, x, y, z = q
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
                     [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
                     [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)]])


def truth(scans):
    """What a cloud of the scans has."""
    points, columns, rows = [], {}, 0
    colors = ("colorRed", "colorGreen", "colorBlue")
    # Scans whose colours have other limits are brought to 0 to 255.
    limits = {fields[c][0][1:3] for fields, _ in scans for c in colors if c in fields}
    for number, (fields, pose) in enumerate(scans):
        value = {name: np.asarray(values, float) for name, (_, values) in fields.items()}
        turn, shift = (matrix(pose[0]), np.asarray(pose[1])) if pose else (np.eye(3), np.zeros(3))
        if "cartesianX" in value:
            local = np.stack([value.pop(f"cartesian{a}") for a in "XYZ"], axis=1)
            state = value.pop("cartesianInvalidState", None)
        else:
            r, a, e = (value.pop(f"spherical{n}") for n in ("Range", "Azimuth", "Elevation"))
            local = np.stack([r * np.cos(e) * np.cos(a), r * np.cos(e) * np.sin(a), r * np.sin(e)], axis=1)
            state = value.pop("sphericalInvalidState", None)
        posed = local @ turn.T + shift
        if state is not None:
            posed[state != 0] = np.nan
        points.append(posed)
        if "nor:normalX" in value:
            normals = np.stack([value[f"nor:normal{a}"] for a in "XYZ"], axis=1) @ turn.T
            value |= {f"nor:normal{a}": normals[:, k] for k, a in enumerate("XYZ")}
        for of, states, hidden in (("intensity", "isIntensityInvalid", np.nan), ("timeStamp", "isTimeStampInvalid", np.nan)):
            off = value.pop(states, None)
            if off is not None:
                value[of] = np.where(off != 0, hidden, value[of])
        off = value.pop("isColorInvalid", None)
        if len(limits) > 1 and "colorRed" in value:
            value |= {c: np.round(255.0 * (value[c] - fields[c][0][1]) / (fields[c][0][2] - fields[c][0][1])) for c in colors}
        if off is not None:
            value |= {c: np.where(off != 0, np.nan, value[c]) for c in colors}
        if len(scans) > 1:
            value["scan"] = np.full(len(local), float(number))
        for name, numbers in value.items():
            columns.setdefault(NAMES.get(name, name), []).append((rows, numbers))
        rows += len(local)
    whole_columns = {}
    for name, parts in columns.items():
        # What a scan lacks: indices −1, everything else no number.
        none = -1.0 if name in ("row", "column") else np.nan
        whole_columns[name] = np.full(rows, none)
        for at, numbers in parts:
            whole_columns[name][at:at + len(numbers)] = numbers
    return Data(np.concatenate(points), whole_columns)


def position(rng, n, kind="double"):
    values = rng.normal(0, 9, (3, n))
    make = {"double": double, "single": single, "scaled": lambda v: scaled(v, 0.001), "shifted": lambda v: scaled(v, 1e-4, 100.0)}[kind]
    return {f"cartesian{a}": make(v) for a, v in zip("XYZ", values)}


def properties(rng, n):
    """Groups of fields by name."""
    up = rng.normal(0, 1, (3, n))
    up /= np.linalg.norm(up, axis=0)
    color = lambda top: {f"color{c}": whole(rng.integers(0, top, n, endpoint=True), 0, top) for c in ("Red", "Green", "Blue")}
    some = lambda: whole(rng.integers(0, 2, n), 0, 1)
    return {
        "intensity, float": {"intensity": single(rng.random(n))},
        "intensity, double": {"intensity": double(rng.random(n))},
        "intensity, 12 bits": {"intensity": whole(rng.integers(0, 4096, n), 0, 4095)},
        "intensity, scaled": {"intensity": scaled(rng.random(n), 1e-3)},
        "intensity, negative": {"intensity": whole(rng.integers(-2048, 2047, n), -2048, 2047)},
        "intensity, states": {"intensity": single(rng.random(n)), "isIntensityInvalid": some()},
        "colours": color(255), "colours of 16 bits": color(65535), "colours, states": {**color(255), "isColorInvalid": some()},
        "grid": {"rowIndex": whole(rng.integers(0, 2000, n), 0, 1999), "columnIndex": whole(rng.integers(0, 3000, n), 0, 2999)},
        "states": {"cartesianInvalidState": whole(rng.integers(0, 3, n), 0, 2)},
        "times": {"timeStamp": double(rng.uniform(0, 1e5, n))},
        "times, scaled": {"timeStamp": scaled(rng.uniform(0, 100, n), 1e-6)},
        "times, states": {"timeStamp": double(rng.uniform(0, 9, n)), "isTimeStampInvalid": some()},
        "returns": {"returnIndex": whole(rng.integers(0, 7, n), 0, 7), "returnCount": whole(rng.integers(1, 8, n), 0, 8)},
        "normals": {f"nor:normal{a}": single(v) for a, v in zip("XYZ", up)},
        "normals, scaled": {f"nor:normal{a}": scaled(v, 1e-4) for a, v in zip("XYZ", up)},
        "an extension": {"ext:label": whole(rng.integers(0, 1 << 40, n), 0, 1 << 40), "ext:deviation": single(rng.random(n))},
        "one value": {"intensity": whole(np.full(n, 7), 7, 7), "returnIndex": whole(np.zeros(n), 0, 0), "returnCount": whole(np.ones(n), 1, 1)},
    }


def kinds(rng, path):
    found = {}

    def pose(posed):
        q = rng.normal(0, 1, 4)
        return (q / np.linalg.norm(q), rng.normal(0, 50, 3)) if posed else None

    def kind(name, build, tolerance=1e-6, peers=("pye57",)):
        def make(target):
            scans = build()
            write(target, scans)
            return Case(f"e57/{name}", target, "cloud", truth(scans), peers, tolerance)
        found[f"e57/{name}"] = make

    count = lambda: int(rng.integers(1, 60))
    for posed in (False, True):
        tag = ", posed" if posed else ""
        for type_ in ("double", "single", "scaled", "shifted"):
            kind(f"position {type_}{tag}", lambda t=type_, p=posed: [(position(rng, count(), t), pose(p))])
        for group in properties(rng, 1):
            def build(group=group, posed=posed):
                n = count()
                return [({**position(rng, n), **properties(rng, n)[group]}, pose(posed))]
            kind(f"{group}{tag}", build, peers=() if group == "states" else ("pye57",))
        for state in (False, True):
            def build(posed=posed, state=state):
                n = count()
                angles = {"sphericalRange": double(rng.uniform(1, 9, n)), "sphericalAzimuth": double(rng.uniform(-3, 3, n)),
                          "sphericalElevation": double(rng.uniform(-1, 1, n))}
                states = {"sphericalInvalidState": whole(rng.integers(0, 3, n), 0, 2)} if state else {}
                return [({**angles, **states}, pose(posed))]
            kind(f"spherical{', states' if state else ''}{tag}", build, peers=() if state else ("pye57",))

        def several(posed=posed):
            scans = []
            for _ in range(int(rng.integers(2, 5))):
                n = count()
                groups = properties(rng, n)
                fields = position(rng, n)
                for group in rng.choice(list(groups), 3):
                    fields |= groups[group]
                fields.pop("isIntensityInvalid", None), fields.pop("isColorInvalid", None), fields.pop("isTimeStampInvalid", None)
                scans.append((fields, pose(posed)))
            return scans
        kind(f"several scans of different fields{tag}", several, peers=())
        kind(f"scans alike{tag}", lambda p=posed: [({**position(rng, 9), **properties(rng, 9)["returns"]}, pose(p)) for _ in range(3)])

    def many():
        n = 40_000
        return [({**position(rng, n, "scaled"), **properties(rng, n)["returns"], **properties(rng, n)["grid"], **properties(rng, n)["one value"]}, None)]
    kind("many packets", many)
    kind("one point", lambda: [(position(rng, 1), None)])
    kind("a scan without points", lambda: [(position(rng, 3), None), ({k: (t, v[:0]) for k, (t, v) in position(rng, 1).items()}, None)], peers=())
    return found
