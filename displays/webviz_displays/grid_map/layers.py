"""The layers of a grid_map_msgs/GridMap.

A layer is a matrix. Its rows go along -x and its columns along -y from the corner with the largest
x and y; it is a circular buffer, so that row 0 is at the start index. (grid_map_core 2.2,
GridMapMath.cpp; grid_map_ros, GridMapMsgHelpers.hpp.)
"""

from __future__ import annotations

import difflib
from math import isfinite
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Pose, Remedy
from webviz.data.rotations import normalized
from webviz.data.words import listed
from webviz_displays.shared.geometry import FARTHEST

F32 = NDArray[np.float32]
Mask = NDArray[np.bool_]

SMALLEST_CELL = 1e-6
"""Metres; smaller cells are a publisher's error and invisible."""
NAMED = 20
"""Layers that are named in a sentence."""


class GridMapFault(ValueError):
    """A grid map that cannot be drawn; the text says why.

    Args:
        text: a sentence with the cause and a remedy.
        remedy: a change of the display that would help, None if none would.
    """

    def __init__(self, text: str, remedy: Remedy | None = None) -> None:
        super().__init__(text)
        self.remedy = remedy


class Layers(msgspec.Struct, frozen=True, eq=False):
    """A grid map whose layers are read when they are needed.

    Args:
        message: the grid map.
        center: its pose in the frame of the message.
        resolution: edge of a cell in metres.
        shape: rows and columns.
    """

    message: Any
    center: Pose
    resolution: float
    shape: tuple[int, int]

    @property
    def names(self) -> list[str]:
        """Names of all layers."""
        return self.message.layers

    def layer(self, name: str, path: str = "") -> F32:
        """Return the values (rows, columns) of a layer, NaN where there is none.

        Args:
            name: of the layer.
            path: of the property that names it, "" if it is in the message.

        Raises:
            GridMapFault: there is no such layer, or it contradicts the others.
        """
        if name not in self.names:
            purpose = path.replace("_", " ").title() or "layer"
            names_text = listed([f"'{each}'" for each in self.names], NAMED)
            text = (
                f"The grid map has no layer '{name}', but {names_text}. Choose another {purpose}."
            )
            raise GridMapFault(text, self._other(name, path))
        matrix = _matrix(self.message.data[self.names.index(name)], name)
        if matrix.shape != self.shape:
            raise GridMapFault(
                f"The layer '{name}' has {_size(matrix.shape)}, the first one {_size(self.shape)}. "
                "Fix the publisher."
            )
        start = self.message.outer_start_index, self.message.inner_start_index
        return np.roll(matrix, (-start[0], -start[1]), axis=(0, 1))

    def _other(self, name: str, path: str) -> Remedy | None:
        """Return the choice of the layer with the most similar name."""
        best = difflib.get_close_matches(name, self.names, 1, cutoff=0.0)
        return Remedy(path, best[0], f"Use {best[0]}") if path and best else None

    def validity(self, height_layer: str | None) -> Mask:
        """Return the mask of cells (rows, columns) with a value in all basic layers and the height.

        Raises:
            GridMapFault: see `layer`.
        """
        names = [name for name in self.message.basic_layers if name in self.names]
        layers = [self.layer(name) for name in dict.fromkeys(names)]
        if height_layer is not None:
            layers.append(self.layer(height_layer, "height_layer"))
        is_valid = np.ones(self.shape, np.bool_)
        for values in layers:
            is_valid &= np.abs(values) < FARTHEST
        return is_valid

    def values_at(self, row: int, column: int) -> dict[str, float]:
        """Return the values of a cell in all layers that can be read, by name."""
        values = {}
        for name in self.names:
            try:
                values[name] = self.layer(name)[row, column]
            except GridMapFault:
                continue
        return values


def read_layers(message: Any) -> Layers:
    """Return the layers of a grid_map_msgs/msg/GridMap.

    Raises:
        GridMapFault: it contradicts itself, or what it describes cannot be drawn.
    """
    info, names = message.info, message.layers
    if len(names) != len(message.data) or not names:
        raise GridMapFault(
            f"The grid map has {len(names)} layers and {len(message.data)} matrices. "
            "Fix the publisher."
        )
    shape = _matrix(message.data[0], names[0]).shape
    if min(shape) < 2:
        raise GridMapFault(f"The grid map has {_size(shape)}; a surface needs two of each.")
    if not SMALLEST_CELL <= info.resolution < FARTHEST / max(shape):
        raise GridMapFault(
            f"The resolution of the grid map is {info.resolution:g} m. Fix the publisher."
        )
    p, q = info.pose.position, info.pose.orientation
    position, wxyz = (p.x, p.y, p.z), (q.w, q.x, q.y, q.z)
    if not all(map(isfinite, (*position, *wxyz))) or max(map(abs, position)) >= FARTHEST:
        raise GridMapFault(
            f"The pose of the grid map is not finite or farther than {FARTHEST:g} m. "
            "Fix the publisher."
        )
    (unit,), _ = normalized([wxyz])
    center = Pose(position, tuple(unit.tolist()))  # pyright: ignore[reportArgumentType]
    return Layers(message, center, info.resolution, shape)


def _matrix(array: Any, name: str) -> F32:
    """Return a std_msgs/msg/Float32MultiArray as (rows, columns), not yet unrolled."""
    dimensions, first = array.layout.dim, array.layout.data_offset
    sizes = tuple(dimension.size for dimension in dimensions)
    if len(sizes) != 2 or first + sizes[0] * sizes[1] > len(array.data):
        raise GridMapFault(
            f"The layer '{name}' has {len(array.data)} values for the dimensions {list(sizes)}. "
            "Fix the publisher."
        )
    values = array.data[first : first + sizes[0] * sizes[1]].reshape(sizes)
    return values if dimensions[0].label == "row_index" else values.T


def _size(shape: tuple[int, ...]) -> str:
    return f"{shape[0]} rows and {shape[1]} columns"
