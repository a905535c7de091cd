"""From numbers to colours, as RViz does it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from webviz import Rgb

U8 = NDArray[np.uint8]
F64 = NDArray[np.float64]

BACKGROUND = (48, 48, 48)
"""RViz's default background."""

# Red, yellow, green, cyan, blue, magenta: hue 0 to 300 degrees at full saturation and value.
_RAINBOW = np.array(
    [(255, 0, 0), (255, 255, 0), (0, 255, 0), (0, 255, 255), (0, 0, 255), (255, 0, 255)]
)


def fractions(values: ArrayLike, low: float, high: float) -> F64:
    """Where values (N,) lie between `low` (0) and `high` (1); beyond them they are 0 or 1.

    NaN counts as `low`, and so does everything if there is nothing between `low` and `high`.
    """
    values = np.asarray(values, dtype=np.float64)
    half_span = high / 2 - low / 2  # the whole might overflow
    if not half_span > 0.0:
        return np.zeros(len(values))
    values = np.clip(np.nan_to_num(values, nan=low, posinf=high, neginf=low), low, high)
    return np.clip((values / 2 - low / 2) / half_span, 0.0, 1.0)


def bounds(values: ArrayLike, least_span: float = 0.0) -> tuple[float, float]:
    """The smallest and largest finite value of (N,), at least `least_span` apart."""
    values = np.asarray(values, dtype=np.float64)
    values = values[np.isfinite(values)]
    if not len(values):
        return 0.0, least_span
    low, high = float(values.min()), float(values.max())
    return low, max(high, low + least_span)


def rainbow(where: ArrayLike) -> U8:
    """Colours (N, 3) of fractions (N,): 0 is red, then by hue to 1, which is magenta.

    The same as RViz's getRainbowColor(1 - fraction).
    """
    return ramp(where, *_RAINBOW)


def ramp(where: ArrayLike, *stops: ArrayLike) -> U8:
    """Colours (N, 3) of fractions (N,) on a straight way through evenly spaced colours."""
    where = np.asarray(where, dtype=np.float64)
    table = np.array(stops, dtype=np.float64)
    places = np.linspace(0.0, 1.0, len(table))
    channels = [np.interp(where, places, table[:, c]) for c in range(3)]
    return np.round(np.stack(channels, axis=-1)).astype(np.uint8)


def faded(colors: U8, alpha: float) -> U8:
    """What colours (..., 3) look like in front of RViz's background.

    The browser draws points, lines and arrows opaque, so this stands in for their transparency.
    """
    if alpha >= 1.0:
        return colors
    mixed = alpha * np.asarray(colors, dtype=np.float64) + (1.0 - alpha) * np.array(BACKGROUND)
    return np.round(mixed).astype(np.uint8)


def faded_color(color: Rgb, alpha: float) -> Rgb:
    """`faded` for one colour."""
    red, green, blue = faded(np.array(color, dtype=np.uint8), alpha).tolist()
    return red, green, blue
