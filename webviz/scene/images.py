"""Pictures in the scene: maps, costmaps."""

from __future__ import annotations

import io

import numpy as np
import PIL.Image
from viser import ImageHandle

from webviz.nodes import U8, Image
from webviz.scene.adapter import Adapter

# Cells per edge of a tile. An update sends only tiles that changed, and no texture comes near the
# 8192 texels that every WebGL 2 browser of the last years has.
TILE = 1024

# The page recognises pictures by this in their names (see page.py); no key has it when escaped.
TILE_PREFIX = "%tile "

Tile = tuple[int, int, int]
"""Layer, and row and column of the first cell. The page reads the layer from the name."""

_BLANK = np.zeros((1, 1, 4), np.uint8)


class ImageDrawn:
    """A picture as viser images, one for each tile, under one frame.

    viser's image is unlit, in exact colours, and shows the old texture until the new one is
    decoded, so an update never blanks. Its rows run along y already, for viser hangs images upside
    down. Sharp cells are the page's work (page.py).
    """

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._frame = link.server.scene.add_frame(name, show_axes=False)
        self._tiles: dict[Tile, ImageHandle] = {}
        self._sent: Image | None = None

    def draw(self, node: Image) -> None:
        """Sends the tiles that changed."""
        old, self._sent = self._sent, node
        rows, columns = node.rgba.shape[:2]
        wanted = [(node.layer, y, x) for y in range(0, rows, TILE) for x in range(0, columns, TILE)]
        for corner in set(self._tiles) - set(wanted):
            self._tiles.pop(corner).remove()
            self._link.count_removals(1)
        for corner in wanted:
            self._draw_tile(corner, node, old)

    def remove(self) -> None:
        """Takes the picture off the scene."""
        self._link.count_removals(len(self._tiles))
        self._frame.remove()

    def _draw_tile(self, corner: Tile, node: Image, old: Image | None) -> None:
        name = f"{self._name}/{TILE_PREFIX}{corner[0]} {corner[1]} {corner[2]}"
        cells = _cells(node, corner)
        is_new = corner not in self._tiles
        if is_new:
            self._tiles[corner] = self._link.server.scene.add_image(
                name, _BLANK, 1.0, 1.0, format="png", cast_shadow=False, receive_shadow=False
            )
        if is_new or old is None or not np.array_equal(cells, _cells(old, corner)):
            self._link.update(name, {"_data": encode_png(cells), "_format": "png"})
        extent = _extent(node, corner)
        if is_new or old is None or extent != _extent(old, corner):
            (x, y), (width, height) = extent
            self._link.update(name, {"render_width": width, "render_height": height})
            self._link.set_position(name, (x, y, 0.0))


def encode_png(rgba: U8) -> bytes:
    """Encodes uint8 (H, W, 4) fast: a map is sent once, and it compresses well at any level."""
    file = io.BytesIO()
    PIL.Image.fromarray(np.ascontiguousarray(rgba)).save(file, "PNG", compress_level=1)
    return file.getvalue()


def _cells(node: Image, corner: Tile) -> U8:
    _, y, x = corner
    return node.rgba[y : y + TILE, x : x + TILE]


def _extent(node: Image, corner: Tile) -> tuple[tuple[float, float], tuple[float, float]]:
    """Centre and size of a tile in metres."""
    height, width = _cells(node, corner).shape[:2]
    dx, dy = node.width / node.rgba.shape[1], node.height / node.rgba.shape[0]
    centre = ((corner[2] + width / 2) * dx, (corner[1] + height / 2) * dy)
    return centre, (width * dx, height * dy)
