"""Messages of MCAP files: tables (foxglove.PointCloud) and JSON."""

from __future__ import annotations

import os
from typing import Iterator, NamedTuple, Union

import numpy as np
from mcap.exceptions import McapError
from mcap.stream_reader import StreamReader

Name = Union[str, "os.PathLike[str]"]

# foxglove.PackedElementField.NumericType, from 1
_KINDS = ("<u1", "<i1", "<u2", "<i2", "<u4", "<i4", "<f4", "<f8")
# Wire types of Protocol Buffers
_VARINT, _FIXED64, _BYTES, _FIXED32 = 0, 1, 2, 5
# Numbers of fields of foxglove.PointCloud and foxglove.PackedElementField
_STRIDE, _FIELDS, _DATA = 4, 5, 6
_NAME, _OFFSET, _TYPE = 1, 2, 3


class IncompleteError(ValueError):
    """A file ends before it says that it is complete."""


class Message(NamedTuple):
    """One message of a topic."""

    topic: str
    time: float  #: [s]
    encoding: str
    data: bytes


class Contents:
    """What a file holds: its messages in the order of the file, and its metadata records."""

    def __init__(self, name: Name, topics: "set[str] | None" = None) -> None:
        self.name = os.fspath(name)
        self.metadata: "dict[str, dict[str, str]]" = {}
        self.messages: "list[Message]" = []
        self.topics: "dict[str, int]" = {}
        self._read(topics)

    @property
    def is_complete(self) -> bool:
        """Whether the file says that its writer came to its end."""
        return "end_of_stream" in self.metadata

    def _read(self, topics: "set[str] | None") -> None:
        channels: dict = {}
        with open(self.name, "rb") as file:
            try:
                for record in StreamReader(file, record_size_limit=None).records:
                    kind = type(record).__name__
                    if kind == "Channel":
                        channels[record.id] = record
                        self.topics.setdefault(record.topic, 0)
                    elif kind == "Metadata":
                        self.metadata[record.name] = dict(record.metadata)
                    elif kind == "Message":
                        self._keep(channels[record.channel_id], record, topics)
            except McapError as error:
                # A run that was killed has no end, and a message may be cut off: what is before it counts.
                if not channels:
                    raise ValueError(f"{self.name}: not a run (MCAP): {error or 'it is cut off'}") from error

    def _keep(self, channel, record, topics: "set[str] | None") -> None:
        self.topics[channel.topic] += 1
        if topics is None or channel.topic in topics:
            time = record.log_time / 1e9
            self.messages.append(Message(channel.topic, time, channel.message_encoding, record.data))


def table(data: bytes) -> np.ndarray:
    """The rows of a foxglove.PointCloud: a structured array with a field for each column."""
    stride, rows, columns = 0, b"", []
    for number, value in _fields(data):
        if number == _STRIDE:
            stride = value
        elif number == _FIELDS:
            columns.append(_column(value))
        elif number == _DATA:
            rows = value
    if not columns:
        return np.empty(0, dtype=[])
    names, offsets, kinds = zip(*columns)
    layout = np.dtype({"names": names, "formats": kinds, "offsets": offsets, "itemsize": stride})
    return np.frombuffer(rows, layout)


def _column(data: bytes) -> "tuple[str, int, str]":
    name, offset, kind = "", 0, 0
    for number, value in _fields(data):
        if number == _NAME:
            name = value.decode()
        elif number == _OFFSET:
            offset = value
        elif number == _TYPE:
            kind = value
    if not 1 <= kind <= len(_KINDS):
        raise ValueError(f"column '{name}' has numbers of the unknown type {kind}")
    return name, offset, _KINDS[kind - 1]


def _fields(data: bytes) -> "Iterator[tuple[int, int | bytes]]":
    """Numbers and values of the fields of a message of Protocol Buffers."""
    at, end = 0, len(data)
    while at < end:
        tag, at = _varint(data, at)
        number, wire = tag >> 3, tag & 7
        if wire == _VARINT:
            value, at = _varint(data, at)
        elif wire == _BYTES:
            length, at = _varint(data, at)
            value, at = data[at : at + length], at + length
        elif wire in (_FIXED32, _FIXED64):
            length = 4 if wire == _FIXED32 else 8
            value, at = int.from_bytes(data[at : at + length], "little"), at + length
        else:
            raise ValueError(f"a message with the unknown wire type {wire}")
        if at > end:
            raise ValueError("a message that is cut off")
        yield number, value


def _varint(data: bytes, at: int) -> "tuple[int, int]":
    value, shift = 0, 0
    while True:
        if at >= len(data) or shift > 63:
            raise ValueError("a message that is cut off")
        byte = data[at]
        value |= (byte & 127) << shift
        at, shift = at + 1, shift + 7
        if byte < 128:
            return value, at
