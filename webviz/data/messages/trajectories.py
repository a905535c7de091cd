"""Points of joint trajectories, of which one message may hold a million."""

from __future__ import annotations

from collections.abc import Iterator
from struct import Struct as Layout

import numpy as np
from msgspec import Struct
from numpy.typing import NDArray

from webviz.data.messages.cdr import ENCAPSULATION_SIZE, CdrError, Reader
from webviz.data.messages.geometry import F64, NANOSECONDS, Duration, zeros

I64 = NDArray[np.int64]

_ARRAYS = 4
"""Number of arrays of each point: positions, velocities, accelerations, effort."""
_COUNT = {order: Layout(order + "I").unpack_from for order in "<>"}
_DURATION = {order: Layout(order + "iI").unpack_from for order in "<>"}
_Point = tuple[list[int], list[int], int]
"""Offset of its numbers in the message, their count, and its time in nanoseconds."""


class JointTrajectoryPoint(Struct, frozen=True, eq=False):
    """trajectory_msgs/msg/JointTrajectoryPoint, in rad or m, s and N m or N."""

    positions: F64 = zeros(np.float64)
    velocities: F64 = zeros(np.float64)
    accelerations: F64 = zeros(np.float64)
    effort: F64 = zeros(np.float64)
    time_from_start: Duration = Duration()


class JointTrajectoryPointSequence(Struct, frozen=True, eq=False):
    """A `JointTrajectoryPoint[]`: N points as arrays, which can also be indexed and iterated.

    Attributes:
        numbers: (M,) float64, the numbers of all points.
        starts: (N, 4) int64, where in `numbers` the positions, velocities, accelerations and
            efforts of each point start.
        lengths: (N, 4) int64, how many they are.
        times_ns: (N,) int64, nanoseconds from the start of the trajectory.
    """

    numbers: F64 = zeros(np.float64)
    starts: I64 = zeros(np.int64, 0, _ARRAYS)
    lengths: I64 = zeros(np.int64, 0, _ARRAYS)
    times_ns: I64 = zeros(np.int64)

    def __len__(self) -> int:
        return len(self.times_ns)

    def __getitem__(self, index: int) -> JointTrajectoryPoint:
        spans = zip(self.starts[index].tolist(), self.lengths[index].tolist(), strict=True)
        arrays = [self.numbers[start : start + length] for start, length in spans]
        positions, velocities, accelerations, effort = arrays
        time = Duration(*divmod(int(self.times_ns[index]), NANOSECONDS))
        return JointTrajectoryPoint(positions, velocities, accelerations, effort, time)

    def __iter__(self) -> Iterator[JointTrajectoryPoint]:
        return (self[index] for index in range(len(self)))

    def positions(self, width: int, most: int) -> tuple[I64, F64]:
        """Return the positions of the points that have a number of them.

        Args:
            width: how many positions a point must have.
            most: number of points that are looked at, from the first.

        Returns:
            (K,) numbers of points, ascending, and (K, width) their positions.
        """
        fitting = np.flatnonzero(self.lengths[:most, 0] == width)
        return fitting, self.numbers[self.starts[fitting, 0, None] + np.arange(width)]


def read_trajectory_points(reader: Reader) -> JointTrajectoryPointSequence:
    """Read a `trajectory_msgs/JointTrajectoryPoint[]`, without a loop if all have equal lengths."""
    count = reader.count()
    if count == 0:
        return JointTrajectoryPointSequence()
    begin = reader.pos
    points = [_read_one(reader)]
    alike = _read_alike(reader, count - 1) if count > 1 else None
    if alike is None:
        points += [_read_one(reader) for _ in range(count - 1)]
    starts, lengths, times = map(np.array, zip(*points, strict=True))
    if alike is not None:
        starts, lengths, times = (
            np.concatenate(pair) for pair in zip((starts, lengths, times), alike, strict=True)
        )
    return _sequence(reader, begin, starts, lengths, times)


def _read_one(reader: Reader) -> _Point:
    """Read points in a loop that inlines `Reader`, as their lengths may differ."""
    data, size, pos = reader.data, reader.size, (reader.pos + 3) & ~3
    count = _COUNT[reader.order]
    starts, lengths = [], []
    for _ in range(_ARRAYS):
        (length,) = count(data, pos)
        pos += 4
        if length:
            pos += (ENCAPSULATION_SIZE - pos) & 7
            if pos + 8 * length > size:
                reader.pos = pos
                raise CdrError(f"{length} elements of float64 are longer than the rest")
        starts.append(pos)
        lengths.append(length)
        pos += 8 * length
    sec, nanosec = _DURATION[reader.order](data, pos)
    reader.pos = pos + 8
    return starts, lengths, sec * NANOSECONDS + nanosec


def _read_alike(reader: Reader, count: int) -> tuple[I64, I64, I64] | None:
    """Read points with the lengths of the first of them; None if one differs.

    The last array that is not empty ends on a multiple of 8, so from the second point of a
    sequence on all have the same padding, and follow each other at a constant stride.
    """
    begin = reader.pos
    starts, lengths, _ = _read_one(reader)
    stride = reader.pos - begin
    if begin + count * stride > reader.size:
        reader.pos = begin
        return None
    order, data = reader.order, reader.data
    pos = begin
    for start, length in zip(starts, lengths, strict=True):
        counts = np.ndarray((count,), order + "u4", data, pos, (stride,))
        if not (counts == length).all():
            reader.pos = begin
            return None
        pos = start + 8 * length
    seconds = np.ndarray((count,), order + "i4", data, pos, (stride,))
    rest = np.ndarray((count,), order + "u4", data, pos + 4, (stride,))
    reader.pos = begin + count * stride
    return (
        np.array(starts) + np.arange(0, count * stride, stride)[:, None],
        np.broadcast_to(np.array(lengths), (count, _ARRAYS)),
        seconds.astype(np.int64) * NANOSECONDS + rest,
    )


def _sequence(
    reader: Reader, begin: int, starts: I64, lengths: I64, times: I64
) -> JointTrajectoryPointSequence:
    """Turn positions in the message into those in an array of its numbers."""
    begin += (ENCAPSULATION_SIZE - begin) & 7
    end, reader.pos = reader.pos, begin
    numbers = reader.array(np.dtype(np.float64), max(end - begin, 0) // 8)
    reader.pos = end
    # An empty array may start where no number can.
    starts = np.where(lengths > 0, (starts - begin) // 8, 0)
    return JointTrajectoryPointSequence(numbers, starts, lengths, times)
