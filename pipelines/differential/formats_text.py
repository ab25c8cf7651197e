"""Clouds as text, STL and OBJ: every separator, header, encoding and dialect, by the peers' writers and by own ones."""
import struct

import numpy as np
from data import Case, Data
from formats_ply import fans, solid

SEPARATORS = {"space": " ", "tab": "\t", "comma": ",", "semicolon": ";", "blanks": "   ", "comma and blank": ", "}


def write(path, data):
    with open(path, "wb") as file:
        file.write(data if isinstance(data, bytes) else data.encode())


def xyz_kinds(rng):
    kinds = {}

    def kind(name, names=("x", "y", "z"), header=None, separator=" ", end="\n", before="", after="", encode=None, peers=(),
             refuse=None, number=repr, columns=None, rename=None, count=False, values=None):
        name = f"text/{name}"
        def make(target):
            n = int(rng.integers(1, 60))
            table = rng.normal(0, 10, (n, len(names)))
            for k, column in enumerate(names):
                if column in ("red", "green", "blue", "id"):
                    table[:, k] = rng.integers(0, 255, n, endpoint=True)
            if values:
                table = values(table)
            lines = [before] if before else []
            lines += [str(n)] if count else []
            lines += [header] if header is not None else []
            lines += [separator.join("" if np.isnan(v) else number(float(v)) for v in row) for row in table]
            data = (end.join(lines) + end + after).encode()
            write(target, encode(data) if encode else data)
            if refuse is not None:
                return Case(name, target, "cloud", None, refuse=refuse)
            shown = np.array([[float(number(float(v))) if not np.isnan(v) else v for v in row] for row in table])
            truth = {c: shown[:, k] for k, c in enumerate(columns or names)}
            points = np.stack([truth.pop(axis) for axis in "xyz"], axis=1)
            return Case(name, target, "cloud", Data(points, truth), peers)
        kinds[name] = make

    further = ("x", "y", "z", "wear", "age")
    for word, s in SEPARATORS.items():
        tag = s.strip() or s[0]
        kind(f"{word}", separator=s, peers=("numpy",) if not s.strip() else ())
        kind(f"{word}, names", further, tag.join(further) if s.strip() else " ".join(further) if s != "\t" else "\t".join(further), s)
        kind(f"{word}, # names", further, "# " + (tag.join(further) if s.strip() or s == "\t" else " ".join(further)), s)
        kind(f"{word}, // names", further, "//" + (tag.join(further) if s.strip() or s == "\t" else " ".join(further)), s)
        kind(f"{word}, CRLF", further, tag.join(further) if s.strip() or s == "\t" else " ".join(further), s, "\r\n")
        kind(f"{word}, position last", ("id", "wear", "x", "y", "z"), tag.join(("id", "wear", "x", "y", "z")), s)
        if s.strip() or s == "\t":
            spoken = ("Wall ID", "x", "y", "z", "wear")
            kind(f"{word}, names with blanks", spoken, tag.join(spoken), s, columns=("Wall_ID", "x", "y", "z", "wear"))
            gap = lambda t: np.where(np.arange(t.shape[1]) == 3, np.nan, t)
            kind(f"{word}, an empty column", further, tag.join(further), s, values=gap)
            kind(f"{word}, one name too few", further, tag.join(further[:4]), s, refuse="")
            kind(f"{word}, one name too many", further, tag.join([*further, "more"]), s, refuse="")
            units = "x [m],y [m],z [m],wear [mm],age [d]".replace(",", tag)
            kind(f"{word}, units in names", further, units, s)
    kind("numbers with exponents", number=lambda v: f"{v:.12e}", peers=("numpy",))
    kind("numbers with E+00", number=lambda v: f"{v:.12E}", peers=("numpy",))
    kind("numbers with plus", number=lambda v: f"{v:+.9f}", peers=("numpy",))
    kind("few digits", number=lambda v: f"{v:.1f}", peers=("numpy",))
    kind("whole numbers", number=lambda v: str(int(v)), peers=("numpy",))
    kind("decimal commas", number=lambda v: f"{v:.6f}".replace(".", ","), separator=" ", refuse="", columns=None)
    kind("decimal commas, semicolons", number=lambda v: f"{v:.6f}".replace(".", ","), separator=";", refuse="")
    kind("comments", before="# a scan\n# of a plant", peers=("numpy",))
    kind("// comments", before="// a scan")
    kind("blank lines", before="\n", after="\n\n", peers=("numpy",))
    kind("capitals", ("x", "y", "z", "Wear"), "X Y Z Wear", columns=("x", "y", "z", "Wear"))
    kind("easting northing height", ("x", "y", "z"), "Easting,Northing,Height", ",")
    kind("byte order mark", encode=lambda data: b"\xef\xbb\xbf" + data)
    kind("UTF-16", encode=lambda data: data.decode().encode("utf-16"), refuse="UTF-16")
    kind("UTF-16 big endian", encode=lambda data: b"\xfe\xff" + data.decode().encode("utf-16-be"), refuse="UTF-16")
    kind("Latin-1 comment", before="# Größe", encode=lambda data: data.decode().encode("latin-1"))
    kind("count of PTS", count=True)
    kind("PTS with intensity", ("x", "y", "z", "intensity"), count=True)
    kind("PTS with colours", ("x", "y", "z", "intensity", "red", "green", "blue"), count=True)
    kind("id first, id last", ("id", "x", "y", "z"), "id x y z")
    kind("quoted names", further, ",".join(f'"{name}"' for name in further), ",")
    kind("units below the names", ("x", "y", "z"), "X Y Z\n[m] [m] [m]")
    kind("no line end", encode=lambda data: data.rstrip(b"\n"))
    kind("trailing separators", ("x", "y", "z"), separator=" ", end=" \n", peers=("numpy",))
    kind("leading blanks", number=lambda v: f"  {v:.9f}", peers=("numpy",))
    kind("a word among the numbers", encode=lambda data: data + b"1 2 three\n", refuse="")
    kind("a short row", encode=lambda data: data + b"1 2\n", refuse="")
    return kinds


def facets(rng, count=None):
    corners, quads = solid(rng)
    return corners, fans(quads)


def stl_text(corners, faces, name=" box", normal="0 0 0", end="\n", number=repr, upper=False):
    lines = [f"solid{name}"]
    for face in faces:
        lines += [f"  facet normal {normal}", "    outer loop"]
        lines += ["      vertex " + " ".join(number(float(v)) for v in corners[k]) for k in face]
        lines += ["    endloop", "  endfacet"]
    text = end.join([*lines, f"endsolid{name}", ""])
    return text.upper().replace("E+", "E+") if upper else text


def stl_binary(corners, faces, head=b"", count=None, behind=b"", attribute=0):
    data = head.ljust(80, b"\0")[:80] + struct.pack("<I", len(faces) if count is None else count)
    for face in faces:
        data += struct.pack("<3f", 0, 0, 0) + corners[face].astype("<f4").tobytes() + struct.pack("<H", attribute)
    return data + behind


def stl_kinds(rng):
    kinds = {}
    three = ("trimesh", "pymeshlab", "open3d_mesh")

    def kind(name, build, peers=("trimesh",), refuse=None, single=False, twice=False):
        name = f"stl/{name}"
        def make(target):
            corners, faces = facets(rng)
            if twice:
                others, _ = facets(rng)
                write(target, build((corners, faces), (others, faces)))
                truth = Data(np.concatenate([corners, others]), faces=np.concatenate([faces, faces + 8]))
            else:
                write(target, build(corners, faces))
                truth = Data(corners.astype("f4").astype(float) if single else corners, faces=faces)
            if refuse is not None:
                return Case(name, target, "mesh", None, refuse=refuse)
            return Case(name, target, "mesh", truth, peers, 1e-6, soup=True)
        kinds[name] = make

    kind("text", stl_text, three)
    for word, solid_name in {"no name": "", "long name": " " + "n" * 300, "two words": " a b", "digits": " 12", "tab": "\tname"}.items():
        kind(f"text, {word}", lambda c, f, s=solid_name: stl_text(c, f, s))
    kind("text, capitals", lambda c, f: stl_text(c, f, upper=True))
    kind("text, CRLF", lambda c, f: stl_text(c, f, end="\r\n"), three)
    kind("text, nan normals", lambda c, f: stl_text(c, f, normal="nan nan nan"))
    kind("text, exponents", lambda c, f: stl_text(c, f, number=lambda v: f"{v:.9e}"), three)
    kind("text, blank line first", lambda c, f: "\n" + stl_text(c, f), ())
    kind("text, blanks first", lambda c, f: "  " + stl_text(c, f), ())
    kind("text, byte order mark", lambda c, f: b"\xef\xbb\xbf" + stl_text(c, f).encode(), ())
    kind("text, Latin-1 name", lambda c, f: stl_text(c, f, " Größe").encode("latin-1"), ())
    kind("text, map coordinates", lambda c, f: stl_text(c + np.array([5e5, 5.5e6, 0]), f), ())
    kinds["stl/text, map coordinates"] = exact("stl/text, map coordinates", lambda: moved(rng), lambda c, f: stl_text(c, f))
    kind("text, two solids", lambda a, b: stl_text(*a, " one") + stl_text(*b, " two"), ("trimesh",), twice=True)
    kind("text, two solids without a name", lambda a, b: stl_text(*a, "") + "\n" + stl_text(*b, ""), ("trimesh",), twice=True)
    kind("text, cut", lambda c, f: stl_text(c, f)[:-90], refuse="", peers=())
    kind("text, cut in the second solid", lambda a, b: (stl_text(*a) + stl_text(*b))[:-200], refuse="", peers=(), twice=True)
    for word, head in {"empty": b"", "solid": b"solid cube", "solid and line end": b"solid cube\n", "facet": b"solid x facet normal", "blanks": b" " * 80, "bytes": bytes(range(128, 208))}.items():
        kind(f"binary, head {word}", lambda c, f, h=head: stl_binary(c, f, h), three if word == "empty" else ("trimesh",), single=True)
    kind("binary, colours", lambda c, f: stl_binary(c, f, b"COLOR=abcd", attribute=0x8123), single=True)
    kind("binary, two bytes behind", lambda c, f: stl_binary(c, f, behind=b"\0\0"), (), single=True)
    kind("binary, text behind", lambda c, f: stl_binary(c, f, behind=b"made by X\n"), (), single=True)
    kind("binary, cut", lambda c, f: stl_binary(c, f)[:-60], (), refuse="")
    kind("binary, count too large", lambda c, f: stl_binary(c, f, count=99), (), refuse="")
    for peer in ("trimesh", "meshio", "open3d", "pymeshlab"):
        for binary in (True, False):
            if peer == "open3d" and not binary:
                # It writes no STL as text.
                continue
            name = f"stl/by {peer}, {'binary' if binary else 'text'}"
            kinds[name] = by_peer(name, rng, peer, "stl", binary)
    return kinds


def moved(rng):
    corners, faces = facets(rng)
    return corners + np.array([5e5, 5.5e6, 0]), faces


def exact(name, build, text):
    def make(target):
        corners, faces = build()
        write(target, text(corners, faces))
        return Case(name, target, "mesh", Data(corners, faces=faces), (), 1e-12, soup=True)
    return make


def by_peer(name, rng, peer, ending, binary):
    """A mesh that another program wrote."""
    def make(target):
        corners, faces = facets(rng)
        corners = corners.astype("f4").astype(float)
        out = f"{target}.{ending}"
        if peer == "trimesh":
            import trimesh
            kind = {("stl", True): "stl", ("stl", False): "stl_ascii"}.get((ending, binary), ending)
            how = dict(encoding="binary" if binary else "ascii") if ending == "ply" else {}
            data = trimesh.exchange.export.export_mesh(trimesh.Trimesh(corners, faces, process=False), None, file_type=kind, **how)
            write(out, data)
        elif peer == "meshio":
            import meshio
            how = dict(binary=binary) if ending in ("stl", "ply") else {}
            meshio.Mesh(corners, [("triangle", faces)]).write(out, **how)
        elif peer == "open3d":
            import open3d
            mesh = open3d.geometry.TriangleMesh(open3d.utility.Vector3dVector(corners), open3d.utility.Vector3iVector(faces.astype("i4")))
            mesh.compute_triangle_normals()
            open3d.io.write_triangle_mesh(out, mesh, write_ascii=not binary)
        else:
            import pymeshlab
            meshes = pymeshlab.MeshSet(verbose=False)
            meshes.add_mesh(pymeshlab.Mesh(corners, faces))
            meshes.save_current_mesh(out, **(dict(binary=binary) if ending != "obj" else {}))
        return Case(name, out, "mesh", Data(corners, faces=faces), ("trimesh",), 3e-5, soup=True)
    return make


def obj_kinds(rng):
    kinds = {}

    def kind(name, build, peers=("trimesh",), refuse=None, area=False, quads=False):
        name = f"obj/{name}"
        def make(target):
            corners, faces = solid(rng)
            polygons = faces if quads else fans(faces).tolist()
            write(target, build(corners, polygons))
            if refuse is not None:
                return Case(name, target, "mesh", None, refuse=refuse)
            return Case(name, target, "mesh", Data(corners, faces=fans(polygons)), peers, 1e-6, soup=not area, area=area)
        kinds[name] = make

    def text(corners, polygons, corner=lambda k: str(k + 1), end="\n", vertex=lambda v: " ".join(map(repr, v.tolist())), before="", middle="", after=""):
        lines = [before] if before else []
        lines += [f"v {vertex(v)}" for v in corners]
        lines += [middle] if middle else []
        lines += ["f " + " ".join(corner(k) for k in p) for p in polygons]
        return end.join([*lines, *([after] if after else []), ""])

    kind("plain", text, ("trimesh", "pymeshlab", "open3d_mesh", "meshio"))
    kind("quads", text, ("trimesh", "pymeshlab"), area=True, quads=True)
    kind("CRLF", lambda c, p: text(c, p, end="\r\n"))
    textures = "vt 0 0\nvn 0 0 1"
    kind("v/vt", lambda c, p: text(c, p, lambda k: f"{k + 1}/1", middle=textures))
    kind("v//vn", lambda c, p: text(c, p, lambda k: f"{k + 1}//1", middle=textures))
    kind("v/vt/vn", lambda c, p: text(c, p, lambda k: f"{k + 1}/1/1", middle=textures))
    kind("negative indices", lambda c, p: text(c, p, lambda k: str(k - 8)))
    kind("colours of vertices", lambda c, p: text(c, p, vertex=lambda v: " ".join(map(repr, [*v.tolist(), 0.5, 0.5, 0.5]))))
    kind("w of vertices", lambda c, p: text(c, p, vertex=lambda v: " ".join(map(repr, [*v.tolist(), 1.0]))))
    kind("comments", lambda c, p: text(c, p, before="# a\n#", middle="# b"))
    kind("groups", lambda c, p: text(c, p, middle="o box\ng side\nusemtl steel\ns 1"))
    kind("mtllib", lambda c, p: text(c, p, before="mtllib none.mtl"))
    kind("Latin-1", lambda c, p: text(c, p, before="# Größe").encode("latin-1"), ())
    kind("lines", lambda c, p: text(c, p, after="l 1 2 3"))
    kind("points", lambda c, p: text(c, p, after="p 1 2"), ())
    kind("continued lines", lambda c, p: text(c, p).replace("f ", "f \\\n"), ())
    kind("faces before vertices", lambda c, p: "\n".join(["f " + " ".join(str(k + 1) for k in q) for q in p] + [f"v {' '.join(map(repr, v.tolist()))}" for v in c]), ())
    kind("exponents", lambda c, p: text(c, p, vertex=lambda v: " ".join(f"{x:.9e}" for x in v)))
    kind("tabs", lambda c, p: text(c, p).replace(" ", "\t"), ())
    kind("an index too large", lambda c, p: text(c, p, after="f 1 2 99"), (), refuse="")
    kind("an index 0", lambda c, p: text(c, p, after="f 0 1 2"), (), refuse="")
    kind("a face of two corners", lambda c, p: text(c, p, after="f 1 2"), (), refuse="")
    kind("cut in the last face", lambda c, p: text(c, p)[:-5], (), refuse="")
    for peer in ("trimesh", "meshio", "open3d", "pymeshlab"):
        kinds[f"obj/by {peer}"] = by_peer(f"obj/by {peer}", rng, peer, "obj", False)
        for binary in (True, False):
            name = f"ply-mesh/by {peer}, {'binary' if binary else 'text'}"
            kinds[name] = by_peer(name, rng, peer, "ply", binary)
    return kinds


def kinds(rng, path):
    return {**xyz_kinds(rng), **stl_kinds(rng), **obj_kinds(rng)}
