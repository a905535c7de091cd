"""Writes grid maps as grid_map_msgs/GridMap, cell by cell."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

GRID_MAP = "grid_map_msgs/msg/GridMap"


def grid_map(
    layers: Mapping[str, Callable[[float, float], float]],
    shape: tuple[int, int] = (3, 4),
    resolution: float = 0.5,
    start: tuple[int, int] = (0, 0),
    center: tuple[float, float] = (0.0, 0.0),
    basic: Sequence[str] = (),
) -> dict[str, Any]:
    """A message.

    Args:
        layers: values by the x and y of a cell, by name.
        shape: rows, which are along x, and columns, along y.
        resolution: edge of a cell in metres.
        start: where the circular buffer begins.
        center: x and y of the map.
        basic: names of the basic layers.
    """
    rows, columns = shape
    matrices = []
    for value in layers.values():
        data = [0.0] * (rows * columns)
        for row in range(rows):
            for column in range(columns):
                x = center[0] + resolution * ((rows - 1) / 2 - row)
                y = center[1] + resolution * ((columns - 1) / 2 - column)
                buffered = (row + start[0]) % rows, (column + start[1]) % columns
                data[buffered[1] * rows + buffered[0]] = value(x, y)
        dim = [
            {"label": "column_index", "size": columns, "stride": rows * columns},
            {"label": "row_index", "size": rows, "stride": rows},
        ]
        matrices.append({"layout": {"dim": dim}, "data": data})
    pose = {"position": {"x": center[0], "y": center[1]}, "orientation": {"w": 1.0}}
    lengths = {"length_x": rows * resolution, "length_y": columns * resolution}
    return {
        "info": {"resolution": resolution, **lengths, "pose": pose},
        "layers": list(layers),
        "basic_layers": list(basic),
        "data": matrices,
        "outer_start_index": start[0],
        "inner_start_index": start[1],
    }
