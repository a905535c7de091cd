"""Images in the scene, such as maps."""

from __future__ import annotations

import functools

import numpy as np
from viser import ImageHandle

from webviz.api.nodes import U8, Image, same
from webviz.scene.adapter import Adapter
from webviz.scene.adapter.image import add_blank_image
from webviz.scene.names import TILE_PREFIX
from webviz.scene.png import encode_png

# Cells per edge of a tile, more if the image is narrow. Updates send only tiles that changed. All
# current WebGL 2 browsers support textures of 8192 texels.
TILE = 1024
LONGEST_TILE = 8192

Tile = tuple[int, int, int]
"""Layer, row and column of the first cell. The page reads the layer from the name."""

Shape = tuple[int, int]
"""Rows and columns of a tile."""

Extent = tuple[tuple[float, float], tuple[float, float]]
"""Centre and size in metres."""


class ImageVisual:
    """An image as one viser image per tile, under one frame.

    viser's image is unlit, has exact colours, and shows the old texture until the new one is
    decoded, so that updates do not flicker. Its rows run along y, because viser mounts images
    upside down. The page makes cells sharp (tiles.js).

    Tiles are encoded in another thread, and sent by the frame loop.
    """

    def __init__(self, link: Adapter, name: str) -> None:
        self._link = link
        self._name = name
        self._frame = link.server.scene.add_frame(name, show_axes=False)
        self._tiles: set[Tile] = set()
        self._handles: dict[Tile, ImageHandle] = {}
        self._extents: dict[Tile, Extent] = {}
        self._node: Image | None = None

    def draw(self, node: Image) -> None:
        """Send the tiles that changed.

        Raises:
            ValueError: the cells do not have the type and shape that `Image` requires.
        """
        cells, shape = node.cells, node.cells.shape
        if cells.dtype != np.uint8 or shape[2:] != (() if node.palette is not None else (4,)):
            raise ValueError(f"Cells of type {cells.dtype} and shape {shape} are not supported.")
        old, self._node = self._node, node
        height, width = _shape(node)
        rows, columns = range(0, shape[0], height), range(0, shape[1], width)
        tiles = {(node.layer, y, x) for y in rows for x in columns}
        for tile in self._tiles - tiles:
            self._drop(tile)
        for tile in sorted(tiles):
            if old is None or tile not in self._tiles or not _is_same(tile, node, old):
                self._draw_tile(tile, node)
        self._tiles = tiles

    def remove(self) -> None:
        """Remove the image from the scene."""
        for tile in self._tiles:
            self._drop(tile)
        self._frame.remove()

    def _draw_tile(self, tile: Tile, node: Image) -> None:
        encode = functools.partial(encode_png, _cells(node, tile), node.palette)
        send = functools.partial(self._send, tile, _extent(node, tile))
        self._link.deferred.put(self._path(tile), encode, send)

    def _send(self, tile: Tile, extent: Extent, png: bytes) -> None:
        name = self._path(tile)
        (x, y), (width, height) = extent
        size = {"render_width": width, "render_height": height}
        with self._link.atomic():
            if tile not in self._handles:
                self._handles[tile] = add_blank_image(self._link.server, name)
            self._link.update(name, {"_data": png, "_format": "png", **size})
            if self._extents.get(tile) != extent:
                self._extents[tile] = extent
                self._link.set_position(name, (x, y, 0.0))

    def _drop(self, tile: Tile) -> None:
        self._link.deferred.drop(self._path(tile))
        handle = self._handles.pop(tile, None)
        if handle is not None:
            handle.remove()
            del self._extents[tile]
            self._link.count_removals(1)

    def _path(self, tile: Tile) -> str:
        layer, y, x = tile
        return f"{self._name}/{TILE_PREFIX}{layer} {y} {x}"


def _shape(node: Image) -> Shape:
    """Return the shape of tiles: square, or with as many cells if the image has a short edge."""
    rows, columns = node.cells.shape[:2]
    height = max(TILE, min(LONGEST_TILE, TILE * TILE // max(columns, 1)))
    width = max(TILE, min(LONGEST_TILE, TILE * TILE // max(rows, 1)))
    return height, width


def _is_same(tile: Tile, new: Image, old: Image) -> bool:
    return (
        same(new.palette, old.palette)
        and same(_cells(new, tile), _cells(old, tile))
        and _extent(new, tile) == _extent(old, tile)
    )


def _cells(node: Image, tile: Tile) -> U8:
    _, y, x = tile
    height, width = _shape(node)
    return node.cells[y : y + height, x : x + width]


def _extent(node: Image, tile: Tile) -> Extent:
    height, width = _cells(node, tile).shape[:2]
    dx, dy = node.width / node.cells.shape[1], node.height / node.cells.shape[0]
    centre = ((tile[2] + width / 2) * dx, (tile[1] + height / 2) * dy)
    return centre, (width * dx, height * dy)
