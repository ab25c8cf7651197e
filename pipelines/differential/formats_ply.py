"""PLY: clouds and meshes of every encoding, type, order of properties and of elements."""
import numpy as np
from data import Case, Data

TYPES = {"char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4", "double": "f8",
         "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4", "float32": "f4", "float64": "f8"}
ENCODINGS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}


def column(rng, kind, count):
    """Numbers that a type holds."""
    code = np.dtype(TYPES[kind])
    if code.kind == "f":
        return rng.normal(0, 10, count).astype(code)
    low, high = np.iinfo(code).min, np.iinfo(code).max
    return rng.integers(low, high, count, dtype=code, endpoint=True)


def rows(encoding, columns):
    """The rows of columns, in bytes."""
    if encoding == "ascii":
        text = [[repr(float(v)) if values.dtype.kind == "f" else str(int(v)) for v in values] for values in columns]
        return "".join(" ".join(row) + "\n" for row in zip(*text)).encode()
    order = ENCODINGS[encoding]
    record = np.dtype([(str(k), order + values.dtype.str[1:]) for k, values in enumerate(columns)])
    table = np.zeros(len(columns[0]) if columns else 0, record)
    for k, values in enumerate(columns):
        table[str(k)] = values
    return table.tobytes()


def lists(encoding, count_type, type_, items):
    """A list property of each row."""
    if encoding == "ascii":
        return "".join(" ".join(map(str, [len(row), *row])) + "\n" for row in items).encode()
    order = ENCODINGS[encoding]
    count, code = np.dtype(order + TYPES[count_type]), np.dtype(order + TYPES[type_])
    return b"".join(np.array(len(row), count).tobytes() + np.array(row, code).tobytes() for row in items)


def head(encoding, elements, comments=(), end="\n"):
    """The header; elements are (name, count, [property lines])."""
    lines = ["ply", f"format {encoding} 1.0", *comments]
    for name, count, properties in elements:
        lines += [f"element {name} {count}", *[f"property {line}" for line in properties]]
    return (end.join([*lines, "end_header"]) + end).encode()


def cloud(rng, encoding, position="float", names=("x", "y", "z"), extra=(), count=None):
    """Properties and columns of a cloud; `extra` are (name, type), names ending in < go before the position."""
    count = int(rng.integers(1, 60)) if count is None else count
    before = [(name[:-1], kind) for name, kind in extra if name.endswith("<")]
    after = [(name, kind) for name, kind in extra if not name.endswith("<")]
    fields = [*before, *[(name, position) for name in names], *after]
    return [(name, kind, column(rng, kind, count)) for name, kind in fields]


def of(fields):
    """The truth of a cloud."""
    points = np.stack([next(v for n, _, v in fields if n.lower() == axis).astype(float) for axis in "xyz"], axis=1)
    return Data(points, {n: v.astype(float) for n, _, v in fields if n.lower() not in ("x", "y", "z")})


def write(path, *parts):
    with open(path, "wb") as file:
        file.write(b"".join(parts))


def clouds(rng, path):
    """Kinds of clouds: name → a function that writes one and returns its case."""
    kinds = {}

    def kind(name, encoding, build, peers=("plyfile",), **how):
        def make(target):
            fields = build()
            data = rows(encoding, [v for _, _, v in fields])
            element = ("vertex", len(fields[0][2]), [f"{k} {n}" for n, k, _ in fields])
            options = dict(how)
            before, after = options.pop("before", b""), options.pop("after", b"")
            elements = [*options.pop("first", []), element, *options.pop("later", [])]
            text = head(encoding, elements, options.pop("comments", ()), options.pop("end", "\n"))
            write(target, text, before, data, after)
            return Case(f"ply/{encoding}/{name}", target, "cloud", of(fields), peers, **options)
        kinds[f"ply/{encoding}/{name}"] = make

    for e in ENCODINGS:
        for type_ in TYPES:
            kind(f"property {type_}", e, lambda e=e, t=type_: cloud(rng, e, "double", extra=[("value", t)]))
            if TYPES[type_][0] != "u":
                kind(f"position {type_}", e, lambda e=e, t=type_: cloud(rng, e, t))
        kind("properties before the position", e, lambda e=e: cloud(rng, e, extra=[("a<", "uchar"), ("b<", "double"), ("c", "short")]))
        kind("order z y x", e, lambda e=e: cloud(rng, e, names=("z", "y", "x"), extra=[("i", "ushort")]))
        kind("capitals", e, lambda e=e: cloud(rng, e, names=("X", "Y", "Z")))
        kind("colours and normals", e, lambda e=e: cloud(rng, e, extra=[(n, "float") for n in ("nx", "ny", "nz")] + [(n, "uchar") for n in ("red", "green", "blue", "alpha")]), ("plyfile", "open3d"))
        kind("comments", e, lambda e=e: cloud(rng, e), comments=["comment a b", "obj_info x", "comment "])
        kind("CRLF", e, lambda e=e: cloud(rng, e), end="\r\n", peers=("plyfile",))
        kind("no points", e, lambda e=e: cloud(rng, e, count=0))
        kind("one point", e, lambda e=e: cloud(rng, e, count=1))
        kind("many properties", e, lambda e=e: cloud(rng, e, extra=[(f"p{k}", list(TYPES)[k % 16]) for k in range(60)]))
        kind("an element behind", e, lambda e=e: cloud(rng, e), later=[("camera", 2, ["float f"])], after=rows(e, [np.array([1, 2], "f4")]))
        kind("an element in front", e, lambda e=e: cloud(rng, e), first=[("camera", 2, ["float f"])], before=rows(e, [np.array([1, 2], "f4")]))
        kind("a list in front", e, lambda e=e: cloud(rng, e), first=[("strip", 2, ["list uchar int ids"])], before=lists(e, "uchar", "int", [[1, 2, 3], [4]]))
        kind("cut", e, lambda e=e: cloud(rng, e, count=30), later=[("end", 1, ["double f"])], peers=(), refuse="")
        kind("rows behind the end", e, lambda e=e: cloud(rng, e), after=rows(e, [np.arange(9, dtype="f4")] * 3), peers=(), refuse="")
        kind("a line end behind", e, lambda e=e: cloud(rng, e), after=b"\n")
    return kinds


def solid(rng):
    """Corners and polygons of a box that is bent a little, so that no two corners are alike."""
    corners = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)], float) * rng.uniform(0.5, 5, 3)
    corners += rng.normal(0, 10, 3)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners, quads


def fans(polygons):
    return np.array([[p[0], p[k], p[k + 1]] for p in polygons for k in range(1, len(p) - 1)], int)


def meshes(rng, path):
    """Kinds of meshes."""
    kinds = {}

    def kind(name, encoding, count_type="uchar", type_="int", list_name="vertex_indices", triangles=True, position="double", peers=("trimesh",), **how):
        def make(target):
            corners, quads = solid(rng)
            corners = corners.astype(TYPES[position])
            polygons = fans(quads).tolist() if triangles else quads
            options = dict(how)
            properties = [f"{position} {axis}" for axis in "xyz"]
            faces = ("face", len(polygons), [f"list {count_type} {type_} {list_name}"])
            vertex = ("vertex", 8, properties)
            data = [rows(encoding, list(corners.T)), lists(encoding, count_type, type_, polygons)]
            elements = [vertex, faces]
            if options.pop("faces_first", False):
                elements, data = elements[::-1], data[::-1]
            write(target, head(encoding, elements), *data)
            truth = Data(corners.astype(float), faces=fans(polygons))
            return Case(f"ply-mesh/{encoding}/{name}", target, "mesh", truth, peers, soup=triangles, area=not triangles, **options)
        kinds[f"ply-mesh/{encoding}/{name}"] = make

    for e in ENCODINGS:
        for count_type in ("uchar", "ushort", "int", "uint8", "uint32", "short"):
            kind(f"counts {count_type}", e, count_type)
        for type_ in ("uchar", "ushort", "uint", "int32", "short", "char"):
            kind(f"indices {type_}", e, type_=type_)
        kind("vertex_index", e, list_name="vertex_index")
        kind("floats", e, position="float", peers=("trimesh", "pymeshlab", "open3d_mesh"))
        kind("quads", e, triangles=False, peers=("trimesh", "pymeshlab"))
        kind("faces in front", e, faces_first=True, peers=())
    return kinds


def kinds(rng, path):
    return {**clouds(rng, path), **meshes(rng, path)}
