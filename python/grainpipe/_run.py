"""A run: its frames, and what else its file tells."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any, Iterable, Iterator

import numpy as np

from ._messages import Contents, IncompleteError, Message, Name, table


@dataclass(frozen=True)
class Surface:
    """A plane or a mesh, as it is at t = 0."""

    name: str
    vertices: "np.ndarray | None"  #: corners [m], shape (n, 3); None of a plane
    faces: "np.ndarray | None"  #: corners of each triangle, shape (m, 3); None of a plane
    plane: "np.ndarray | None"  #: a point and the normal, shape (2, 3); None of a mesh
    motion: "dict[str, Any]"  #: as the file has it


class Run:
    """A run from one file, or from several that follow each other (of `dem-run --resume`).

    Where the files overlap in time, the later file counts, as in the other tools.
    """

    def __init__(
        self, *names: Name, topics: "Iterable[str] | None" = None, complete: bool = False
    ) -> None:
        """Reads the files into memory, or of them only some topics: `topics=["/particles"]`.

        With `complete`, a file that has no end is an IncompleteError.
        """
        if not names:
            raise TypeError("give the file of a run")
        self._kept = kept = None if topics is None else set(topics) | {"/log"}
        self._files = [Contents(name, kept) for name in names]
        if complete:
            for file in self._files:
                if not file.is_complete:
                    raise IncompleteError(f"{file.name}: the run is not finished, or was stopped from outside")

    def __repr__(self) -> str:
        names = ", ".join(file.name for file in self._files)
        return f"<grainpipe.Run {names}: {self.topics.get('/particles', 0)} frames>"

    @property
    def is_complete(self) -> bool:
        """Whether each file says that it came to its end (also of a run that a guard stopped)."""
        return all(file.is_complete for file in self._files)

    @property
    def stopped(self) -> "dict[str, Any] | None":
        """Why the run was stopped before its end: {"time": …, "text": …, …}; None where it was not."""
        stops = [note for note in self.log() if note.get("kind") == "stopped"]
        return stops[-1] if stops else None

    @property
    def topics(self) -> "dict[str, int]":
        """Number of messages of each topic, of all files."""
        found: "dict[str, int]" = {}
        for file in self._files:
            for topic, count in file.topics.items():
                found[topic] = found.get(topic, 0) + count
        return found

    @property
    def metadata(self) -> "dict[str, dict[str, str]]":
        """Metadata records of the last file, by name."""
        return self._files[-1].metadata

    @property
    def scene(self) -> str:
        """The scene (TOML) that was run, with everything that was set on the command line."""
        return self.metadata.get("scene", {}).get("toml", "")

    @property
    def materials(self) -> "list[dict[str, Any]]":
        """Materials by index: name, density [kg/m³], young [Pa], poisson."""
        found = self.metadata.get("materials", {})
        return [json.loads(found[key]) for key in sorted(found, key=int)]

    def log(self) -> "list[dict[str, Any]]":
        """Notes of the run, with the time [s], and why it was stopped."""
        return [json.loads(message.data) for file in self._files for message in self._of(file, "/log")]

    def messages(self, topic: str) -> "list[Message]":
        """Messages of a topic in the order of their times."""
        if topic not in self.topics:
            known = ", ".join(sorted(self.topics))
            raise KeyError(f"no topic '{topic}': {known}")
        if self._kept is not None and topic not in self._kept:
            raise KeyError(f"topic '{topic}' was not read: name it in topics=[…]")
        found: "list[Message]" = []
        for file in self._files:
            mine = self._of(file, topic)
            if mine:
                found = [message for message in found if message.time < mine[0].time] + mine
        return found

    @staticmethod
    def _of(file: Contents, topic: str) -> "list[Message]":
        return [message for message in file.messages if message.topic == topic]

    def times(self, topic: str = "/particles") -> np.ndarray:
        """Times of the messages of a topic [s]."""
        return np.array([message.time for message in self.messages(topic)])

    def frames(self, topic: str = "/particles") -> "Iterator[tuple[float, np.ndarray]]":
        """Time [s] and rows of each message of a topic that has tables: /particles, /contacts, /bodies, /bonds, /wall_wear, …"""
        for message in self.messages(topic):
            yield message.time, _rows(message)

    def at(self, time: float, topic: str = "/particles") -> np.ndarray:
        """Rows of the message that is nearest to a time [s]."""
        messages = self.messages(topic)
        if not messages:
            raise ValueError(f"'{topic}' has no message")
        return _rows(min(messages, key=lambda message: abs(message.time - time)))

    def table(self, topic: str = "/particles") -> np.ndarray:
        """The rows of all messages of a topic, with their `time` [s] as the first column."""
        parts = [_with_time(time, rows) for time, rows in self.frames(topic)]
        parts = [part for part in parts if part.dtype.names]
        return np.concatenate(parts) if parts else np.empty(0, dtype=[("time", "<f8")])

    def pandas(self, topic: str = "/particles") -> "Any":
        """`table` as a pandas.DataFrame."""
        import pandas

        return pandas.DataFrame(self.table(topic))

    def energy(self) -> np.ndarray:
        """The energy ledger over time [J] (scene: [output] energy = true); a column for each term."""
        return _array([json.loads(message.data) for message in self.messages("/energy")])

    def wall_forces(self, wall: str) -> np.ndarray:
        """Force, torque, power, … on a wall over time (scene: [output] wall_forces = true).

        Columns are those of docs/reference/files.md; vectors are columns of three numbers.  What the
        first message does not have is NaN.
        """
        rows, names = [], []
        for message in self.messages("/wall_forces"):
            said = json.loads(message.data)
            names = [one["name"] for one in said["walls"]]
            mine = [one for one in said["walls"] if one["name"] == wall]
            rows += [{"time": said["time"], "interval": said.get("interval", 0.0), **_flat(one)} for one in mine]
        if not rows:
            raise KeyError(f"no wall '{wall}': {', '.join(names)}")
        return _array(rows)

    def wall_spheres(self) -> np.ndarray:
        """Wall spheres at t = 0: x, y, z, radius, …; empty without."""
        if "/walls" not in self.topics:
            return np.empty(0, dtype=[(name, "<f8") for name in ("x", "y", "z", "radius")])
        return _rows(self.messages("/walls")[0])

    def surfaces(self) -> "list[Surface]":
        """Planes and meshes at t = 0; of a wall of spheres an entry without plane and mesh."""
        if "/surfaces" not in self.topics:
            return []
        return [_surface(one) for one in json.loads(self.messages("/surfaces")[0].data)]


def _rows(message: Message) -> np.ndarray:
    if message.encoding != "protobuf":
        raise TypeError(f"'{message.topic}' has no tables: it is {message.encoding}")
    return table(message.data)


def _with_time(time: float, rows: np.ndarray) -> np.ndarray:
    names = rows.dtype.names or ()
    kinds = [(name, rows.dtype[name]) for name in names if name != "time"]
    out = np.empty(len(rows), dtype=[("time", "<f8")] + kinds) if names else np.empty(0, dtype=[])
    for name, _ in kinds:
        out[name] = rows[name]
    if names:
        out["time"] = rows["time"] if "time" in names else time
    return out


def _flat(said: "dict[str, Any]") -> "dict[str, Any]":
    """Numbers, also those of inner tables, as `servo.push`; lists of numbers stay."""
    found: "dict[str, Any]" = {}
    for key, value in said.items():
        if isinstance(value, dict):
            found.update({f"{key}.{inner}": one for inner, one in _flat(value).items()})
        elif isinstance(value, (int, float)) or isinstance(value, list):
            found[key] = value
    return found


def _array(rows: "list[dict[str, Any]]") -> np.ndarray:
    """A structured array of rows; what a row does not have is NaN."""
    widths: "dict[str, int]" = {}
    for row in rows:
        for key, value in row.items():
            widths.setdefault(key, len(value) if isinstance(value, list) else 0)
    kinds = [(key, "<f8", (width,)) if width else (key, "<f8") for key, width in widths.items()]
    out = np.full(len(rows), np.nan, dtype=kinds) if not kinds else np.zeros(len(rows), dtype=kinds)
    for key, width in widths.items():
        out[key] = [row.get(key, [np.nan] * width if width else np.nan) for row in rows]
    return out


def _surface(said: "dict[str, Any]") -> Surface:
    shape = said.get("shape") or {}
    mesh, plane = shape.get("mesh"), shape.get("plane")
    return Surface(
        name=said.get("name", ""),
        vertices=np.array(mesh["vertices"], dtype=float).reshape(-1, 3) if mesh else None,
        faces=np.array(mesh["faces"], dtype=int).reshape(-1, 3) if mesh else None,
        plane=np.array([plane["point"], plane["normal"]], dtype=float) if plane else None,
        motion=said.get("motion") or {},
    )
