"""Typed classes of messages about robots: maps, sensors, motion. See `geometry` for their parts."""

from __future__ import annotations

from typing import ClassVar

import numpy as np
from msgspec import Struct, field
from numpy.typing import NDArray

from webviz.data.messages.geometry import (
    F64,
    Header,
    Pose,
    PoseStampedSequence,
    PoseWithCovariance,
    Time,
    TwistWithCovariance,
    zeros,
)

F32 = NDArray[np.float32]


class Path(Struct, frozen=True, eq=False):
    """nav_msgs/msg/Path."""

    header: Header = Header()
    poses: PoseStampedSequence = field(default_factory=PoseStampedSequence)


class Odometry(Struct, frozen=True, eq=False):
    """nav_msgs/msg/Odometry: pose in `header.frame_id`, twist in `child_frame_id`."""

    header: Header = Header()
    child_frame_id: str = ""
    pose: PoseWithCovariance = field(default_factory=PoseWithCovariance)
    twist: TwistWithCovariance = field(default_factory=TwistWithCovariance)


class MapMetaData(Struct, frozen=True):
    """nav_msgs/msg/MapMetaData; resolution in metres per cell, origin of cell (0, 0)."""

    map_load_time: Time = Time()
    resolution: float = 0.0
    width: int = 0
    height: int = 0
    origin: Pose = Pose()


class OccupancyGrid(Struct, frozen=True, eq=False):
    """nav_msgs/msg/OccupancyGrid; `data` is row-major from the origin, -1 unknown, else 0..100."""

    header: Header = Header()
    info: MapMetaData = MapMetaData()
    data: NDArray[np.int8] = zeros(np.int8)


class OccupancyGridUpdate(Struct, frozen=True, eq=False):
    """map_msgs/msg/OccupancyGridUpdate: a rectangle of cells that replaces part of a map."""

    header: Header = Header()
    x: int = 0
    y: int = 0
    width: int = 0
    height: int = 0
    data: NDArray[np.int8] = zeros(np.int8)


class LaserScan(Struct, frozen=True, eq=False):
    """sensor_msgs/msg/LaserScan; radians, metres, seconds."""

    header: Header = Header()
    angle_min: float = 0.0
    angle_max: float = 0.0
    angle_increment: float = 0.0
    time_increment: float = 0.0
    scan_time: float = 0.0
    range_min: float = 0.0
    range_max: float = 0.0
    ranges: F32 = zeros(np.float32)
    intensities: F32 = zeros(np.float32)


class PointField(Struct, frozen=True):
    """sensor_msgs/msg/PointField: the place of a channel in each point of a cloud."""

    INT8: ClassVar[int] = 1
    UINT8: ClassVar[int] = 2
    INT16: ClassVar[int] = 3
    UINT16: ClassVar[int] = 4
    INT32: ClassVar[int] = 5
    UINT32: ClassVar[int] = 6
    FLOAT32: ClassVar[int] = 7
    FLOAT64: ClassVar[int] = 8

    name: str = ""
    offset: int = 0
    datatype: int = 0
    count: int = 0


class PointCloud2(Struct, frozen=True, eq=False):
    """sensor_msgs/msg/PointCloud2."""

    header: Header = Header()
    height: int = 0
    width: int = 0
    fields: list[PointField] = field(default_factory=list)
    is_bigendian: bool = False
    point_step: int = 0
    row_step: int = 0
    data: NDArray[np.uint8] = zeros(np.uint8)
    is_dense: bool = False


class JointState(Struct, frozen=True, eq=False):
    """sensor_msgs/msg/JointState; rad or m, rad/s or m/s, Nm or N."""

    header: Header = Header()
    name: list[str] = field(default_factory=list)
    position: F64 = zeros(np.float64)
    velocity: F64 = zeros(np.float64)
    effort: F64 = zeros(np.float64)


class String(Struct, frozen=True):
    """std_msgs/msg/String."""

    data: str = ""


class Clock(Struct, frozen=True):
    """rosgraph_msgs/msg/Clock."""

    clock: Time = Time()
