"""Common messages as typed classes with the field names of ROS.

Messages are frozen and every field has ROS's default (zero, empty). Arrays are read-only numpy
arrays in native byte order, usually views of the received bytes.

Sequences that ROS users iterate slowly are arrays here:

- `Pose[]` is a `PoseSequence`, `PoseStamped[]` a `PoseStampedSequence`; both can be indexed and
  iterated like a list, and hold their numbers as (N, 3) positions and (N, 4) orientations;
- `trajectory_msgs/JointTrajectoryPoint[]` is a `JointTrajectoryPointSequence` of the same kind;
- `TransformStamped[]` is a list of `FrameTransform`, as a transform buffer takes;
- `Point[]`, `Point32[]` and `Vector3[]` are (N, 3), `Quaternion[]` and `ColorRGBA[]` (N, 4) arrays;
- `nav2_msgs/Particle[]` is an (N, 8) array: position, orientation, weight;
- `nvblox_msgs/Index3D[]` and `zed_msgs/Keypoint3D[]` are (N, 3).
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from msgspec import Struct, field
from numpy.typing import DTypeLike, NDArray

F64 = NDArray[np.float64]

NANOSECONDS = 1_000_000_000


def zeros(dtype: DTypeLike, *shape: int) -> Any:
    """Return a field whose default is a read-only array of zeros, (0,) if no shape is given."""

    def make() -> np.ndarray:
        array = np.zeros(shape or 0, dtype)
        array.flags.writeable = False
        return array

    return field(default_factory=make)


class Time(Struct, frozen=True):
    """builtin_interfaces/msg/Time."""

    sec: int = 0
    nanosec: int = 0

    @property
    def ns(self) -> int:
        """Nanoseconds since the epoch of the clock, exact (never through a float)."""
        return self.sec * NANOSECONDS + self.nanosec


class Duration(Struct, frozen=True):
    """builtin_interfaces/msg/Duration."""

    sec: int = 0
    nanosec: int = 0

    @property
    def ns(self) -> int:
        """Nanoseconds, exact."""
        return self.sec * NANOSECONDS + self.nanosec


class Header(Struct, frozen=True):
    """std_msgs/msg/Header."""

    stamp: Time = Time()
    frame_id: str = ""

    @property
    def stamp_ns(self) -> int:
        """The stamp in nanoseconds, exact."""
        return self.stamp.ns


class Point(Struct, frozen=True):
    """geometry_msgs/msg/Point, metres."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


class Vector3(Struct, frozen=True):
    """geometry_msgs/msg/Vector3."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0


class Quaternion(Struct, frozen=True):
    """geometry_msgs/msg/Quaternion, xyzw."""

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    w: float = 1.0


class Pose(Struct, frozen=True):
    """geometry_msgs/msg/Pose."""

    position: Point = Point()
    orientation: Quaternion = Quaternion()


class Twist(Struct, frozen=True):
    """geometry_msgs/msg/Twist, m/s and rad/s."""

    linear: Vector3 = Vector3()
    angular: Vector3 = Vector3()


class PoseWithCovariance(Struct, frozen=True, eq=False):
    """geometry_msgs/msg/PoseWithCovariance; row-major 6x6 in x, y, z, rotation about x, y, z."""

    pose: Pose = Pose()
    covariance: F64 = zeros(np.float64, 36)


class TwistWithCovariance(Struct, frozen=True, eq=False):
    """geometry_msgs/msg/TwistWithCovariance; row-major 6x6."""

    twist: Twist = Twist()
    covariance: F64 = zeros(np.float64, 36)


class PoseStamped(Struct, frozen=True):
    """geometry_msgs/msg/PoseStamped."""

    header: Header = Header()
    pose: Pose = Pose()


class PoseWithCovarianceStamped(Struct, frozen=True, eq=False):
    """geometry_msgs/msg/PoseWithCovarianceStamped."""

    header: Header = Header()
    pose: PoseWithCovariance = field(default_factory=PoseWithCovariance)


class PoseSequence(Struct, frozen=True, eq=False):
    """A `Pose[]`: N poses as arrays, which can also be indexed and iterated.

    Attributes:
        positions: (N, 3) float64, metres.
        orientations: (N, 4) float64, xyzw, as sent (not normalised).
    """

    positions: F64 = zeros(np.float64, 0, 3)
    orientations: F64 = zeros(np.float64, 0, 4)

    def __len__(self) -> int:
        return len(self.positions)

    def __getitem__(self, index: int) -> Pose:
        return Pose(
            Point(*self.positions[index].tolist()), Quaternion(*self.orientations[index].tolist())
        )

    def __iter__(self) -> Iterator[Pose]:
        return (self[index] for index in range(len(self)))


class PoseStampedSequence(Struct, frozen=True, eq=False):
    """A `PoseStamped[]`: N poses as arrays, which can also be indexed and iterated.

    Attributes:
        positions: (N, 3) float64, metres.
        orientations: (N, 4) float64, xyzw, as sent (not normalised).
        stamps_ns: (N,) int64, nanoseconds.
        frame_ids: N names of frames.
    """

    positions: F64 = zeros(np.float64, 0, 3)
    orientations: F64 = zeros(np.float64, 0, 4)
    stamps_ns: NDArray[np.int64] = zeros(np.int64)
    frame_ids: list[str] = field(default_factory=list)

    def __len__(self) -> int:
        return len(self.positions)

    def __getitem__(self, index: int) -> PoseStamped:
        stamp = Time(*divmod(int(self.stamps_ns[index]), NANOSECONDS))
        pose = PoseSequence(self.positions, self.orientations)[index]
        return PoseStamped(Header(stamp, self.frame_ids[index]), pose)

    def __iter__(self) -> Iterator[PoseStamped]:
        return (self[index] for index in range(len(self)))


class PoseArray(Struct, frozen=True, eq=False):
    """geometry_msgs/msg/PoseArray."""

    header: Header = Header()
    poses: PoseSequence = field(default_factory=PoseSequence)


class FrameTransform(NamedTuple):
    """A geometry_msgs/msg/TransformStamped of a sequence, flat: the pose of `child` in `parent`."""

    parent: str
    child: str
    stamp_ns: int
    translation: tuple[float, float, float]
    """Metres."""
    rotation: tuple[float, float, float, float]
    """xyzw, as sent (not normalised)."""


class TFMessage(Struct, frozen=True):
    """tf2_msgs/msg/TFMessage."""

    transforms: list[FrameTransform] = field(default_factory=list)
