"""Brightness of values on a screen."""

from __future__ import annotations

import functools
import math
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz.data.images.encodings import PixelLayout

U8 = NDArray[np.uint8]

_STRIP_ROWS = 256
Rgb = tuple[int, int, int]


def _stops(hexes: str) -> tuple[Rgb, ...]:
    return tuple((int(h[:2], 16), int(h[2:4], 16), int(h[4:], 16)) for h in hexes.split())


COLOR_MAPS: dict[str, tuple[Rgb, ...]] = {
    "Grey": ((0, 0, 0), (255, 255, 255)),
    # A. Mikhailov, "Turbo, an improved rainbow colormap for visualization", 2019
    "Turbo": _stops(
        "30123b 4145ab 4675ed 39a2fc 1bcfd4 24eca6 61fc6c a4fc3b d1e834 f3c63a fe9b2d f36315 "
        "d93806 b11901 7a0402"
    ),
    # N. Smith and S. van der Walt, the default of matplotlib
    "Viridis": _stops("440154 482878 3e4989 31688e 26828e 1f9e89 35b779 6ece58 b5de2b fde725"),
    # As RViz colours clouds
    "Rainbow": _stops("ff0000 ffff00 00ff00 00ffff 0000ff ff00ff"),
}
"""Colours of each map from the lowest to the highest value."""


class Tone(msgspec.Struct, frozen=True):
    """Mapping from values to colours.

    Args:
        low, high: the values of the first and the last colour.
        color_map: one of `COLOR_MAPS`.
    """

    low: float = 0.0
    high: float = 1.0
    color_map: str = "Grey"


def value_range(values: NDArray[Any], zero_is_invalid: bool) -> tuple[float, float] | None:
    """Return the smallest and the largest valid value, None if none is valid.

    Args:
        values: (H, ...).
        zero_is_invalid: whether 0 stands for no measurement.
    """
    # In strips, since this is done for each image and takes as much memory again.
    strips = (values[start : start + _STRIP_ROWS] for start in range(0, len(values), _STRIP_ROWS))
    ranges = [each for strip in strips if (each := _range(strip, zero_is_invalid))]
    return (min(low for low, _ in ranges), max(high for _, high in ranges)) if ranges else None


def _range(values: NDArray[Any], zero_is_invalid: bool) -> tuple[float, float] | None:
    if not zero_is_invalid and (values.dtype.kind != "f" or values.size):
        with np.errstate(invalid="ignore"):
            low, high = float(values.min()), float(values.max())
        if math.isfinite(low) and math.isfinite(high):
            return low, high
    valid = values[_validity(values, zero_is_invalid)]
    return (float(valid.min()), float(valid.max())) if valid.size else None


def to_rgb(values: NDArray[Any], layout: PixelLayout, tone: Tone) -> U8:
    """Pixels for a screen.

    Numbers that are measurements are scaled by the tone; invalid ones are black. Colours of 16 bits
    keep the upper 8.

    Args:
        values: as `webviz.data.images.values` returns them.
        layout: of their encoding.
        tone: for measurements.

    Returns:
        (H, W) grey or (H, W, 3) RGB.
    """
    if not layout.is_scaled:
        return values if values.dtype == np.uint8 else (values >> 8).astype(np.uint8)
    if values.ndim == 3:
        scaled = _scaled(values, tone, layout.zero_is_invalid)
        if scaled.shape[2] == 2:
            scaled = np.concatenate((scaled, np.zeros_like(scaled[..., :1])), axis=2)
        return scaled
    scaled = _scaled(values, tone, layout.zero_is_invalid)
    if tone.color_map == "Grey":
        return scaled
    colors = _table(tone.color_map).take(scaled).view(np.uint8).reshape(*scaled.shape, 3)
    if values.dtype.kind == "f" or layout.zero_is_invalid:
        colors[~_validity(values, layout.zero_is_invalid)] = 0
    return colors


def _scaled(values: NDArray[Any], tone: Tone, zero_is_invalid: bool) -> U8:
    half_span = tone.high / 2 - tone.low / 2  # the difference might overflow
    if not half_span > 0.0:
        return np.where(_validity(values, zero_is_invalid), np.uint8(127), np.uint8(0))
    kind = np.float64 if values.dtype.itemsize > 4 or values.dtype == np.int32 else np.float32
    if kind == np.float32 and max(abs(tone.low), abs(tone.high)) > 1e37:
        kind = np.float64
    with np.errstate(over="ignore", invalid="ignore"):
        where = np.divide(values, 2.0, dtype=kind)
        where -= kind(tone.low / 2)
        where *= kind(255.0 / half_span) if half_span > 1e-30 else kind(0.0)
        np.clip(where, 0.0, 255.0, out=where)
        np.nan_to_num(where, copy=False)
    scaled = where.astype(np.uint8)
    if zero_is_invalid:
        scaled[values == 0] = 0
    elif values.dtype.kind == "f":
        scaled[~np.isfinite(values)] = 0
    return scaled


def _validity(values: NDArray[Any], zero_is_invalid: bool) -> NDArray[np.bool_]:
    if values.dtype.kind == "f":
        valid = np.isfinite(values)
        return valid & (values != 0) if zero_is_invalid else valid
    return values != 0 if zero_is_invalid else np.ones(values.shape, bool)


@functools.cache
def _table(name: str) -> NDArray[np.void]:
    """256 colours of three bytes each, as one item."""
    stops = np.array(COLOR_MAPS[name], np.float64)
    at, places = np.linspace(0.0, len(stops) - 1, 256), np.arange(len(stops))
    channels = [np.interp(at, places, stops[:, channel]) for channel in range(3)]
    table = np.round(np.stack(channels, axis=-1)).astype(np.uint8)
    return np.ascontiguousarray(table).view("V3")[:, 0]
