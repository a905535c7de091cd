"""Images as Pillow's, at the size at which they are shown."""

from __future__ import annotations

import io

from PIL import Image

from webviz.data.images.compressed import decoding
from webviz.data.images.raw import RawImage, values
from webviz.data.images.tone import Tone, to_rgb

JPEG_QUALITY = 85

_DIRECT = {
    "rgb8": ("RGB", "RGB"),
    "bgr8": ("RGB", "BGR"),
    "8UC3": ("RGB", "BGR"),
    "rgba8": ("RGB", "RGBX"),
    "bgra8": ("RGB", "BGRX"),
    "8UC4": ("RGB", "BGRX"),
    "mono8": ("L", "L"),
    "8UC1": ("L", "L"),
    "8UC": ("L", "L"),
}
"""Modes of encodings that Pillow reads several times faster than numpy reorders them."""


def render(image: RawImage, tone: Tone, factor: int = 1) -> Image.Image:
    """Return an image as a screen shows it.

    Args:
        image: of any encoding.
        tone: for measurements.
        factor: by which it is made smaller, 1 or more; of measurements each is one of the image.

    Raises:
        ImageError: it takes more memory than there is.
    """
    with decoding(image.width, image.height, image.layout.work_bytes):
        return _rendered(image, tone, factor)


def _rendered(image: RawImage, tone: Tone, factor: int) -> Image.Image:
    if (modes := _DIRECT.get(image.encoding)) is not None:
        size = image.width, image.height
        # The last row may end without its gap.
        data = image.data.tobytes() + bytes(max(0, image.step * image.height - len(image.data)))
        image_shown = Image.frombuffer(modes[0], size, data, "raw", modes[1], image.step, 1)
        return image_shown.reduce(factor) if factor > 1 else image_shown
    layout, pixels = image.layout, values(image)
    if layout.is_scaled:
        return Image.fromarray(to_rgb(pixels[::factor, ::factor], layout, tone))
    image_shown = Image.fromarray(to_rgb(pixels, layout, tone))
    return image_shown.reduce(factor) if factor > 1 else image_shown


def jpeg(image: RawImage, tone: Tone, factor: int = 1) -> bytes:
    """Return the same as a JPEG file."""
    file = io.BytesIO()
    render(image, tone, factor).save(file, "JPEG", quality=JPEG_QUALITY)
    return file.getvalue()
