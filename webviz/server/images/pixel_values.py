"""Value of a pixel of an image, in words."""

from __future__ import annotations

import math

from webviz.api.pictures import Picture, Pixels
from webviz.data.images import decoding, values


def pixel_text(picture: Picture, x: int, y: int) -> str:
    """Return the value of a pixel: depths in metres, colours as red, green and blue; "" if unknown.

    Args:
        picture: of a display.
        x, y: column and row from the upper left corner, from 0.
    """
    if not isinstance(picture, Pixels):
        return ""
    image, layout = picture.image, picture.image.layout
    if not (0 <= x < image.width and 0 <= y < image.height):
        return ""
    with decoding(image.width, image.height, layout.work_bytes):
        value = values(image)[y, x]
    if value.ndim:
        return " ".join(f"{each:.4g}" if each.dtype.kind == "f" else str(each) for each in value)
    if not layout.unit:
        return f"{value:.6g}" if value.dtype.kind == "f" else str(value)
    metres = float(value) / (1000.0 if layout.unit == "mm" else 1.0)
    is_valid = math.isfinite(metres) and not (layout.zero_is_invalid and not value)
    return f"{metres:.3f} m" if is_valid else "no measurement"
