"""Markers that consist of solids: boxes, spheres, cylinders, arrows, and lists of them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

import msgspec
import numpy as np
from msgspec.structs import replace
from numpy.typing import NDArray

from webviz import Instances, Node, Rgb, Shape, Solid
from webviz.data.messages.markers import Marker
from webviz.data.rotations import matrices, multiply_many
from webviz_displays.markers.batch import F32, F64, MarkerBatch, Rows, opacities, rgb
from webviz_displays.markers.items import items_of
from webviz_displays.shared.rods import from_z

HEAD_SHARE = 0.23
"""Share of the head in the length of an arrow that does not give it, as in RViz."""
STRIP_HEAD_SHARE = 0.25
"""The same of the arrows of an ARROW_STRIP, of which RViz's proposal has shaft : head = 3 : 1."""
SEPARATE_OPACITIES = 8
"""Nodes of one opacity each are drawn faster than one node with one for each instance."""

_SHAPES: Mapping[int, Solid] = {
    Marker.CUBE: "box",
    Marker.SPHERE: "sphere",
    Marker.CYLINDER: "cylinder",
}
_LISTS: Mapping[int, Solid] = {Marker.CUBE_LIST: "box", Marker.SPHERE_LIST: "sphere"}
_X_TO_Y_TO_Z = np.full(4, 0.5)
"""Turns z to x, x to y and y to z."""
_HALF_ABOUT_X = np.array((0.0, 1.0, 0.0, 0.0))


class Solids(msgspec.Struct, frozen=True, eq=False):
    """Solids of one shape.

    Args:
        shape: of all.
        positions: float64 (N, 3), centres, metres.
        wxyzs: float64 (N, 4).
        scales: float64 (N, 3), extents.
        colors: float32 (N, 4), RGBA.
        ids: (N,), of the markers that they belong to.
        is_data: whether they are shaded as the points of a cloud.
        mesh: the name of a shape that is no solid.
    """

    shape: Solid | Shape
    positions: F64
    wxyzs: F64
    scales: F64
    colors: F32
    ids: NDArray[np.int64]
    is_data: bool = False
    mesh: str = ""

    @property
    def name(self) -> str:
        """Name of the shape."""
        return self.shape if isinstance(self.shape, str) else self.mesh

    def only(self, rows: NDArray[np.bool_]) -> Solids:
        """Return some of the solids."""
        if rows.all():
            return self
        return replace(self, **{name: getattr(self, name)[rows] for name in _ARRAYS})


_ARRAYS = ("positions", "wxyzs", "scales", "colors", "ids")


def solids_of(batch: MarkerBatch) -> Iterator[Solids]:
    """Yield the solids of all markers that consist of them."""
    for type_, shape in _SHAPES.items():
        some = batch.only(np.flatnonzero(batch.types == type_))
        if len(some):
            scales = np.abs(some.scales)
            yield Solids(shape, some.positions, some.wxyzs, scales, some.colors, some.ids)
    yield from _lists(batch)
    yield from _arrows(batch)


def instances_of(solids: Iterable[Solids]) -> dict[str, Node]:
    """Return as few nodes as possible for solids."""
    alike: dict[tuple[Solid | Shape, bool], list[Solids]] = {}
    for each in solids:
        alike.setdefault((each.shape, each.is_data), []).append(each)
    nodes: dict[str, Node] = {}
    for (_, is_data), some in alike.items():
        name = f"{some[0].name} data" if is_data else some[0].name
        for key, part, opacity in _by_opacity(some, name):
            nodes[key] = _instances(part, opacity)
    return nodes


def _by_opacity(some: list[Solids], key: str) -> Iterator[tuple[str, Solids, float | F64]]:
    """Solids of one shape by their opacity; invisible ones are left out."""
    whole = some[0]
    if len(some) > 1:
        arrays = {name: np.concatenate([getattr(s, name) for s in some]) for name in _ARRAYS}
        whole = replace(whole, **arrays)
    opacity = opacities(whole.colors[:, 3])
    values = np.unique(opacity[opacity > 0.0])
    if len(values) > SEPARATE_OPACITIES:
        is_opaque = opacity == 1.0
        if is_opaque.any():
            yield key, whole.only(is_opaque), 1.0
        is_clear = (opacity > 0.0) & ~is_opaque
        yield f"{key} transparent", whole.only(is_clear), opacity[is_clear]
        return
    for value in values.tolist():
        name = key if value == 1.0 else f"{key} {value:.3f}"
        yield name, whole.only(opacity == value), value


def _instances(solids: Solids, opacity: float | F64) -> Instances:
    colors = rgb(solids.colors)
    one: Rgb | None = None
    if len(colors) and (colors == colors[0]).all():
        one = tuple(colors[0].tolist())
    return Instances(
        solids.positions.astype(np.float32),
        solids.scales.astype(np.float32),
        colors if one is None else one,
        solids.shape,
        solids.wxyzs.astype(np.float32),
        opacity.astype(np.float32) if isinstance(opacity, np.ndarray) else opacity,
        solids.is_data,
        solids.ids,
    )


def _lists(batch: MarkerBatch) -> Iterator[Solids]:
    for type_, shape in _LISTS.items():
        rows = np.flatnonzero(batch.types == type_)
        if not len(rows):
            continue
        items = items_of(batch, rows)
        of = items.rows
        scales = np.abs(batch.scales[of])
        where = items.xyz, batch.wxyzs[of]
        colors = np.broadcast_to(items.colors, (len(of), 4))
        yield Solids(shape, *where, scales, colors, batch.ids[of], is_data=True)


def _arrows(batch: MarkerBatch) -> Iterator[Solids]:
    is_arrow, counts = batch.types == Marker.ARROW, batch.counts
    along_x = np.flatnonzero(is_arrow & (counts != 1) & (counts != 2))
    if len(along_x):
        yield from _arrows_along_x(batch.only(along_x))
    is_strip = batch.types == Marker.ARROW_STRIP
    joined = np.flatnonzero((is_arrow & (counts == 2)) | (is_strip & (counts > 1)))
    if len(joined):
        yield from _arrows_between(batch, joined)


def _arrows_along_x(some: MarkerBatch) -> Iterator[Solids]:
    """Arrows from the origin of each pose: scale is length, and width of the shaft in y and z."""
    length, sign = np.abs(some.scales[:, 0]), np.sign(some.scales[:, 0])
    width = np.abs(some.scales[:, 1:])
    axis = matrices(some.wxyzs)[..., 0] * sign[:, None]
    turned = multiply_many(some.wxyzs, _X_TO_Y_TO_Z)
    if (sign < 0).any():
        turned = np.where(sign[:, None] < 0, multiply_many(turned, _HALF_ABOUT_X), turned)
    head = HEAD_SHARE * length
    shaft = length - head
    parts: tuple[tuple[Solid, F64, F64, F64], ...] = (
        ("cylinder", shaft / 2.0, shaft, width),
        ("cone", shaft + head / 2.0, head, 2.0 * width),
    )
    for shape, middle, extent, wide in parts:
        scales = np.column_stack((wide, extent))
        positions = some.positions + axis * middle[:, None]
        yield Solids(shape, positions, turned, scales, some.colors, some.ids)


def _arrows_between(batch: MarkerBatch, rows: Rows) -> Iterator[Solids]:
    """Arrows between points: scale is the diameters of shaft and head, and the head's length."""
    items = items_of(batch, rows)
    is_joined = items.rows[:-1] == items.rows[1:]
    tails, tips = items.xyz[:-1][is_joined], items.xyz[1:][is_joined]
    of = items.rows[:-1][is_joined]
    shaft_width, head_width, head_length = np.abs(batch.scales[of]).T
    ways = tips - tails
    length = np.linalg.norm(ways, axis=1)
    share = np.where(batch.types[of] == Marker.ARROW_STRIP, STRIP_HEAD_SHARE, HEAD_SHARE)
    head = np.minimum(np.where(head_length > 0.0, head_length, share * length), length)
    shaft = length - head
    axis = ways / np.where(length > 0.0, length, 1.0)[:, None]
    wxyzs = from_z(axis)
    parts: tuple[tuple[Solid, F64, F64, F64], ...] = (
        ("cylinder", shaft / 2.0, shaft, shaft_width),
        ("cone", shaft + head / 2.0, head, head_width),
    )
    for shape, middle, extent, width in parts:
        some = extent > 0.0
        scales = np.column_stack((width, width, extent))
        positions = tails + axis * middle[:, None]
        owners = of[some]
        colors, ids = batch.colors[owners], batch.ids[owners]
        yield Solids(shape, positions[some], wxyzs[some], scales[some], colors, ids)
