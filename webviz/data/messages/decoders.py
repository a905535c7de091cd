"""A decoder for any message type, built once from its definition.

Neighbouring fields of fixed size, nested messages included, are read by a single `struct` call;
numeric arrays become views. Their padding depends on the position of the first one only
modulo 8, so a run of fixed fields has at most eight layouts.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import groupby, islice
from struct import Struct
from typing import Any

import numpy as np

from webviz.data.messages.cdr import ENCAPSULATION_SIZE, CdrError, Reader
from webviz.data.messages.classes import CODES, DTYPES, VECTORS, message_class
from webviz.data.messages.geometry import (
    NANOSECONDS,
    FrameTransform,
    PoseSequence,
    PoseStampedSequence,
)
from webviz.data.messages.marker_reader import read_markers
from webviz.data.messages.trajectories import read_trajectory_points
from webviz.data.messages.typestore import (
    MessageField,
    MessageTypes,
    fields,
    full_name,
    per_definitions,
    weight,
)

_FLOAT64 = np.dtype(np.float64)
_POSE_SIZE = 7 * 8
_STAMPED_HEAD = 12
"""Bytes of a header before the characters of its frame_id: sec, nanosec, length."""

_HEAD = {order: Struct(order + "iII").unpack_from for order in "<>"}
_LENGTH = {order: Struct(order + "I").unpack_from for order in "<>"}
_SEVEN = {order: Struct(order + "7d").unpack_from for order in "<>"}


def read_transforms(reader: Reader) -> list[FrameTransform]:
    """Read a `geometry_msgs/TransformStamped[]`.

    /tf is the busiest topic of most robots, so this loop inlines `Reader`, which saves a
    third of the time (49 instead of 71 us for 50 transforms).
    """
    count = reader.count()
    data, size, pos = reader.data, reader.size, reader.pos
    head, length, seven = _HEAD[reader.order], _LENGTH[reader.order], _SEVEN[reader.order]
    make = tuple.__new__
    transforms = []
    for _ in range(count):
        reader.pos = pos  # behind a count or a pose, and so aligned
        sec, nanosec, parent_length = head(data, pos)
        start = pos + 12
        end = start + parent_length
        pos = (end + 3) & ~3
        (child_length,) = length(data, pos)
        child_start = pos + 4
        child_end = child_start + child_length
        pos = child_end + (4 - child_end & 7)
        if pos + _POSE_SIZE > size:
            raise CdrError("a transform is longer than the rest of the message")
        if (
            data[end - 1] or data[child_end - 1]
        ):  # for length 0 this is the last byte of the length itself: 0
            raise CdrError("a frame id does not end in NUL")
        x, y, z, qx, qy, qz, qw = seven(data, pos)
        pos += _POSE_SIZE
        transforms.append(
            make(
                FrameTransform,
                (
                    str(data[start : end - 1], "utf-8", "replace"),
                    str(data[child_start : child_end - 1], "utf-8", "replace"),
                    sec * NANOSECONDS + nanosec,
                    (x, y, z),
                    (qx, qy, qz, qw),
                ),
            )
        )
    reader.pos = pos
    return transforms


def read_poses(reader: Reader) -> PoseSequence:
    """Read a `geometry_msgs/Pose[]` as one array."""
    numbers = reader.array(_FLOAT64, 7 * reader.count()).reshape(-1, 7)
    return PoseSequence(numbers[:, :3], numbers[:, 3:])


def read_stamped_poses(reader: Reader) -> PoseStampedSequence:
    """Read a `geometry_msgs/PoseStamped[]`, without a loop if all frame ids are equal."""
    count = reader.count()
    behind_count = reader.pos
    if count == 0:
        return PoseStampedSequence()
    if count > 1:
        evenly_spaced = _read_evenly_spaced(reader, count)
        if evenly_spaced is not None:
            return evenly_spaced
    reader.pos = behind_count
    return _read_one_by_one(reader, count)


def _read_evenly_spaced(reader: Reader, count: int) -> PoseStampedSequence | None:
    """Read poses whose frame ids equal the first; None if one differs.

    A pose ends on a multiple of 8, so from the second on all have the same padding: their headers
    and numbers follow the first at a constant stride.
    """
    dtype = np.dtype(reader.order + "u4")
    stamp = reader.stamp()
    frame_id_start = reader.pos + 4
    frame_id = reader.string()
    frame_id_length = reader.pos - frame_id_start
    reader.align(8)
    first = reader.pos
    stride = (_STAMPED_HEAD + frame_id_length + 7) // 8 * 8 + _POSE_SIZE
    end = first + _POSE_SIZE + (count - 1) * stride
    if end > reader.size:
        return None
    data = reader.data
    behind = first + _POSE_SIZE
    heads = np.ndarray((count - 1, 3), dtype, data, behind, (stride, 4))
    names = np.ndarray(
        (count - 1, frame_id_length), np.uint8, data, behind + _STAMPED_HEAD, (stride, 1)
    )
    name = np.frombuffer(data, np.uint8, frame_id_length, frame_id_start)
    if not ((heads[:, 2] == frame_id_length).all() and (names == name).all()):
        return None
    stamps = np.empty(count, np.int64)
    stamps[0] = stamp
    stamps[1:] = heads[:, 0].view(reader.order + "i4").astype(np.int64) * NANOSECONDS + heads[:, 1]
    numbers = np.ndarray((count, 7), reader.order + "f8", data, first, (stride, 8))
    reader.pos = end
    return _sequence(numbers, stamps, [frame_id] * count)


def _read_one_by_one(reader: Reader, count: int) -> PoseStampedSequence:
    seven = _SEVEN[reader.order]
    stamps, frame_ids, numbers = [], [], []
    for _ in range(count):
        stamps.append(reader.stamp())
        frame_ids.append(reader.string())
        reader.align(8)
        numbers.append(seven(reader.data, reader.pos))
        reader.pos += _POSE_SIZE
    return _sequence(np.array(numbers), np.array(stamps, np.int64), frame_ids)


def _sequence(numbers: np.ndarray, stamps: np.ndarray, frame_ids: list[str]) -> PoseStampedSequence:
    numbers = numbers.astype(_FLOAT64, copy=False)  # no copy unless the byte order is foreign
    numbers.flags.writeable = stamps.flags.writeable = False
    return PoseStampedSequence(numbers[:, :3], numbers[:, 3:], stamps, frame_ids)


SEQUENCE_READERS: dict[str, Callable[[Reader], object]] = {
    "geometry_msgs/msg/TransformStamped": read_transforms,
    "geometry_msgs/msg/Pose": read_poses,
    "geometry_msgs/msg/PoseStamped": read_stamped_poses,
    "trajectory_msgs/msg/JointTrajectoryPoint": read_trajectory_points,
    "visualization_msgs/msg/Marker": read_markers,
}
"""Sequence readers by the type of their elements."""


Step = Callable[[Reader, list[Any]], None]
"""Reads one or several fields and appends them."""
Read = Callable[[Reader], Any]
Build = Callable[[Iterator[Any]], Any]
"""Consumes the numbers of one field from an iterator."""


@per_definitions
def decoder(type_name: str, order: str, types: MessageTypes) -> Read:
    """Return the function that reads a message of this type from a `Reader` of this byte order.

    Raises:
        UnknownTypeError: No definition of the type, or of one it holds, is known.
    """
    make = message_class(type_name, types)
    steps: list[Step] = []
    own = fields(type_name, types)
    for fixed, group in groupby(own, lambda field: _codes(field, types) is not None):
        run = list(group)
        if fixed:
            steps.append(_run(run, order, types))
        else:
            steps += [_step(field, order, types) for field in run]

    def read(reader: Reader) -> Any:
        values: list[Any] = []
        for step in steps:
            step(reader, values)
        return make(*values)

    return read


def _codes(field: MessageField, types: MessageTypes) -> str | None:
    """Return the `struct` codes of a field of fixed size, else None."""
    if field.size is not None:
        return None
    if not field.is_message:
        return CODES.get(field.base)
    inner = [_codes(f, types) for f in fields(field.base, types)]
    return None if None in inner else "".join(filter(None, inner))


def _run(run: list[MessageField], order: str, types: MessageTypes) -> Step:
    """Read neighbouring fields of fixed size at once."""
    codes = "".join(_codes(field, types) or "" for field in run)
    layouts = [_layout(codes, order, start) for start in range(8)]
    builds = [_build(field, types) for field in run]
    nested = any(field.is_message for field in run)

    def step(reader: Reader, values: list[Any]) -> None:
        layout = layouts[reader.pos & 7]
        numbers = layout.unpack_from(reader.data, reader.pos)
        reader.pos += layout.size
        if nested:
            rest = iter(numbers)
            values.extend([build(rest) for build in builds])
        else:
            values.extend(numbers)

    return step


def _layout(codes: str, order: str, start: int) -> Struct:
    """Codes with their padding if the first byte is at `start` modulo 8."""
    padded = ""
    pos = start - ENCAPSULATION_SIZE
    for code in codes:
        size = Struct(order + code).size
        padded += "x" * (-pos % size) + code
        pos += -pos % size + size
    return Struct(order + padded)


def _build(field: MessageField, types: MessageTypes) -> Build:
    if not field.is_message:
        return next
    make = message_class(field.base, types)
    inner = fields(field.base, types)
    if not any(f.is_message for f in inner):
        count = len(inner)
        return lambda numbers: make(*islice(numbers, count))
    builds = [_build(f, types) for f in inner]
    return lambda numbers: make(*[build(numbers) for build in builds])


def _step(field: MessageField, order: str, types: MessageTypes) -> Step:
    """Read one field of varying size, or an array."""
    read = _reader_of(field, order, types)
    return lambda reader, values: values.append(read(reader))


def _reader_of(field: MessageField, order: str, types: MessageTypes) -> Read:
    base, size = field.base, field.size
    if size == 0 and base in SEQUENCE_READERS:
        return SEQUENCE_READERS[base]
    if size is not None and base in DTYPES:
        return _array_of(base, 1, size)
    if size is not None and base in VECTORS:
        return _array_of(*VECTORS[base], size)
    one = _reader_of_one(field, order, types)
    if size is None:
        return one
    each = weight(base, types) if field.is_message else 1
    return lambda reader: [one(reader) for _ in range(reader.elements(size, each))]


def _array_of(base: str, width: int, size: int) -> Read:
    """Return an array of numbers, (N,) or (N, width); a sequence if `size` is 0."""
    dtype = DTYPES[base]

    def read(reader: Reader) -> Any:
        numbers = reader.array(dtype, width * (size or reader.count()))
        return numbers if width == 1 else numbers.reshape(-1, width)

    return read


def _reader_of_one(field: MessageField, order: str, types: MessageTypes) -> Read:
    if field.is_message:
        return decoder(full_name(field.base), order, types)
    if field.base == "string":
        return Reader.string
    if field.base == "wstring":
        return Reader.wstring

    def refuse(reader: Reader) -> Any:
        raise CdrError(f"fields of type {field.base}, such as {field.name}, are not supported")

    return refuse
