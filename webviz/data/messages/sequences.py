"""Decoders of the sequences that dominate a robot's traffic: transforms and poses.

Those of markers and trajectories have modules of their own.
"""

from __future__ import annotations

from collections.abc import Callable
from struct import Struct

import numpy as np

from webviz.data.messages.cdr import CdrError, Reader
from webviz.data.messages.geometry import (
    NANOSECONDS,
    FrameTransform,
    PoseSequence,
    PoseStampedSequence,
)
from webviz.data.messages.marker_reader import read_markers
from webviz.data.messages.trajectories import read_trajectory_points

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
"""By the type of their elements."""
