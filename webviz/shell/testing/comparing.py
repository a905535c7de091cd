"""Comparison of pictures as a person would make it, and their files."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import numpy as np
import PIL.Image
import PIL.ImageFilter
from numpy.typing import NDArray

from webviz.shell.pictures.browser import Pixels
from webviz.shell.pictures.files import writing

COLORS = 256
"""Colours of a stored picture, which keep it small without a visible difference."""
NOTICEABLE = 12
"""Difference of 255 above which a blurred pixel counts."""
CLEAR = 36
"""Difference above which it counts as `CLEAR_WEIGHT` pixels: more than that of edges in another
version of a browser, and less than that of a small missing object."""
CLEAR_WEIGHT = 3
TOLERANCE = 0.001
"""Share of pixels that may differ."""
GREY = 128
"""Value of masked pixels."""

PixelBox = tuple[int, int, int, int]
"""Left, top, right and bottom in pixels; right and bottom are exclusive."""


def share_of_difference(actual: Pixels, reference: Pixels) -> float:
    """Return the share of visibly different pixels, in which clear differences count thrice.

    Args:
        actual: uint8 (height, width, 3).
        reference: of the same size; may have few colours.
    """
    steps = _steps(actual, reference)
    return float((steps > NOTICEABLE).mean() + (CLEAR_WEIGHT - 1) * (steps > CLEAR).mean())


def difference_image(actual: Pixels, reference: Pixels) -> Pixels:
    """Return the actual picture, darkened, with differences in red."""
    marked = actual // 3
    marked[_steps(actual, reference) > NOTICEABLE] = (255, 0, 0)
    return marked


def _steps(actual: Pixels, reference: Pixels) -> NDArray[np.int16]:
    """Return the blurred difference of each pixel, ignoring the few colours of the reference."""
    stored = np.asarray(_of_few_colors(actual).convert("RGB"))
    expected = _blurred(reference)
    steps = (np.abs(_blurred(each) - expected) for each in (actual, stored))
    return np.minimum(*map(_largest, steps))


def _blurred(pixels: Pixels) -> NDArray[np.int16]:
    blur = PIL.ImageFilter.BoxBlur(1)
    return np.asarray(PIL.Image.fromarray(pixels).filter(blur), np.int16)


def _largest(steps: NDArray[np.int16]) -> NDArray[np.int16]:
    """Return the largest of three; `max` along so short an axis takes twenty times as long."""
    red, green, blue = np.moveaxis(steps, 2, 0)
    return np.maximum(np.maximum(red, green), blue)


def _of_few_colors(pixels: Pixels) -> PIL.Image.Image:
    palette = PIL.Image.Quantize.FASTOCTREE  # the most accurate one for rainbows
    return PIL.Image.fromarray(pixels).quantize(COLORS, palette, dither=PIL.Image.Dither.NONE)


def masked(pixels: Pixels, boxes: Iterable[PixelBox]) -> Pixels:
    """Return a picture with the boxes filled in grey."""
    result = pixels.copy()
    for left, top, right, bottom in boxes:
        result[max(top, 0) : max(bottom, 0), max(left, 0) : max(right, 0)] = GREY
    return result


def load(path: Path) -> Pixels:
    """Read a picture: uint8 (height, width, 3)."""
    with PIL.Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def store(pixels: Pixels, path: Path, few_colors: bool = False) -> None:
    """Write a PNG file atomically.

    Args:
        pixels: uint8 (height, width, 3).
        path: missing folders are created.
        few_colors: reduce the colours, for files that are kept.
    """
    image = _of_few_colors(pixels) if few_colors else PIL.Image.fromarray(pixels)
    path.parent.mkdir(parents=True, exist_ok=True)
    with writing(path) as file:
        image.save(file, "PNG", optimize=few_colors)
