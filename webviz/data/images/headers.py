"""Kind and size of compressed images by their first bytes, without a decoder.

Pillow issues warnings about odd files, and these cannot be silenced for one thread alone. The
layouts are those of the PNG specification (third edition), ITU-T T.81 and RFC 9649.
"""

from __future__ import annotations

import re
import struct
from typing import NamedTuple

from webviz.data.images.errors import ImageError

PNG = b"\x89PNG\r\n\x1a\n"
_IHDR = struct.Struct(">I4sIIBB")
"""Length, name, width, height, bits of a channel, and kind of colour."""
_STARTS = {
    b"\xff\xd8\xff": "JPEG",
    PNG: "PNG",
    b"II*\0": "TIFF",
    b"MM\0*": "TIFF",
    b"BM": "BMP",
    b"GIF8": "GIF",
    b"\0\0\0\x0cjP": "JPEG2000",
    b"\xff\x4f\xff\x51": "JPEG2000",
}
_MARKER = re.compile(rb"\xff+([^\xff])", re.DOTALL)
_FRAMES = {*range(0xC0, 0xD0)} - {0xC4, 0xC8, 0xCC}
"""Markers of a JPEG whose segment has the size."""
_MAX_SEGMENTS = 1000


class ImageHeader(NamedTuple):
    """Declared properties of an image file.

    Args:
        kind: "JPEG", "PNG", "WEBP", or one that browsers do not show.
        width, height: in pixels; 0 of those.
        is_16_bit: of a PNG with 16 bits of grey.
    """

    kind: str
    width: int = 0
    height: int = 0
    is_16_bit: bool = False

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in pixels."""
        return self.width, self.height


def read_header(data: memoryview) -> ImageHeader | None:
    """Return the properties in the first bytes of a file; None if it is not an image.

    Raises:
        ImageError: it begins as an image, but has no size.
    """
    start = bytes(data[:12])
    kind = next((kind for each, kind in _STARTS.items() if start.startswith(each)), "")
    if start[:4] == b"RIFF" and start[8:] == b"WEBP":
        kind = "WEBP"
    try:
        match kind:
            case "PNG":
                header = _png(data)
            case "JPEG":
                header = _jpeg(data)
            case "WEBP":
                header = _webp(bytes(data[12:30]))
            case _:
                return ImageHeader(kind) if kind else None
    except (struct.error, IndexError):
        header = None
    if header is None or not header.width or not header.height:
        raise ImageError(f"The {kind} is damaged: its header has no size.")
    return header


def _png(data: memoryview) -> ImageHeader | None:
    _, name, width, height, bits, color = _IHDR.unpack_from(data, len(PNG))
    return ImageHeader("PNG", width, height, (bits, color) == (16, 0)) if name == b"IHDR" else None


def _jpeg(data: memoryview) -> ImageHeader | None:
    at = 2
    for _ in range(_MAX_SEGMENTS):
        match = _MARKER.match(data, at)
        if match is None:
            return None
        at = match.end()
        if match[1][0] in _FRAMES:
            height, width = struct.unpack_from(">HH", data, at + 3)
            return ImageHeader("JPEG", width, height)
        at += struct.unpack_from(">H", data, at)[0]
    return None


def _webp(data: bytes) -> ImageHeader | None:
    match data[:4]:
        case b"VP8 " if data[11:14] == b"\x9d\x01\x2a":
            width, height = struct.unpack_from("<HH", data, 14)
            return ImageHeader("WEBP", width & 0x3FFF, height & 0x3FFF)
        case b"VP8L" if data[8] == 0x2F:
            bits = struct.unpack_from("<I", data, 9)[0]
            return ImageHeader("WEBP", (bits & 0x3FFF) + 1, (bits >> 14 & 0x3FFF) + 1)
        case b"VP8X":
            low, middle, high = struct.unpack_from("<HHH", data, 12)
            return ImageHeader(
                "WEBP", (low | (middle & 0xFF) << 16) + 1, (middle >> 8 | high << 8) + 1
            )
    return None
