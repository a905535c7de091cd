"""Encoding of images for browsers."""

from __future__ import annotations

import io
from typing import NamedTuple

import msgspec
import numpy as np
from PIL import Image

from webviz.api.decoded import PIXEL_BYTES
from webviz.api.pictures import Encoded, Picture, Pixels, Readout
from webviz.data.images import decoding, jpeg, open_compressed

LONGEST_EDGE = 16_384
"""Pixels along an edge that browsers can show."""
QUALITY = 75
"""Quality of pictures that are encoded once more."""


class File(NamedTuple):
    """A file that a browser decodes.

    Args:
        mime: such as "image/jpeg".
        data: its bytes.
    """

    mime: str
    data: bytes | memoryview


def factor_for(picture: Picture, width: int) -> int:
    """Return by how much a picture may shrink for a page that shows it this wide, in pixels."""
    if not isinstance(picture, Pixels):
        return 1
    size = picture.size
    least = -(-max(size) // LONGEST_EDGE)
    return max(1, least, size[0] // max(width, 1))


def file_of(picture: Pixels | Encoded | Readout, factor: int) -> File:
    """Return the file of a picture, smaller by a factor; what is encoded is not touched with 1."""
    if isinstance(picture, Readout):
        return File("application/json", msgspec.json.encode(picture.tree()))
    if isinstance(picture, Pixels):
        return File("image/jpeg", jpeg(picture.image, picture.tone, factor))
    return _smaller(picture, factor)


def _smaller(picture: Encoded, factor: int) -> File:
    """Return a file as JPEG with 1 / `factor` of its edges.

    As it is with 1, or if it is damaged.
    """
    file = File(picture.mime, np.ascontiguousarray(picture.data).data)
    if factor == 1:
        return file
    buffer = io.BytesIO()
    try:
        with open_compressed(picture.data) as image:
            size = max(1, image.width // factor), max(1, image.height // factor)
            image.draft("RGB", size)  # decodes fewer pixels of a JPEG
            with decoding(*image.size, PIXEL_BYTES):
                smaller = image.convert("RGB").resize(size, Image.Resampling.BOX)
        smaller.save(buffer, "JPEG", quality=QUALITY)
    except (OSError, SyntaxError, ValueError, Warning):
        return file  # the page says what is wrong with it
    return File("image/jpeg", buffer.getvalue())
