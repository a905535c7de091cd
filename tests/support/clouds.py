"""PointCloud2 messages, packed value by value with `struct`."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

CLOUD = "sensor_msgs/msg/PointCloud2"
CODES = {1: "b", 2: "B", 3: "h", 4: "H", 5: "i", 6: "I", 7: "f", 8: "d"}
FLOAT32 = 7
UINT32 = 6

Field = tuple[str, int, int, int]
"""Name, offset, datatype, count."""
XYZ: list[Field] = [("x", 0, FLOAT32, 1), ("y", 4, FLOAT32, 1), ("z", 8, FLOAT32, 1)]


def cloud(
    fields: Sequence[Field],
    points: Sequence[Mapping[str, Sequence[Any]]],
    *,
    height: int = 1,
    point_step: int = 0,
    row_padding: int = 0,
    is_bigendian: bool = False,
    **more: Any,
) -> dict[str, Any]:
    """A cloud as nested mappings.

    Args:
        fields: where the values lie.
        points: by field name, one value for each of its elements.
        height: rows; the points are as many in each.
        point_step: bytes of a point; 0 is as many as the fields need.
        row_padding: bytes of 255 behind each row.
        is_bigendian: byte order.
        more: fields of the message that shall be otherwise.
    """
    order = ">" if is_bigendian else "<"
    ends = [offset + struct.calcsize(CODES[kind]) * count for _, offset, kind, count in fields]
    step = point_step or max(ends)
    width = len(points) // height
    data = bytearray()
    for number, point in enumerate(points):
        one = bytearray(b"\xff" * step)
        for name, offset, kind, count in fields:
            struct.pack_into(f"{order}{count}{CODES[kind]}", one, offset, *point[name])
        data += one
        if (number + 1) % width == 0:
            data += b"\xff" * row_padding
    names = ("name", "offset", "datatype", "count")
    return {
        "height": height,
        "width": width,
        "fields": [dict(zip(names, field, strict=True)) for field in fields],
        "is_bigendian": is_bigendian,
        "point_step": step,
        "row_step": width * step + row_padding,
        "data": np.frombuffer(bytes(data), np.uint8),
        "is_dense": True,
        **more,
    }


def xyz_cloud(
    points: Sequence[Sequence[float]], extra: Mapping[str, Sequence[float]] | None = None
) -> dict[str, Any]:
    """A usual cloud: x, y and z, and more channels of FLOAT32 by name."""
    extra = extra or {}
    fields = [*XYZ, *((name, 12 + 4 * i, FLOAT32, 1) for i, name in enumerate(extra))]
    rows = [
        {"x": [x], "y": [y], "z": [z], **{name: [values[i]] for name, values in extra.items()}}
        for i, (x, y, z) in enumerate(points)
    ]
    return cloud(fields, rows, point_step=12 + 4 * len(extra))
