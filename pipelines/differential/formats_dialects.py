"""The same contents in the dialects of many programs: blanks, cases, comments, exponents, missing lines, further lists."""
import numpy as np
from data import Case, Data
from formats_ply import ENCODINGS, fans, head, lists, rows, solid, write
from formats_text import facets, stl_text


def ply_heads(rng):
    found = {}

    def kind(name, encoding, change, peers=()):
        def make(target):
            n = int(rng.integers(1, 40))
            points = rng.normal(0, 9, (n, 3)).astype("f4")
            text = head(encoding, [("vertex", n, [f"float {a}" for a in "xyz"])], ["comment c"])
            write(target, change(text), rows(encoding, list(points.T)))
            return Case(f"ply-head/{encoding}/{name}", target, "cloud", Data(points.astype(float), {}), peers)
        found[f"ply-head/{encoding}/{name}"] = make

    for e in ENCODINGS:
        kind("blanks behind lines", e, lambda t: t.replace(b"\n", b" \n"))
        kind("two blanks between words", e, lambda t: t.replace(b"property float", b"property  float"))
        kind("tabs between words", e, lambda t: t.replace(b"property float ", b"property\tfloat\t"))
        kind("a comment in front of the format", e, lambda t: t.replace(b"ply\n", b"ply\ncomment first\n"))
        kind("a comment of nothing", e, lambda t: t.replace(b"comment c\n", b"comment\n"))
        kind("a comment in Latin-1", e, lambda t: t.replace(b"comment c", "comment Größe".encode("latin-1")))
        kind("a comment in UTF-8", e, lambda t: t.replace(b"comment c", "comment Größe".encode()))
        kind("obj_info", e, lambda t: t.replace(b"comment c", b"obj_info num_cols 512"))
        kind("an element without rows", e, lambda t: t.replace(b"end_header", b"element face 0\nproperty list uchar int vertex_indices\nend_header"), ("plyfile",))
    return found


def ply_lists(rng):
    """Meshes whose faces or vertices have further properties."""
    found = {}

    def kind(name, encoding, face, vertex=(), soup=True):
        def make(target):
            corners, quads = solid(rng)
            polygons = fans(quads).tolist()
            count = len(polygons)
            parts = [b""] * count
            lines = []
            for kind_, property_ in face:
                lines.append(property_)
                for k, polygon in enumerate(polygons):
                    word = property_.split()
                    if kind_ == "corners":
                        parts[k] += lists(encoding, word[1], word[2], [polygon])
                    elif kind_ == "list":
                        parts[k] += lists(encoding, word[1], word[2], [[0.5] * 6])
                    else:
                        parts[k] += rows(encoding, [np.array([k % 100], "u1")])
            if encoding == "ascii":
                parts = [part.replace(b"\n", b" ") + b"\n" for part in parts]
            fields = [("double " + a, c) for a, c in zip("xyz", corners.T)]
            fields += [(line, np.arange(8).astype(code)) for line, code in vertex]
            elements = [("vertex", 8, [line for line, _ in fields]), ("face", count, lines)]
            write(target, head(encoding, elements), rows(encoding, [c for _, c in fields]), *parts)
            return Case(f"ply-lists/{encoding}/{name}", target, "mesh", Data(corners, faces=np.array(polygons)), ("trimesh",), soup=soup)
        found[f"ply-lists/{encoding}/{name}"] = make

    corner = ("corners", "list uchar int vertex_indices")
    for e in ENCODINGS:
        kind("texture behind", e, [corner, ("list", "list uchar float texcoord")])
        kind("texture in front", e, [("list", "list uchar float texcoord"), corner])
        kind("flags in front", e, [("byte", "uchar flags"), corner])
        kind("colours behind", e, [corner, ("byte", "uchar red"), ("byte", "uchar green"), ("byte", "uchar blue")])
        kind("colours of vertices", e, [corner], [("uchar red", "u1"), ("uchar green", "u1"), ("uchar blue", "u1")])
        kind("quality of vertices", e, [corner], [("float quality", "f4"), ("int id", "i4")])
    return found


def stl_dialects(rng):
    found = {}

    def kind(name, change, peers=(), number=repr, refuse=None):
        def make(target):
            corners, faces = facets(rng)
            text = change(stl_text(corners, faces, number=number))
            write(target, text if isinstance(text, bytes) else text.encode())
            if refuse is not None:
                return Case(f"stl-text/{name}", target, "mesh", None, refuse=refuse)
            return Case(f"stl-text/{name}", target, "mesh", Data(corners, faces=faces), peers, 1e-6, soup=True)
        found[f"stl-text/{name}"] = make

    # Every program writes an element a line.
    kind("all on one line", lambda t: " ".join(t.split()), refuse="is missing")
    kind("a word a line", lambda t: "\n".join(t.split()), refuse="is no line of STL here")
    kind("tabs", lambda t: t.replace("  ", "\t"), ("trimesh",))
    kind("no blanks in front", lambda t: "\n".join(line.strip() for line in t.split("\n")), ("trimesh",))
    kind("blank lines", lambda t: t.replace("\n", "\n\n"))
    kind("Facet Normal", lambda t: t.replace("facet normal", "Facet Normal").replace("vertex", "Vertex"))
    kind("no line end", lambda t: t.rstrip("\n"), ("trimesh",))
    kind("endsolid without its name", lambda t: t.replace("endsolid box", "endsolid"), ("trimesh",))
    kind("another name at its end", lambda t: t.replace("endsolid box", "endsolid other"), ("trimesh",))
    kind("blanks behind lines", lambda t: t.replace("\n", "  \n"), ("trimesh",))
    kind("carriage returns", lambda t: t.replace("\n", "\r"))
    kind("numbers with E+000", lambda t: t, ("trimesh",), lambda v: f"{v:.9E}".replace("E+", "E+0").replace("E-", "E-0"))
    kind("numbers with plus", lambda t: t, ("trimesh",), lambda v: f"{v:+.9f}")
    kind("a name like a word of the format", lambda t: t.replace("solid box", "solid facet normal"))
    kind("a comment behind the name", lambda t: t.replace("solid box\n", "solid box ;made by x y z\n", 1))
    return found


def obj_dialects(rng):
    found = {}

    def kind(name, change, peers=()):
        def make(target):
            corners, quads = solid(rng)
            polygons = fans(quads).tolist()
            text = "".join(f"v {' '.join(map(repr, v.tolist()))}\n" for v in corners) + "".join(f"f {' '.join(str(k + 1) for k in p)}\n" for p in polygons)
            write(target, change(text).encode())
            return Case(f"obj-text/{name}", target, "mesh", Data(corners, faces=np.array(polygons)), peers, 1e-6, soup=True)
        found[f"obj-text/{name}"] = make

    kind("comments behind lines", lambda t: t.replace("\n", " # c\n"))
    kind("blanks in front", lambda t: "  " + t.replace("\n", "\n  "))
    kind("blanks behind lines", lambda t: t.replace("\n", "  \n"), ("trimesh",))
    kind("blank lines", lambda t: "\n" + t.replace("\n", "\n\n"), ("trimesh",))
    kind("two blanks between words", lambda t: t.replace(" ", "  "), ("trimesh",))
    kind("byte order mark", lambda t: "\ufeff" + t)
    kind("no line end", lambda t: t.rstrip("\n"), ("trimesh",))
    kind("carriage returns", lambda t: t.replace("\n", "\r"))
    kind("free forms", lambda t: t + "vp 0.1\ncstype bezier\ndeg 3\nend\n")
    kind("an object a face", lambda t: t.replace("f ", "o part\nf "))
    kind("smoothing off", lambda t: t.replace("f ", "s off\nf "), ("trimesh",))
    kind("vertices between faces", lambda t: t + "v 9 9 9\n", ())
    return found


def pcd_heads(rng):
    found = {}

    def kind(name, change, fields="x y z", peers=(), body=None, refuse=None):
        def make(target):
            n = int(rng.integers(1, 40))
            points = rng.normal(0, 9, (n, 3)).astype("f4").astype(float)
            text = (f"# .PCD v0.7\nVERSION 0.7\nFIELDS {fields}\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH {n}\nHEIGHT 1\n"
                    f"VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {n}\nDATA ascii\n")
            lines = "".join(" ".join(map(repr, p.tolist())) + "\n" for p in points)
            write(target, (change(text) + (body(lines) if body else lines)).encode())
            if refuse is not None:
                return Case(f"pcd-head/{name}", target, "cloud", None, refuse=refuse)
            return Case(f"pcd-head/{name}", target, "cloud", Data(points, {}), peers)
        found[f"pcd-head/{name}"] = make

    without = lambda word: lambda t: "".join(line for line in t.splitlines(True) if not line.startswith(word))
    kind("plain", lambda t: t, peers=("open3d",))
    kind("no first comment", without("# .PCD"), peers=("open3d",))
    kind("no VERSION", without("VERSION"), refuse="VERSION entry not found")
    kind("no COUNT", without("COUNT"))
    kind("no VIEWPOINT", without("VIEWPOINT"))
    kind("no POINTS", without("POINTS"), refuse="POINTS entry not found")
    kind("CRLF", lambda t: t.replace("\n", "\r\n"), body=lambda b: b.replace("\n", "\r\n"))
    kind("two blanks between words", lambda t: t.replace(" ", "  "))
    kind("tabs", lambda t: t.replace(" ", "\t"))
    kind("blanks behind lines", lambda t: t.replace("\n", " \n"))
    kind("COLUMNS", lambda t: t.replace("FIELDS", "COLUMNS"))
    kind("blank lines behind", lambda t: t, body=lambda b: b + "\n\n")
    kind("no line end", lambda t: t, body=lambda b: b.rstrip("\n"))
    kind("tabs between numbers", lambda t: t, body=lambda b: b.replace(" ", "\t"))
    kind("two blanks between numbers", lambda t: t, body=lambda b: b.replace(" ", "  "))
    return found


def text_dialects(rng):
    found = {}

    def kind(name, change, columns=("wear",), refuse=None, hole=None):
        def make(target):
            n = int(rng.integers(2, 40))
            table = np.round(rng.normal(0, 9, (n, 3 + len(columns))), 6)
            lines = [[repr(v) for v in row] for row in table.tolist()]
            if hole is not None:
                lines[1][3] = hole
                table[1, 3] = np.nan
            data = change(lines, list(columns))
            write(target, data if isinstance(data, bytes) else data.encode())
            if refuse is not None:
                return Case(f"dialect/{name}", target, "cloud", None, refuse=refuse)
            return Case(f"dialect/{name}", target, "cloud", Data(table[:, :3], {c: table[:, 3 + k] for k, c in enumerate(columns)}), ())
        found[f"dialect/{name}"] = make

    def plain(lines, columns, separator=",", end="\n", first=None):
        first = separator.join(["x", "y", "z", *columns]) if first is None else first
        return end.join([first, *(separator.join(row) for row in lines)]) + end

    kind("carriage returns", lambda t, c: plain(t, c, end="\r"))
    kind("a separator behind each line", lambda t, c: plain(t, c).replace("\n", ",\n"))
    kind("a byte order mark and CRLF", lambda t, c: "\ufeff" + plain(t, c, end="\r\n"))
    kind("quoted numbers", lambda t, c: plain([[f'"{v}"' for v in row] for row in t], c))
    kind("blanks around commas", lambda t, c: plain(t, c, " , "))
    for hole in ("nan", "NaN", "NAN", "-nan", "nan(ind)", "-nan(ind)", "NULL", "NA", "N/A", "-", "1.#QNAN", "#N/A"):
        kind(f"no value: {hole}", lambda t, c: plain(t, c), hole=hole)
    kind("exponents of Fortran", lambda t, c: plain([[f"{float(v):.9e}".replace("e", "D") for v in row] for row in t], c))
    kind("names in capitals", lambda t, c: plain(t, c, first="X,Y,Z,wear"))
    kind("names of CloudCompare", lambda t, c: plain(t, c, " ", first="//X Y Z wear"))
    kind("names in brackets", lambda t, c: plain(t, c, first="x (m),y (m),z (m),wear (mm)"))
    kind("x_m y_m z_m", lambda t, c: plain(t, c, first="x_m,y_m,z_m,wear"))
    kind("Points:0", lambda t, c: plain([row[3:] + row[:3] for row in t], c, first="wear,Points:0,Points:1,Points:2"))
    kind("east north up", lambda t, c: plain(t, c, first="East,North,Up,wear"))
    kind("two columns of one name", lambda t, c: plain(t, c, first="x,y,z,wear,wear"), ("wear", "c5"))
    kind("a name that is a number", lambda t, c: plain(t, c, first="x,y,z,7"), ("7",))
    kind("comments between", lambda t, c: plain(t[:1], c) + "# c\n" + plain(t[1:], c, first="")[1:])
    kind("thousands", lambda t, c: plain([["1 000.5", *row[1:]] for row in t], c), refuse="")
    return found


def kinds(rng, path):
    return {**ply_heads(rng), **ply_lists(rng), **stl_dialects(rng), **obj_dialects(rng), **pcd_heads(rng), **text_dialects(rng)}
