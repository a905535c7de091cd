"""Pictures compared as a person would compare them, and their files."""

from __future__ import annotations

import io
import tempfile
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import PIL.Image
import PIL.ImageFilter
from numpy.typing import NDArray

from webviz.shell.pictures.browser import Pixels

COLORS = 256
"""Of a stored picture: few enough for some kilobytes, and no person sees the difference."""
NOTICEABLE = 12
"""Steps of 255 by which a blurred pixel must differ to count."""
CLEAR = 36
"""Steps by which it counts as `CLEAR_WEIGHT` pixels: edges that another version of a browser draws
differ by less, and a small thing that is missing by more."""
CLEAR_WEIGHT = 3
TOLERANCE = 0.001
"""Share of pixels that may differ."""
GREY = 128
"""What is masked in a stored picture."""

PixelBox = tuple[int, int, int, int]
"""Left, top, right and bottom in pixels; right and bottom are the first outside."""


def share_of_difference(actual: Pixels, reference: Pixels) -> float:
    """The share of pixels that a person would see differ, those that do so clearly counted thrice.

    Args:
        actual: uint8 (height, width, 3).
        reference: of the same size; may be of few colours.
    """
    steps = _steps(actual, reference)
    return float((steps > NOTICEABLE).mean() + (CLEAR_WEIGHT - 1) * (steps > CLEAR).mean())


def difference_image(actual: Pixels, reference: Pixels) -> Pixels:
    """The actual picture, darkened, with red where the reference differs."""
    marked = actual // 3
    marked[_steps(actual, reference) > NOTICEABLE] = (255, 0, 0)
    return marked


def _steps(actual: Pixels, reference: Pixels) -> NDArray[np.int16]:
    """By how much each pixel differs once both pictures are blurred.

    What differs only because the reference has few colours does not.
    """
    stored = np.asarray(_of_few_colors(actual).convert("RGB"))
    return np.minimum(_difference(actual, reference), _difference(stored, reference))


def _difference(one: Pixels, other: Pixels) -> NDArray[np.int16]:
    a, b = (
        np.asarray(PIL.Image.fromarray(p).filter(PIL.ImageFilter.BoxBlur(1)), np.int16)
        for p in (one, other)
    )
    return np.abs(a - b).max(axis=2)


def _of_few_colors(pixels: Pixels) -> PIL.Image.Image:
    palette = PIL.Image.Quantize.FASTOCTREE  # of all the truest to rainbows
    return PIL.Image.fromarray(pixels).quantize(COLORS, palette, dither=PIL.Image.Dither.NONE)


def masked(pixels: Pixels, boxes: Iterable[PixelBox]) -> Pixels:
    """A picture with grey instead of what does not matter."""
    result = pixels.copy()
    for left, top, right, bottom in boxes:
        result[max(top, 0) : max(bottom, 0), max(left, 0) : max(right, 0)] = GREY
    return result


def load(path: Path) -> Pixels:
    """A picture from a file: uint8 (height, width, 3)."""
    with PIL.Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def store(pixels: Pixels, path: Path, few_colors: bool = False) -> None:
    """Write a PNG file in one step: after a failure the old file is still there.

    Args:
        pixels: uint8 (height, width, 3).
        path: folders that are not there are made.
        few_colors: a fraction of the bytes, for what is kept.
    """
    image = _of_few_colors(pixels) if few_colors else PIL.Image.fromarray(pixels)
    buffer = io.BytesIO()
    image.save(buffer, "PNG", optimize=few_colors)
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.NamedTemporaryFile(dir=path.parent, prefix=path.name, delete=False) as file:
        temporary = Path(file.name)
        try:
            file.write(buffer.getvalue())
            file.close()
            temporary.chmod(0o644)  # not for its writer alone, as temporary files are
            temporary.replace(path)
        except BaseException:
            temporary.unlink(missing_ok=True)
            raise
