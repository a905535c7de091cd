"""The Grid display."""

from __future__ import annotations

import bisect
import functools
from collections.abc import Sequence
from typing import Annotated, Literal

import numpy as np
from numpy.typing import NDArray

from webviz import Color, Context, Details, Display, Hit, Prop, Remedy, Sample
from webviz.data.transforms import REACH_M
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import Metres
from webviz_displays.shared.properties import FIXED_FRAME, frame_of, opaque

MAX_LINES = 200_000
"""More lines would make the browser unresponsive."""

GREY = (160, 160, 164)
"""RViz's; pages with another theme have another."""

# Which axes of the frame are the two of the plane and its normal.
_PLANES = {"XY": (0, 1, 2), "XZ": (0, 2, 1), "YZ": (1, 2, 0)}


class Grid(Display):
    """A grid of lines for judging distances."""

    rviz = "rviz_default_plugins/Grid"
    icon = "grid"

    reference_frame: Annotated[str, Prop(widget="frame", help="Frame in which the grid lies.")] = (
        FIXED_FRAME
    )
    plane_cell_count: Annotated[int, Prop(ge=1, help="Cells along each side of the plane.")] = 10
    normal_cell_count: Annotated[
        int, Prop(ge=0, help="Cells along the plane's normal; 0 makes a flat grid.")
    ] = 0
    cell_size: Annotated[Metres, Prop(help="Edge length of a cell.")] = 1.0
    line_style: Annotated[
        Literal["Lines", "Billboards"],
        Prop(help="Lines are one pixel wide, Billboards have a width in metres."),
    ] = "Lines"
    line_width: Annotated[
        Metres,
        Prop(
            rviz="Line Style/Line Width",
            when=("line_style", "Billboards"),
            help="Width of the lines.",
        ),
    ] = 0.03
    color: Annotated[
        Color, Prop(help="Colour of the lines; the default is darker on pages with a light theme.")
    ] = GREY
    alpha: Annotated[Alpha, Prop(help="Opacity of the lines.")] = 0.5
    plane: Annotated[
        Literal["XY", "XZ", "YZ"], Prop(help="Plane of the frame in which the grid lies.")
    ] = "XY"
    offset: Annotated[
        tuple[float, float, float],
        Prop(unit="m", help="Centre of the grid in the reference frame."),
    ] = (0.0, 0.0, 0.0)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """All lines as one node that follows the reference frame."""
        if self.alpha == 0:
            ctx.warn("Grid", "Invisible: alpha is 0. Increase it to show the grid.", opaque())
            return
        counts = self.plane_cell_count, self.normal_cell_count
        plane, normal = _inner(*counts)
        reach = self.cell_size * max(plane, normal) + max(map(abs, self.offset))
        if reach > REACH_M:
            problem = f"The grid reaches {reach:g} m. Choose smaller cells or a smaller offset."
            ctx.error("Grid", problem)
            return
        segments = self.cell_size * _unit_grid(plane, normal, self.plane) + np.array(self.offset)
        group = ctx.follow(frame_of(self.reference_frame))
        width, unit = (1.0, "px") if self.line_style == "Lines" else (self.line_width, "m")
        color = None if self.color == GREY else self.color
        group.lines("grid", segments, color, width, unit, opacity=self.alpha)
        if (plane, normal) == counts:
            ctx.ok("Grid", f"{_count(plane, normal)} lines.")
            return
        cells = f"{plane} x {plane}" + (f" x {normal}" if normal else "")
        ctx.warn(
            "Grid",
            f"More than {MAX_LINES} lines are too many for a browser; showing the {cells} "
            "cells in the middle. Choose fewer and larger cells.",
            Remedy("plane_cell_count", plane, f"Use {plane} cells")
            if normal == self.normal_cell_count
            else Remedy("normal_cell_count", normal, f"Use {normal} cells along the normal"),
        )

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the grid as a whole."""
        plane, normal = _inner(self.plane_cell_count, self.normal_cell_count)
        values = {
            "Cell size": f"{self.cell_size:g} m",
            "Cells": f"{plane} x {plane}" + (f" x {normal}" if normal else ""),
            "Plane": self.plane,
            "Reference frame": frame_of(self.reference_frame) or ctx.frames.fixed_frame,
        }
        return Details("Grid", values)


def _count(plane: int, normal: int) -> int:
    """Return the number of lines of a grid from its cells along the plane and the normal."""
    return 2 * (plane + 1) * (normal + 1) + ((plane + 1) ** 2 if normal else 0)


def _inner(plane: int, normal: int) -> tuple[int, int]:
    """Return the cells along the plane and along the normal that can be drawn around the middle."""

    def within(most: int) -> tuple[int, int]:
        # Fewer by an even number, so that the remaining lines keep their places.
        return min(plane, most - (plane - most) % 2), min(normal, most - (normal - most) % 2)

    if _count(plane, normal) <= MAX_LINES:
        return plane, normal
    limits = range(2, MAX_LINES)
    return within(bisect.bisect_right(limits, MAX_LINES, key=lambda n: _count(*within(n))) + 1)


@functools.lru_cache(maxsize=4)
def _unit_grid(plane: int, normal: int, axes: str) -> NDArray[np.float64]:
    """Return the segments (N, 2, 3) of a grid with cells of edge 1 around the origin."""
    across = np.arange(plane + 1) - plane / 2
    heights = np.arange(normal + 1) - normal / 2
    place, height = (g.ravel() for g in np.meshgrid(across, heights))
    end = np.full(len(place), plane / 2)
    lines = [
        np.stack([(place, -end, height), (place, end, height)]),
        np.stack([(-end, place, height), (end, place, height)]),
    ]
    if normal:
        x, y = (g.ravel() for g in np.meshgrid(across, across))
        top = np.full(len(x), normal / 2)
        lines.append(np.stack([(x, y, -top), (x, y, top)]))
    segments = np.concatenate(lines, axis=2).transpose(2, 0, 1)
    result = np.empty(segments.shape)
    result[..., _PLANES[axes]] = segments
    return result
