"""Messages of one pose, and what displays tell of an item of them."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any

from webviz import Details, Display

QUARTER = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
POSE = {"position": {"x": 1.0, "y": 2.0}, "orientation": {"w": 1.0}}
POSE_TOLD = {
    "fields": {
        "Position": "1.0000, 2.0000, 0.0000 m",
        "Orientation": "x 0.0000, y 0.0000, z 0.0000, w 1.0000",
        "Roll, pitch, yaw": "0.00, 0.00, 0.00 °",
    }
}


def one_of(
    bench: Callable[..., Any],
    display: Display,
    type_name: str,
    values: Mapping[str, Any],
    key: str,
    number: int | None,
    point: Any = None,
) -> Details:
    """An item of a node of a message in the frame odom."""
    at = bench(display)
    at.transform("map", "odom", (10.0, 0.0, 0.0), QUARTER)
    at.send(type_name, values, frame="odom")
    at.turn()
    return at.pick(key, number, point)
