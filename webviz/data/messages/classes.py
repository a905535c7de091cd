"""The class of each message type: hand-written, or generated from its definition."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from webviz.data.messages import geometry, markers, trajectories, types
from webviz.data.messages.extents import attribute
from webviz.data.messages.geometry import zeros
from webviz.data.messages.typestore import (
    KNOWN,
    MessageField,
    MessageTypes,
    constants,
    fields,
    full_name,
    per_definitions,
)

DTYPES = {
    name: np.dtype(dtype)
    for name, dtype in {
        "bool": np.bool_,
        "byte": np.uint8,
        "char": np.uint8,
        "int8": np.int8,
        "uint8": np.uint8,
        "int16": np.int16,
        "uint16": np.uint16,
        "int32": np.int32,
        "uint32": np.uint32,
        "int64": np.int64,
        "uint64": np.uint64,
        "float32": np.float32,
        "float64": np.float64,
    }.items()
}
"""ROS primitive to numpy type, for all primitives of fixed size."""

CODES = {name: "?" if name == "bool" else dtype.char for name, dtype in DTYPES.items()}
CODES |= {"int64": "q", "uint64": "Q"}
"""ROS primitive to the code of `struct`; numpy's "l" and "L" have no fixed size there."""

WRITTEN: dict[str, type] = {
    f"{package}/msg/{name}": getattr(module, name)
    for module, package, names in (
        (geometry, "builtin_interfaces", "Duration Time"),
        (geometry, "std_msgs", "Header"),
        (geometry, "geometry_msgs", "Point Pose PoseArray PoseStamped PoseWithCovariance"),
        (geometry, "geometry_msgs", "PoseWithCovarianceStamped Quaternion Twist"),
        (geometry, "geometry_msgs", "TwistWithCovariance Vector3"),
        (geometry, "tf2_msgs", "TFMessage"),
        (types, "map_msgs", "OccupancyGridUpdate"),
        (types, "nav_msgs", "MapMetaData OccupancyGrid Odometry Path"),
        (types, "rosgraph_msgs", "Clock"),
        (types, "sensor_msgs", "JointState LaserScan PointCloud2 PointField"),
        (types, "std_msgs", "String"),
        (markers, "sensor_msgs", "CompressedImage"),
        (markers, "std_msgs", "ColorRGBA"),
        (trajectories, "trajectory_msgs", "JointTrajectoryPoint"),
        (markers, "visualization_msgs", "Marker MarkerArray MeshFile"),
    )
    for name in names.split()
}
"""Types with a hand-written class. Their definition is fixed."""

VECTORS = {
    "geometry_msgs/msg/Point": ("float64", 3),
    "geometry_msgs/msg/Point32": ("float32", 3),
    "geometry_msgs/msg/Vector3": ("float64", 3),
    "geometry_msgs/msg/Quaternion": ("float64", 4),
    "std_msgs/msg/ColorRGBA": ("float32", 4),
    "shape_msgs/msg/MeshTriangle": ("uint32", 3),
    "shape_msgs/msg/Plane": ("float64", 4),
    "visualization_msgs/msg/UVCoordinate": ("float32", 2),
    "nav2_msgs/msg/Particle": ("float64", 8),
    "nvblox_msgs/msg/Index3D": ("int32", 3),
    "rtabmap_msgs/msg/Point3f": ("float32", 3),
    "zed_msgs/msg/Keypoint3D": ("float32", 3),
    "zed_msgs/msg/Keypoint2Df": ("float32", 2),
    "zed_msgs/msg/Keypoint2Di": ("uint32", 2),
}
"""Messages of k equal numbers, nested ones included: a sequence of N is one (N, k) array."""

SEQUENCES: dict[str, Callable[[], Any]] = {
    "geometry_msgs/msg/Pose": geometry.PoseSequence,
    "geometry_msgs/msg/PoseStamped": geometry.PoseStampedSequence,
    "trajectory_msgs/msg/JointTrajectoryPoint": trajectories.JointTrajectoryPointSequence,
    "visualization_msgs/msg/Marker": lambda: markers.MarkerSequence.of(()),
}
"""Messages whose sequences have a class of their own."""


@per_definitions
def message_class(type_name: str, types: MessageTypes = KNOWN) -> type[Any]:
    """Return the class of a message type; its constructor takes the fields by name, as in rclpy.

    Args:
        type_name: such as "sensor_msgs/msg/LaserScan".
        types: that define it.

    Raises:
        UnknownTypeError: No definition of the type is known.
    """
    name = full_name(type_name)
    if name in WRITTEN:
        return WRITTEN[name]
    definition = [(attribute(f.name), Any, _default(f, types)) for f in fields(name, types)]
    return msgspec.defstruct(
        name.rpartition("/")[2],
        definition,
        module=__name__,
        # Names of fields and constants begin with a letter.
        namespace={**constants(name, types), "_types": types, "_type_name": name},
        frozen=True,
        eq=False,
    )


def types_of(message: object) -> MessageTypes:
    """Return the types that define the type of a message."""
    return getattr(type(message), "_types", KNOWN)


def is_message(value: object, type_name: str) -> bool:
    """Return whether a value is a message of a type, whatever defines it."""
    cls = type(value)
    return (
        cls.__module__.startswith("webviz.data.messages.")
        and cls.__name__ == type_name.rpartition("/")[2]
    )


def _default(field: MessageField, types: MessageTypes) -> Any:
    """ROS's default of a field: zero, empty, or a message of defaults."""
    if field.size is None:
        if field.is_message:
            return msgspec.field(default_factory=lambda: message_class(field.base, types)())
        return DTYPES[field.base].type(0).item() if field.base in DTYPES else ""
    if field.base in DTYPES:
        return zeros(DTYPES[field.base], field.size)
    if field.base in VECTORS:
        dtype, width = VECTORS[field.base]
        return zeros(DTYPES[dtype], field.size, width)
    if field.base in SEQUENCES and field.size == 0:
        return msgspec.field(default_factory=SEQUENCES[field.base])
    make = (lambda: message_class(field.base, types)()) if field.is_message else str
    return msgspec.field(default_factory=lambda: [make() for _ in range(field.size or 0)])
