"""The VoxelGrid display."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from webviz import (
    Color,
    Context,
    Details,
    Display,
    Group,
    Hit,
    Input,
    Pose,
    Prop,
    Remedy,
    Rgb,
    Sample,
    Topic,
    compose,
)
from webviz_displays.point_cloud2.decimation import evenly
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import FARTHEST
from webviz_displays.shared.properties import opaque

MAX_VOXELS = 200_000
"""Boxes drawn at once; each takes 43 bytes to send."""
MAX_LEVELS = 16
"""A column is 32 bits: from bit 0 on those that are not free, from bit 16 on those marked."""

KINDS = ("marked", "unknown", "free")

Cells = NDArray[np.bool_]


def cells_of(message: Any) -> dict[str, Cells]:
    """Return the cells (columns along y, x; levels) of each kind of a nav2_msgs/msg/VoxelGrid.

    As in nav2_voxel_grid's voxel_grid.hpp both bits of a marked cell are set and none of a free
    one.
    """
    levels = np.arange(message.size_z, dtype=np.uint32)
    columns = message.data.reshape(message.size_y, message.size_x, 1)
    low = (columns >> levels & 1).astype(np.bool_)
    high = (columns >> (levels + MAX_LEVELS) & 1).astype(np.bool_)
    return {"marked": low & high, "unknown": low ^ high, "free": ~(low | high)}


class VoxelGrid(Display):
    """The voxel layer of a costmap of Nav2: marked, unknown and free space."""

    is_threaded = True

    topic: Annotated[
        Topic, Input("nav2_msgs/msg/VoxelGrid"), Prop(help="Topic of the voxel grids.")
    ] = Topic("/local_costmap/voxel_grid")
    show_marked: Annotated[bool, Prop(help="Draw voxels with an obstacle.")] = True
    marked_color: Annotated[
        Color, Prop(when=("show_marked", True), help="Colour of voxels with an obstacle.")
    ] = (255, 0, 0)
    marked_alpha: Annotated[
        Alpha,
        Prop(
            when=("show_marked", True), help="Opacity of voxels with an obstacle; 0 is invisible."
        ),
    ] = 1.0
    show_unknown: Annotated[bool, Prop(help="Draw voxels that no sensor has seen.")] = False
    unknown_color: Annotated[
        Color, Prop(when=("show_unknown", True), help="Colour of unknown voxels.")
    ] = (0, 0, 255)
    unknown_alpha: Annotated[
        Alpha, Prop(when=("show_unknown", True), help="Opacity of unknown voxels; 0 is invisible.")
    ] = 0.5
    show_free: Annotated[bool, Prop(help="Draw voxels known to be free.")] = False
    free_color: Annotated[Color, Prop(when=("show_free", True), help="Colour of free voxels.")] = (
        0,
        255,
        0,
    )
    free_alpha: Annotated[
        Alpha, Prop(when=("show_free", True), help="Opacity of free voxels; 0 is invisible.")
    ] = 0.1

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the visible voxels as boxes, in the frame and at the stamp of the header."""
        message = sample.message
        if fault := _fault_of(message):
            ctx.error("Voxels", fault)
            return
        cells = cells_of(message)
        counts = ", ".join(f"{int(each.sum())} {kind}" for kind, each in cells.items())
        size = message.resolutions
        ctx.ok("Voxels", f"{counts}, of {size.x:g} m x {size.y:g} m x {size.z:g} m.")
        group = ctx.follow(None, offset=compose(sample.pose, Pose(_corner(message))))
        looks = self._looks()
        is_drawn = [_add(kind, cells[kind], message, *looks[kind], group, ctx) for kind in looks]
        if not any(is_drawn):
            text = f"Nothing to draw of {counts}. Show other kinds or raise alpha."
            ctx.warn("Voxels", text, self._remedy(cells))

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return a voxel."""
        message = hit.sample.message
        x, y, z = _indices(np.array([hit.id]), message)[0].tolist()
        center = np.add(_corner(message), _centers(np.array([hit.id]), message)[0])
        return Details(
            f"Voxel {x}, {y}, {z}", {"State": hit.key, f"Centre in {hit.sample.frame}": center}
        )

    def _remedy(self, cells: Mapping[str, NDArray[np.bool_]]) -> Remedy | None:
        """Return the change that shows the first kind of which there are voxels."""
        kind = next((each for each in KINDS if cells[each].any()), None)
        if kind is None:
            return None
        if getattr(self, f"{kind}_alpha") == 0:
            return opaque(f"{kind}_alpha")
        return Remedy(f"show_{kind}", True, f"Show {kind} voxels")

    def _looks(self) -> dict[str, tuple[Rgb, float]]:
        """Colour and opacity of the kinds that are to be seen."""
        looks = {}
        for kind in KINDS:
            show, color, alpha = (
                getattr(self, name) for name in (f"show_{kind}", f"{kind}_color", f"{kind}_alpha")
            )
            if show and alpha > 0:
                looks[kind] = color, alpha
        return looks


def _fault_of(message: Any) -> str:
    """Return why a voxel grid cannot be drawn, "" if it can."""
    shape = message.size_x, message.size_y, message.size_z
    if len(message.data) != message.size_x * message.size_y:
        return (
            f"The size is {shape[0]} x {shape[1]} columns, but the data has {len(message.data)}. "
            "Fix the publisher."
        )
    if not all(shape) or message.size_z > MAX_LEVELS:
        return (
            f"The size is {shape[0]} x {shape[1]} x {shape[2]} voxels; each must be at least 1 "
            f"and the last at most {MAX_LEVELS}. Fix the publisher."
        )
    size = message.resolutions
    for length, count in zip((size.x, size.y, size.z), shape, strict=True):
        if not 0 < length * count < FARTHEST:
            return f"The voxels are {size.x:g} m x {size.y:g} m x {size.z:g} m. Fix the publisher."
    if not all(abs(metres) < FARTHEST for metres in _corner(message)):
        return "The origin is not finite or farther than 1e9 m. Fix the publisher."
    return ""


def _add(
    kind: str, cells: Cells, message: Any, color: Rgb, alpha: float, group: Group, ctx: Context
) -> bool:
    """Draw the cells of a kind that are not enclosed by others of it; whether there are any."""
    ids = np.flatnonzero(cells & ~_is_enclosed(cells))
    if len(ids) > MAX_VOXELS:
        ctx.warn("Limit", f"Showing {MAX_VOXELS} of {len(ids)} {kind} voxels, evenly picked.")
        ids = ids[evenly(len(ids), MAX_VOXELS)]
    if len(ids):
        size = message.resolutions
        group.instances(
            kind, "box", _centers(ids, message), (size.x, size.y, size.z), color,
            opacity=alpha, is_data=True, ids=ids,
        )  # fmt: skip
    return len(ids) > 0


def _is_enclosed(cells: Cells) -> Cells:
    """Return the mask of cells with all six neighbours."""
    enclosed = np.zeros_like(cells)
    inner = cells[1:-1, 1:-1, 1:-1]
    enclosed[1:-1, 1:-1, 1:-1] = inner
    for axis in range(3):
        for first in (0, 2):
            place = [slice(1, -1)] * 3
            place[axis] = slice(first, cells.shape[axis] - 2 + first)
            enclosed[1:-1, 1:-1, 1:-1] &= cells[tuple(place)]
    return enclosed


def _indices(ids: NDArray[np.intp], message: Any) -> NDArray[np.intp]:
    """Numbers (N, 3) of voxels along x, y and z."""
    shape = message.size_y, message.size_x, message.size_z
    y, x, z = np.unravel_index(ids, shape)
    return np.stack((x, y, z), axis=1)


def _centers(ids: NDArray[np.intp], message: Any) -> NDArray[np.float64]:
    """Centres (N, 3) in metres from the origin of the grid."""
    size = message.resolutions
    return np.multiply(_indices(ids, message) + 0.5, (size.x, size.y, size.z), dtype=np.float64)


def _corner(message: Any) -> tuple[float, float, float]:
    return message.origin.x, message.origin.y, message.origin.z
