"""Still pictures as files for browsers, and as pixels for those without one."""

from __future__ import annotations

import io
from typing import NamedTuple

import msgspec
import numpy as np
from PIL import Image

from webviz.api.pictures import Encoded, Picture, Pixels, Readout
from webviz.data.images import ImageError, jpeg, render

LONGEST_EDGE = 16_384
"""Pixels along an edge that browsers can show."""


class File(NamedTuple):
    """A file that a browser decodes.

    Args:
        mime: such as "image/jpeg".
        data: its bytes.
    """

    mime: str
    data: bytes | memoryview


def factor_for(picture: Picture, width: int) -> int:
    """By how much a picture can be made smaller for a page that shows it this wide, in pixels."""
    if not isinstance(picture, Pixels):
        return 1
    size = picture.size
    least = -(-max(size) // LONGEST_EDGE)
    return max(1, least, size[0] // max(width, 1))


def file_of(picture: Pixels | Encoded | Readout, factor: int) -> File:
    """The file of a picture; what is encoded already is not touched."""
    if isinstance(picture, Readout):
        return File("application/json", msgspec.json.encode(picture.tree()))
    if isinstance(picture, Pixels):
        return File("image/jpeg", jpeg(picture.image, picture.tone, factor))
    return File(picture.mime, np.ascontiguousarray(picture.data).data)


def opened(picture: Pixels | Encoded) -> Image.Image:
    """A picture as Pillow's.

    Raises:
        ImageError: its file is damaged.
    """
    if isinstance(picture, Pixels):
        return render(picture.image, picture.tone)
    try:
        rgb = Image.open(io.BytesIO(picture.data.tobytes())).convert("RGB")
    except (OSError, SyntaxError, ValueError) as error:
        raise ImageError(f"The {picture.mime} is damaged: {str(error)[:80]}.") from error
    if picture.swaps_red_and_blue:
        red, green, blue = rgb.split()
        return Image.merge("RGB", (blue, green, red))
    return rgb
