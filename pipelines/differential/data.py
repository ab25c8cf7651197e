"""What a file holds, and how two programs' views of it are compared."""
from dataclasses import dataclass, field

import numpy as np


@dataclass
class Data:
    """Points (N, 3) [as in the file], named columns (N), triangles (M, 3) of indices of points. `None`: this reader does not say."""
    points: np.ndarray
    columns: dict | None = None
    faces: np.ndarray | None = None


@dataclass
class Case:
    """One file. `truth` is what was written; without one the first peer counts.

    refuse: a part of the message with which our reader must refuse the file, and a documented reason.
    whole: the file is cut, and may be refused; what is accepted must be the truth.
    soup: points are compared as the corners of the faces, because readers weld and order vertices in their own ways.
    area: faces are compared by area and normal alone, because polygons can be cut in several ways.
    """
    kind: str
    path: str
    mode: str
    truth: Data | None
    peers: tuple = ()
    tolerance: float = 1e-6
    refuse: str | None = None
    may_refuse: bool = False
    soup: bool = False
    area: bool = False
    rename: dict = field(default_factory=dict)


def close(a, b, tolerance):
    """Whether numbers are equal up to a share of their size; NaN equals NaN."""
    a, b = np.asarray(a, float), np.asarray(b, float)
    if a.shape != b.shape:
        return False
    same = (a == b) | (np.isnan(a) & np.isnan(b))
    return bool(np.all(same | (np.abs(a - b) <= tolerance * np.maximum(1, np.abs(b)))))


def triangles(data, tolerance):
    """Corners (M, 3, 3) in an order that no reader changes: rounded, each from its smallest corner on, then sorted."""
    corners = data.points[data.faces.astype(int)]
    scale = max(tolerance * max(1.0, float(np.max(np.abs(corners), initial=0))) * 4, 1e-300)
    keys = np.round(corners / scale)
    first = np.array([min(range(3), key=lambda k: tuple(t[k])) for t in keys], int)
    turned = np.stack([np.roll(c, -f, axis=0) for c, f in zip(corners, first)]) if len(corners) else corners
    rounded = np.round(turned / scale).reshape(len(turned), 9)
    return turned[np.lexsort(rounded.T[::-1])]


def area_of(data):
    """Sum of the faces' areas, and of their normals."""
    a, b, c = (data.points[data.faces[:, k].astype(int)] for k in range(3))
    normals = np.cross(b - a, c - a) / 2
    return np.array([np.linalg.norm(normals, axis=1).sum(), *normals.sum(axis=0)])


def difference(found, wanted, case, only_known=False):
    """What differs, in words; nothing if all is the same. With only_known, what `found` does not say is not compared."""
    if case.soup or case.area:
        if found.faces is None or wanted.faces is None:
            return None
        if case.area:
            a, b = area_of(found), area_of(wanted)
            return None if close(a, b, 1e-5) else f"area and normal {a}, not {b}"
        if len(found.faces) != len(wanted.faces):
            return f"{len(found.faces)} faces, not {len(wanted.faces)}"
        a, b = triangles(found, case.tolerance), triangles(wanted, case.tolerance)
        return None if close(a, b, 8 * case.tolerance) else "other corners of faces"
    if len(found.points) != len(wanted.points):
        return f"{len(found.points)} points, not {len(wanted.points)}"
    if not close(found.points, wanted.points, case.tolerance):
        bad = np.argmax(np.nan_to_num(np.abs(found.points - wanted.points).max(axis=1), nan=np.inf))
        return f"point {bad} is {found.points[bad]}, not {wanted.points[bad]}"
    if found.faces is not None and wanted.faces is not None and not np.array_equal(found.faces, wanted.faces):
        return "other faces"
    if wanted.columns is None or found.columns is None:
        return None
    for name, values in wanted.columns.items():
        name = case.rename.get(name, name)
        if name not in found.columns:
            if only_known:
                continue
            return f"no column '{name}', only {sorted(found.columns)}"
        if not close(found.columns[name], values, max(case.tolerance, 1e-6)):
            return f"column '{name}' begins {found.columns[name][:4]}, not {np.asarray(values)[:4]}"
    further = set(found.columns) - {case.rename.get(name, name) for name in wanted.columns}
    if further and not only_known:
        return f"columns that were not written: {sorted(further)}"
    return None
