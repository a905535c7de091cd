"""Images in the scene, as textures that are small enough to be sent at their rate."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from webviz.api.decoded import opened
from webviz.api.pictures import Encoded, Pixels
from webviz.data.images import render

MAX_TEXELS = 320
"""Largest number of texels along an edge."""


def texels(picture: Pixels | Encoded, alpha: float = 1.0) -> NDArray[np.uint8]:
    """RGBA (H, W, 4) of a picture, its upper left pixel first; slow for large ones.

    Args:
        picture: of any size. A texel has the mean colour of its pixels, or of measurements the
            colour of one.
        alpha: opacity, 0 to 1.

    Raises:
        ImageError: its file is damaged.
    """
    factor = max(1, -(-max(picture.size) // MAX_TEXELS))
    if isinstance(picture, Pixels):
        image = render(picture.image, picture.tone, factor)
    else:
        image = opened(picture).reduce(factor)
    image = image.convert("RGB")
    image.putalpha(round(255 * alpha))
    return np.asarray(image)
