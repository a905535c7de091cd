"""Messages in Foxglove's own schemas, as protobuf or JSON, as the equal ones of ROS."""

from __future__ import annotations

import functools
import importlib.util
import json
import math
from collections.abc import Callable
from typing import Any

import msgspec
import numpy as np

from webviz.data.foxglove.scene import header, markers_of, pose_of, time_of
from webviz.data.messages import encode
from webviz.data.rotations import matrices, w_first

MISSING = (
    "{name} needs the package foxglove-schemas-protobuf. Install it with "
    "`pip install 'ros-webviz[foxglove]'`"
)
UNKNOWN_SCHEMA = "{name} has no equal message in ROS, so no display shows it"
_DATATYPES = {1: 2, 2: 1, 3: 4, 4: 3, 5: 6, 6: 5, 7: 7, 8: 8}
"""Datatypes of sensor_msgs/msg/PointField by those of PackedElementField."""
_SIZES = {1: 1, 2: 1, 3: 2, 4: 2, 5: 4, 6: 4, 7: 4, 8: 8}
FLOAT32 = 7
MAX_JSON_DEPTH = 50


class ConversionError(ValueError):
    """A message is not of its schema, or has no equal in ROS; one sentence."""


class Conversion(msgspec.Struct, frozen=True):
    """The way from a schema to a message of ROS.

    Args:
        schema: such as foxglove.PointCloud.
        type: message type of ROS.
        values: makes the values of that message from one of the schema.
    """

    schema: str
    type: str
    values: Callable[[Any], dict[str, Any]]

    def convert(self, encoding: str, payload: bytes) -> bytes:
        """Return a message in CDR.

        Args:
            encoding: "protobuf" or "json".
            payload: a message of the schema.

        Raises:
            ConversionError: it is not one, or has no equal in ROS.
        """
        message = _message_class(self.schema)()
        try:
            if encoding == "protobuf":
                message.ParseFromString(payload)
            else:
                _parse_json(payload, message)
            return encode(self.type, self.values(message))
        except ConversionError:
            raise
        except Exception as error:  # of protobuf, numpy and the encoder: of many kinds
            raise ConversionError(f"A message is not a valid {self.schema}") from error


def is_own(schema: str, encoding: str) -> bool:
    """Return whether messages are in one of Foxglove's own schemas.

    Args:
        schema: its name.
        encoding: of the messages.
    """
    return schema.startswith("foxglove.") and encoding in ("protobuf", "json")


def conversion(schema: str) -> Conversion | None:
    """Return the conversion of a schema, None if there is none."""
    return _CONVERSIONS.get(schema)


def problem_of(schema: str, name: str) -> str:
    """Return why a schema cannot be read, "" if it can.

    Args:
        schema: its name.
        name: the same, for sentences.
    """
    if schema not in _CONVERSIONS:
        return UNKNOWN_SCHEMA.format(name=name)
    return "" if _is_installed() else MISSING.format(name=name)


@functools.cache
def _is_installed() -> bool:
    return importlib.util.find_spec("foxglove_schemas_protobuf") is not None


def _message_class(schema: str) -> Any:
    name = schema.removeprefix("foxglove.")
    module = importlib.import_module(f"foxglove_schemas_protobuf.{name}_pb2")
    return getattr(module, name)


def _parse_json(payload: bytes, message: Any) -> None:
    """Read JSON in which times are objects, as Foxglove writes them."""
    from google.protobuf import json_format

    values = _with_times(json.loads(payload), "")
    if not isinstance(values, dict):
        raise ValueError("it is not an object")
    json_format.ParseDict(
        values,
        message,
        ignore_unknown_fields=True,
        max_recursion_depth=MAX_JSON_DEPTH,
    )


def _with_times(value: Any, key: str) -> Any:
    """Replace times by the texts that protobuf reads."""
    if isinstance(value, dict):
        if "sec" in value and value.keys() <= {"sec", "nsec"}:
            return _time_text(int(value["sec"]), int(value.get("nsec", 0)), key == "lifetime")
        return {name: _with_times(each, name) for name, each in value.items()}
    return [_with_times(each, key) for each in value] if isinstance(value, list) else value


def _time_text(sec: int, nsec: int, is_duration: bool) -> str:
    from google.protobuf.timestamp_pb2 import Timestamp

    if is_duration:
        return f"{sec}.{nsec:09d}s"
    return Timestamp(seconds=sec, nanos=nsec).ToJsonString()


def _transform(message: Any) -> dict[str, Any]:
    v, q = message.translation, message.rotation
    return {
        "header": {"stamp": time_of(message.timestamp), "frame_id": message.parent_frame_id},
        "child_frame_id": message.child_frame_id,
        "transform": {
            "translation": {"x": v.x, "y": v.y, "z": v.z},
            "rotation": {"x": q.x, "y": q.y, "z": q.z, "w": q.w},
        },
    }


def _cloud(message: Any) -> dict[str, Any]:
    step, data = message.point_stride, message.data
    if step <= 0 or any(f.offset + _SIZES.get(f.type, 8) > step for f in message.fields):
        raise ConversionError("A foxglove.PointCloud has fields outside of its points")
    width = len(data) // step
    data = _placed(message, np.frombuffer(data, np.uint8, width * step).reshape(width, step))
    return {
        "header": header(message),
        "height": 1,
        "width": width,
        "fields": [
            {"name": f.name, "offset": f.offset, "datatype": _DATATYPES[f.type], "count": 1}
            for f in message.fields
            if f.type in _DATATYPES
        ],
        "point_step": step,
        "row_step": width * step,
        "data": data.reshape(-1),
        "is_dense": False,
    }


def _placed(message: Any, points: Any) -> Any:
    """Return the bytes of points at the pose of the cloud, which clouds of ROS do not have.

    Args:
        message: the cloud.
        points: uint8 (N, step).
    """
    if _is_identity(message.pose):
        return points
    at = {f.name: f for f in message.fields}
    axes = [at.get(name) for name in "xyz"]
    if any(axis is None or axis.type != FLOAT32 for axis in axes):
        raise ConversionError("A foxglove.PointCloud has a pose, but no float32 fields x, y and z")
    points = points.copy()
    parts = [points[:, f.offset : f.offset + 4] for f in axes if f is not None]
    xyz = np.hstack([np.ascontiguousarray(part).view("<f4") for part in parts]).astype(np.float64)
    q, p = message.pose.orientation, message.pose.position
    rotation = np.array((q.x, q.y, q.z, q.w)) if any((q.x, q.y, q.z, q.w)) else np.eye(4)[3]
    turned = xyz @ matrices(w_first(rotation / np.linalg.norm(rotation))).T
    moved = turned + np.array((p.x, p.y, p.z))
    for part, values in zip(parts, moved.T.astype("<f4"), strict=True):
        part[:] = np.ascontiguousarray(values).view(np.uint8).reshape(-1, 4)
    return points


def _scan(message: Any) -> dict[str, Any]:
    if not _is_identity(message.pose):
        raise ConversionError("A foxglove.LaserScan has a pose, which scans of ROS do not have")
    ranges = np.array(message.ranges, np.float32)
    span = message.end_angle - message.start_angle
    finite = ranges[np.isfinite(ranges)]
    return {
        "header": header(message),
        "angle_min": message.start_angle,
        "angle_max": message.end_angle,
        "angle_increment": span / (len(ranges) - 1) if len(ranges) > 1 else 0.0,
        "range_max": float(finite.max()) + 1.0 if finite.size else math.inf,
        "ranges": ranges,
        "intensities": np.array(message.intensities, np.float32),
    }


def _grid(message: Any) -> dict[str, Any]:
    cell, row = message.cell_stride, message.row_stride
    field = next((f for f in message.fields if f.type in (1, 2) and f.offset < cell), None)
    columns, size = message.column_count, message.cell_size
    if field is None or not math.isclose(size.x, size.y) or not 0 < columns * cell <= row:
        raise ConversionError("A foxglove.Grid has no square cells with a field of 8 bits")
    rows = len(message.data) // row
    data = np.frombuffer(message.data, np.uint8, rows * row).reshape(rows, row)
    cells = data[:, field.offset : columns * cell : cell]
    return {
        "header": header(message),
        "info": {
            "resolution": size.x,
            "width": columns,
            "height": rows,
            "origin": pose_of(message.pose),
        },
        "data": np.ascontiguousarray(cells).view(np.int8).reshape(-1),
    }


def _calibration(message: Any) -> dict[str, Any]:
    sizes = len(message.K), len(message.R), len(message.P)
    if sizes not in ((9, 9, 12), (9, 0, 12), (9, 0, 0), (9, 9, 0)):
        raise ConversionError("A foxglove.CameraCalibration has matrices of invalid sizes")
    k = list(message.K)
    return {
        "header": header(message),
        "width": message.width,
        "height": message.height,
        "distortion_model": message.distortion_model,
        "d": np.array(message.D),
        "k": k,
        "r": list(message.R) or [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        "p": list(message.P) or [*k[:3], 0.0, *k[3:6], 0.0, *k[6:], 0.0],
    }


def _image(message: Any) -> dict[str, Any]:
    fields = ("width", "height", "encoding", "step", "data")
    return {"header": header(message), **{name: getattr(message, name) for name in fields}}


def _fix(message: Any) -> dict[str, Any]:
    covariance = list(message.position_covariance)
    return {
        "header": header(message),
        "latitude": message.latitude,
        "longitude": message.longitude,
        "altitude": message.altitude,
        "position_covariance": covariance if len(covariance) == 9 else [0.0] * 9,
        "position_covariance_type": message.position_covariance_type if covariance else 0,
    }


def _log(message: Any) -> dict[str, Any]:
    return {
        "stamp": time_of(message.timestamp),
        "level": 10 * message.level,
        "name": message.name,
        "msg": message.message,
        "file": message.file,
        "line": message.line,
    }


def _is_identity(pose: Any) -> bool:
    p, q = pose.position, pose.orientation
    return not any((p.x, p.y, p.z, q.x, q.y, q.z))


_CONVERSIONS = {
    each.schema: each
    for each in (
        Conversion("foxglove.SceneUpdate", "visualization_msgs/msg/MarkerArray", markers_of),
        Conversion(
            "foxglove.FrameTransform",
            "tf2_msgs/msg/TFMessage",
            lambda m: {"transforms": [_transform(m)]},
        ),
        Conversion(
            "foxglove.FrameTransforms",
            "tf2_msgs/msg/TFMessage",
            lambda m: {"transforms": [_transform(each) for each in m.transforms]},
        ),
        Conversion("foxglove.PointCloud", "sensor_msgs/msg/PointCloud2", _cloud),
        Conversion("foxglove.LaserScan", "sensor_msgs/msg/LaserScan", _scan),
        Conversion("foxglove.Grid", "nav_msgs/msg/OccupancyGrid", _grid),
        Conversion(
            "foxglove.CompressedImage",
            "sensor_msgs/msg/CompressedImage",
            lambda m: {"header": header(m), "format": m.format, "data": m.data},
        ),
        Conversion(
            "foxglove.CompressedVideo",
            "foxglove_msgs/msg/CompressedVideo",
            lambda m: {
                "timestamp": time_of(m.timestamp),
                "frame_id": m.frame_id,
                "data": m.data,
                "format": m.format,
            },
        ),
        Conversion("foxglove.RawImage", "sensor_msgs/msg/Image", _image),
        Conversion("foxglove.CameraCalibration", "sensor_msgs/msg/CameraInfo", _calibration),
        Conversion(
            "foxglove.PoseInFrame",
            "geometry_msgs/msg/PoseStamped",
            lambda m: {"header": header(m), "pose": pose_of(m.pose)},
        ),
        Conversion(
            "foxglove.PosesInFrame",
            "geometry_msgs/msg/PoseArray",
            lambda m: {"header": header(m), "poses": [pose_of(each) for each in m.poses]},
        ),
        Conversion("foxglove.LocationFix", "sensor_msgs/msg/NavSatFix", _fix),
        Conversion("foxglove.Log", "rcl_interfaces/msg/Log", _log),
    )
}
