"""The port to sources of map tiles, and the decoding of tiles."""

from __future__ import annotations

import re
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from webviz.data.images.compressed import decoding, inspect_compressed, open_compressed
from webviz.data.images.errors import ImageError
from webviz.data.names import readable

MAX_BYTES = 4 << 20
"""Limit in bytes of a tile as it is stored."""
MAX_EDGE = 1024
"""Largest edge of a tile in pixels; 256 and 512 are usual."""
MAX_REASON = 100
"""Characters that are quoted of an error."""
MAX_TEXT = 300
"""Characters of an attribution."""

Cells = NDArray[np.uint8]
"""RGBA, (H, W, 4), the first row in the south."""

_TAG = re.compile(r"<[^<>]*>")


class TileError(ValueError):
    """Tiles cannot be had.

    Args:
        text: one sentence that says why, made readable: it may quote paths of configs and servers.
    """

    def __init__(self, text: str) -> None:
        super().__init__(readable(text))


class TileSource(Protocol):
    """Tiles of one map in Web Mercator."""

    attribution: str
    """Whom to credit on each picture, "" if unknown."""

    def read(self, zoom: int, x: int, y: int) -> bytes | None:
        """Return a tile as PNG, JPEG or WebP, None if the map has none there; may take seconds.

        Args:
            zoom: level.
            x: column from the west, 0 to 2**zoom - 1.
            y: row from the north.

        Raises:
            TileError: it cannot be read.
        """
        ...


def plain(text: object) -> str:
    """Return an attribution without the markup that maps have in it."""
    words = _TAG.sub("", text) if isinstance(text, str) and len(text) < 100 * MAX_TEXT else ""
    words = words.replace("&copy;", "©").replace("&amp;", "&")
    return " ".join(words.split())[:MAX_TEXT]


def decoded(tile: bytes) -> Cells:
    """Return the pixels of a tile.

    Raises:
        TileError: it is not an image, such as a tile with vectors, or it is too large.
    """
    data = np.frombuffer(tile, np.uint8)
    try:
        about = inspect_compressed("png", data)
        if not about.mime.startswith("image/"):
            raise TileError(f"Tiles of the type {about.mime} are not supported. Use PNG or JPEG.")
        if max(about.width, about.height) > MAX_EDGE:
            raise TileError(
                f"A tile has {about.width} x {about.height} pixels; the limit is {MAX_EDGE}."
            )
        with decoding(about.width, about.height, 8):
            picture = open_compressed(data).convert("RGBA")
            cells = np.asarray(picture.transpose(Image.Transpose.FLIP_TOP_BOTTOM))
    except ImageError as error:
        raise TileError(f"A tile cannot be shown. {error}") from None
    except (OSError, SyntaxError, ValueError) as error:
        if isinstance(error, TileError):
            raise
        raise TileError("A tile is damaged.") from error
    return cells
