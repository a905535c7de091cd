"""Images of panes as pixels."""

from __future__ import annotations

from PIL import Image

from webviz.api.pictures import Encoded, Pixels
from webviz.data.images import ImageError, decoding, open_compressed, render

PIXEL_BYTES = 8
"""Bytes of a pixel of a compressed image while it is decoded: Pillow has four, and copies them."""


def opened(picture: Pixels | Encoded) -> Image.Image:
    """Return a picture as Pillow's.

    Raises:
        ImageError: its file is damaged.
    """
    if isinstance(picture, Pixels):
        return render(picture.image, picture.tone)
    try:
        with open_compressed(picture.data) as image, decoding(*image.size, PIXEL_BYTES):
            rgb = image.convert("RGB")
    except ImageError:
        raise
    except (OSError, SyntaxError, ValueError, Warning) as error:
        raise ImageError(f"The {picture.mime} is damaged: {str(error)[:80]}.") from error
    if picture.swaps_red_and_blue:
        red, green, blue = rgb.split()
        return Image.merge("RGB", (blue, green, red))
    return rgb
