"""The colours contained in a point cloud."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz_displays.point_cloud2.cloud import Cloud
from webviz_displays.point_cloud2.decimation import Rows

U8 = NDArray[np.uint8]


def picked(values: NDArray[Any], rows: Rows | None) -> NDArray[Any]:
    """Return some rows of an array, or all of them."""
    return values if rows is None else values.take(rows, axis=0)


def automatic(names: list[str]) -> str:
    """Return the transformer for a cloud with these fields.

    RViz takes RGB8 or Intensity, and leaves clouds white that have neither; here they show their
    RGBF32 colours, or else their height.
    """
    if "rgb" in names or "rgba" in names:
        return "RGB8"
    if "intensity" in names or "intensities" in names:
        return "Intensity"
    return "RGBF32" if {"r", "g", "b"} <= set(names) else "AxisColor"


def packed_colors(cloud: Cloud, rows: Rows | None) -> tuple[U8, U8 | None]:
    """Colours (N, 3) of a field "rgb" or "rgba", 0xAARRGGBB in four bytes of any type.

    Returns:
        The colours and, if there is only "rgba", opacities (N,) from 0 to 255.

    Raises:
        CloudError: the field is missing or cannot be read.
    """
    has_alpha = "rgb" not in cloud.names and "rgba" in cloud.names
    numbers = picked(cloud.quads("rgba" if has_alpha else "rgb"), rows)
    quads = np.ascontiguousarray(numbers, "<u4").view(np.uint8).reshape(-1, 4)
    colors = np.empty((len(quads), 3), np.uint8)
    for channel in range(3):  # far faster than quads[:, 2::-1].copy()
        colors[:, channel] = quads[:, 2 - channel]
    return colors, quads[:, 3] if has_alpha else None


def separate_colors(cloud: Cloud, rows: Rows | None) -> U8:
    """Colours (N, 3) of fields "r", "g" and "b": floats from 0 to 1, or integers from 0 to 255.

    Raises:
        CloudError: one of them is missing or cannot be read.
    """
    channels = [picked(cloud.values(name), rows) for name in "rgb"]
    colors = np.empty((len(channels[0]), 3), np.uint8)
    for i, channel in enumerate(channels):
        scale = 255.0 if channel.dtype.kind == "f" else 1.0
        with np.errstate(invalid="ignore", over="ignore"):
            bright = np.multiply(channel, scale, dtype=np.float64)
        np.fmax(bright, 0.0, out=bright)  # fmax and fmin ignore NaN
        np.fmin(bright, 255.0, out=bright)
        colors[:, i] = np.rint(bright, out=bright)
    return colors
