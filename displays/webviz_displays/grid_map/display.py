"""The GridMap display."""

from __future__ import annotations

import math
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from webviz import (
    Color,
    ColorScale,
    Context,
    Details,
    Display,
    Group,
    Hit,
    Input,
    Mesh,
    Prop,
    Remedy,
    Sample,
    Topic,
    compose,
)
from webviz.data.words import listed
from webviz_displays.grid_map.layers import NAMED, GridMapFault, Layers, read_layers
from webviz_displays.shared.colors import RAINBOW, Alpha, bounds, ramp
from webviz_displays.shared.geometry import LONGEST
from webviz_displays.shared.points_display import MaxColor, MaxIntensity, MinColor, MinIntensity
from webviz_displays.shared.properties import opaque

U32 = NDArray[np.uint32]

_TRIANGLES = (
    ((0, 2, 1), (1, 2, 3)),
    ((1, 2, 3),),
    ((0, 2, 3),),
    ((0, 3, 1),),
    ((0, 2, 1),),
)
"""Counter-clockwise from above, of four neighbours: those of the next column and row are 1 and 2,
that of both 3. First if all are there, then without 0, 1, 2, 3."""


def places(shape: tuple[int, int], resolution: float, heights: F32) -> F32:
    """Return the centres (rows, columns, 3) of all cells, metres from the centre of the map."""
    rows, columns = (resolution * ((count - 1) / 2 - np.arange(count)) for count in shape)
    x, y = np.meshgrid(rows, columns, indexing="ij")
    return np.stack((x, y, heights), axis=-1).astype(np.float32)


def faces_of(is_valid: Mask) -> U32:
    """Triangles (N, 3) between neighbours, by the number of each among the valid cells.

    Args:
        is_valid: (rows, columns), which cells have a place.
    """
    numbers = np.cumsum(is_valid, dtype=np.uint32).reshape(is_valid.shape) - np.uint32(1)
    corners = [np.s_[:-1, :-1], np.s_[:-1, 1:], np.s_[1:, :-1], np.s_[1:, 1:]]
    is_there = np.stack([is_valid[corner] for corner in corners], axis=-1)
    four = np.stack([numbers[corner] for corner in corners], axis=-1)
    missing = 4 - is_there.sum(axis=-1)
    cases = np.where(missing == 0, 0, np.where(missing == 1, 1 + np.argmin(is_there, axis=-1), -1))
    faces = [four[cases == case][:, triangles].reshape(-1, 3)
             for case, triangles in enumerate(map(np.array, _TRIANGLES))]  # fmt: skip
    return np.concatenate(faces)


def lines_of(points: F32, is_valid: Mask, step: int) -> F32:
    """Segments (N, 2, 3) along every `step`-th row and column and the last ones.

    Args:
        points: (rows, columns, 3).
        is_valid: (rows, columns), which of them there are.
        step: at least 1.
    """
    lines = []
    for axis in (0, 1):
        across = points.shape[axis]
        chosen = np.unique(np.append(np.arange(0, across, step), across - 1))
        some = np.take(points, chosen, axis).swapaxes(0, axis)
        there = np.take(is_valid, chosen, axis).swapaxes(0, axis)
        segments = np.stack((some[:, :-1], some[:, 1:]), axis=2)
        lines.append(segments[there[:, :-1] & there[:, 1:]])
    return np.concatenate(lines)


U8 = NDArray[np.uint8]
F32 = NDArray[np.float32]
Mask = NDArray[np.bool_]

MAX_CELLS = 100_000
"""Cells drawn per map; each takes 48 bytes to send, and its lines 48."""

NO_VALUE = (128, 128, 128)
"""Colour of cells with a height, but without a value in the colour layer."""

_BY_COLOR_LAYER = ("color_transformer", ("IntensityLayer", "ColorLayer"))
_BY_INTENSITY = ("color_transformer", "IntensityLayer")


class GridMap(Display):
    """A map of several layers as a surface: one layer is its height, another one its colour."""

    rviz = "grid_map_rviz_plugin/GridMap"
    is_threaded = True

    topic: Annotated[
        Topic, Input("grid_map_msgs/msg/GridMap"), Prop(help="Topic of the grid maps.")
    ] = Topic("/grid_map")
    alpha: Annotated[
        Alpha,
        Prop(help="Opacity of the surface and of its lines."),
    ] = 1.0
    history_length: Annotated[
        int, Prop(ge=1, le=100, help="How many of the newest messages to show.")
    ] = 1
    show_grid_lines: Annotated[bool, Prop(help="Draw lines between neighbouring cells.")] = True
    grid_line_thickness: Annotated[
        float,
        Prop(gt=0, le=10, when=("show_grid_lines", True), help="Width of the lines in cells."),
    ] = 0.1
    grid_cell_decimation: Annotated[
        int,
        Prop(
            ge=1,
            le=10_000,
            when=("show_grid_lines", True),
            help="Draw the lines of every n-th row and column.",
        ),
    ] = 1
    height_transformer: Annotated[
        Literal["Layer", "Flat"], Prop(help="Take heights from a layer, or draw a flat surface.")
    ] = "Layer"
    height_layer: Annotated[
        str, Prop(when=("height_transformer", "Layer"), help="Name of the layer with heights in m.")
    ] = "elevation"
    color_transformer: Annotated[
        Literal["IntensityLayer", "ColorLayer", "FlatColor", "None"],
        Prop(
            help="Colour by the values of a layer, by a layer of packed colours, or all alike; "
            "None draws lines only."
        ),
    ] = "IntensityLayer"
    color_layer: Annotated[
        str, Prop(when=_BY_COLOR_LAYER, help="Name of the layer that determines the colour.")
    ] = "elevation"
    color: Annotated[
        Color, Prop(when=("color_transformer", "FlatColor"), help="Colour of the surface.")
    ] = (200, 200, 200)
    use_rainbow: Annotated[
        bool,
        Prop(
            when=_BY_INTENSITY,
            help="Colour from magenta (low) to red (high) instead of between two colours.",
        ),
    ] = True
    invert_rainbow: Annotated[
        bool, Prop(when=("use_rainbow", True), help="Colour from red (low) to magenta (high).")
    ] = False
    min_color: MinColor = (0, 0, 0)
    max_color: MaxColor = (255, 255, 255)
    autocompute_intensity_bounds: Annotated[
        bool,
        Prop(when=_BY_INTENSITY, help="Compute the lowest and highest value from each message."),
    ] = True
    min_intensity: MinIntensity = 0.0
    max_intensity: MaxIntensity = 10.0

    def draw(self, sample: Sample, ctx: Context) -> None:
        """One map, in the frame and at the stamp of its header."""
        try:
            layers = read_layers(sample.message)
            is_flat = self.height_transformer == "Flat"
            is_valid = layers.validity(None if is_flat else self.height_layer)
            heights = np.zeros(layers.shape, np.float32)
            if not is_flat:
                heights = layers.layer(self.height_layer, "height_layer")
            step = math.ceil(math.sqrt(heights.size / MAX_CELLS))
            thinned = np.s_[::step, ::step]
            colors = self._colors(layers, is_valid, ctx)[thinned]
        except GridMapFault as fault:
            ctx.error("Grid map", str(fault), fault.remedy)
            return
        points = places(layers.shape, layers.resolution, np.where(is_valid, heights, 0.0))[thinned]
        group = ctx.follow(None, offset=compose(sample.pose, layers.center))
        self._report(layers, is_valid, step, ctx)
        if self.alpha > 0:
            self._draw_surface(points, colors, is_valid[thinned], group)
            self._draw_lines(points, is_valid[thinned], layers.resolution, group)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return the values of a cell in all layers."""
        try:
            layers = read_layers(hit.sample.message)
        except GridMapFault:
            return None
        place = [
            round((count - 1) / 2 - metres / layers.resolution)
            for count, metres in zip(layers.shape, hit.point[:2], strict=True)
        ]
        row, column = (
            min(max(index, 0), count - 1) for index, count in zip(place, layers.shape, strict=True)
        )
        values = {"Size of a cell": f"{layers.resolution:g} m"}
        return Details(f"Cell {row}, {column}", layers.values_at(row, column) | values)

    def _colors(self, layers: Layers, is_valid: Mask, ctx: Context) -> U8:
        """Return the colours (rows, columns, 3) of all cells."""
        if self.color_transformer not in ("IntensityLayer", "ColorLayer"):
            return np.broadcast_to(np.array(self.color, np.uint8), (*layers.shape, 3))
        values = layers.layer(self.color_layer, "color_layer")
        is_known = np.isfinite(values)
        if self.color_transformer == "ColorLayer":
            packed = np.ascontiguousarray(values).view(np.uint32)
            colors = np.stack([packed >> 16, packed >> 8, packed], axis=-1).astype(np.uint8)
        else:
            low, high = self.min_intensity, self.max_intensity
            if self.autocompute_intensity_bounds:
                low, high = bounds(values[is_valid & is_known])
            rainbow = RAINBOW if self.invert_rainbow else RAINBOW[::-1]
            stops = rainbow if self.use_rainbow else (self.min_color, self.max_color)
            ctx.color_scale = ColorScale(self.color_layer, low, high, stops)
            colors = ramp(values.ravel(), low, high, stops).reshape(*values.shape, 3)
        colors[~is_known] = NO_VALUE
        return colors

    def _draw_surface(self, points: F32, colors: U8, is_valid: Mask, group: Group) -> None:
        faces = faces_of(is_valid)
        if self.color_transformer == "None" or not len(faces):
            return
        alphas = np.full((int(is_valid.sum()), 1), round(255 * self.alpha), np.uint8)
        corners = np.hstack((colors[is_valid], alphas))
        group.add("surface", Mesh(points[is_valid], faces, self.color, colors=corners))

    def _draw_lines(self, points: F32, is_valid: Mask, resolution: float, group: Group) -> None:
        if self.show_grid_lines and is_valid.any():
            lines = lines_of(points, is_valid, self.grid_cell_decimation)
            width = min(self.grid_line_thickness * resolution, LONGEST)
            group.lines("lines", lines, (0, 0, 0), width, "m", opacity=self.alpha)

    def _report(self, layers: Layers, is_valid: Mask, step: int, ctx: Context) -> None:
        rows, columns = layers.shape
        count = int(is_valid.sum())
        size = f"{rows} x {columns} cells of {layers.resolution:g} m"
        ctx.ok("Layers", f"{listed(layers.names, NAMED)}.")
        if not count:
            ctx.warn("Grid map", f"None of the {size} has a value. Check the publisher.")
        elif self.alpha == 0:
            ctx.warn(
                "Grid map", "Invisible: alpha is 0. Increase it to show the grid map.", opaque()
            )
        elif self.color_transformer == "None" and not self.show_grid_lines:
            ctx.warn(
                "Grid map",
                "There is nothing to draw: choose a colour or show grid lines.",
                Remedy("show_grid_lines", True, "Show grid lines"),
            )
        elif step > 1:
            ctx.warn(
                "Grid map",
                f"Showing every {step}th row and column of {size}, because the limit is "
                f"{MAX_CELLS} cells. Publish a smaller map to see all.",
            )
        else:
            ctx.ok("Grid map", f"Showing {count} of {size}.")
