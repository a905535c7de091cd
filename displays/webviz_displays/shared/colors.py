"""Colours of numbers, as RViz has them."""

from __future__ import annotations

import functools
import math
from collections.abc import Iterator
from typing import Annotated, Any

import msgspec
import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz import Rgb

U8 = NDArray[np.uint8]
F64 = NDArray[np.float64]

LAYERS = 8
"""Most opacities of points or texts that are drawn apart."""

RAINBOW: tuple[Rgb, ...] = (
    (255, 0, 0),
    (255, 255, 0),
    (0, 255, 0),
    (0, 255, 255),
    (0, 0, 255),
    (255, 0, 255),
)
"""Colours from red to magenta: hue 0 to 300 degrees at full saturation and value."""

Alpha = Annotated[float, msgspec.Meta(ge=0, le=1)]
"""An opacity, for a `Prop` that says of what."""

_PART = 1 << 14
"""Values per block, so that intermediate arrays stay in the cache."""


def bounds(values: ArrayLike, least_span: float = 0.0) -> tuple[float, float]:
    """Return the smallest and largest finite value of (N,), at least `least_span` apart."""
    values = np.asarray(values)
    if not len(values):
        return 0.0, least_span
    low, high = float(values.min()), float(values.max())
    if not math.isfinite(high - low):
        values = values[np.isfinite(values)].astype(np.float64)
        low, high = (float(values.min()), float(values.max())) if len(values) else (0.0, 0.0)
    return low, max(high, low + least_span)


def ramp(values: ArrayLike, low: float, high: float, stops: tuple[Rgb, ...] = RAINBOW) -> U8:
    """Colours (N, 3) of values (N,), from the first stop at `low` to the last one at `high`.

    Stops are evenly spaced. The rainbow is the same as RViz's getRainbowColor(1 - fraction). Values
    beyond the bounds have the nearest colour; NaN has the first, and so has every value if `low` is
    not below `high`.
    """
    table = _table(stops)
    values = np.asarray(values)
    colors = np.empty(len(values), table.dtype)
    half_span = high / 2 - low / 2  # the difference might overflow
    last = len(table) - 1
    number = _computed_in(values.dtype)
    with np.errstate(all="ignore"):  # overflows are clamped, and NaN becomes the smallest integer
        shift, scale = number(low / 2), number(last / half_span if half_span > 0.0 else 0.0)
        for start in range(0, len(values), _PART):
            where = np.multiply(values[start : start + _PART], number(0.5))
            where -= shift
            where *= scale
            where += number(0.5)  # to round by cutting off
            index = np.minimum(where, last, out=where).astype(np.intp)
            # A colour as one item of three bytes: numpy copies matrix rows far more slowly.
            table.take(index, mode="clip", out=colors[start : start + _PART])
    return colors.view(np.uint8).reshape(-1, 3)


@functools.lru_cache(maxsize=16)
def _computed_in(dtype: np.dtype[Any]) -> type[np.floating[Any]]:
    """Return float32 for all that it resolves, in which numpy computes twice as fast."""
    return np.result_type(dtype, np.float32).type


@functools.lru_cache(maxsize=16)
def _table(stops: tuple[Rgb, ...]) -> NDArray[np.void]:
    """Colours between the stops, close enough for 8 bits."""
    values = np.array(stops, dtype=np.float64)
    # Twice as fine as 8 bits between stops, so that midpoints are included.
    places = 510 * np.arange(len(values))
    steps = np.arange(places[-1] + 1)
    channels = [np.interp(steps, places, values[:, c]) for c in range(3)]
    table = np.round(np.stack(channels, axis=-1)).astype(np.uint8)
    return table.view("V3")[:, 0]


def layers(opacities: F64) -> Iterator[tuple[float, NDArray[np.bool_]]]:
    """Yield each opacity above 0 of values (N,), with the mask (N,) of those that have it.

    A node has one opacity, so several become several nodes: more than `LAYERS` are rounded up
    to that many steps.
    """
    levels = np.unique(opacities)
    if len(levels) > LAYERS:
        opacities = np.ceil(opacities * LAYERS) / LAYERS
        levels = np.unique(opacities)
    for level in levels[levels > 0.0].tolist():
        yield level, opacities == level
