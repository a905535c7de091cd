"""Nodes of markers: those that look alike share one."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz import Labels, Lines, Node, Points, Rgb
from webviz.data.messages.markers import Marker
from webviz_displays.markers.batch import U8, MarkerBatch, Rows, opacities, rgb
from webviz_displays.markers.items import items_of
from webviz_displays.markers.meshes import LoadedMesh, mesh_solids, models_of
from webviz_displays.markers.solids import instances_of, solids_of
from webviz_displays.markers.triangles import triangles_of
from webviz_displays.shared.colors import layers


@dataclass(frozen=True)
class Files:
    """Files used by markers, by the row of the marker in its batch.

    Args:
        meshes: of MESH_RESOURCE; a marker without one is not drawn.
        pictures: PNG or JPEG, of TRIANGLE_LIST.
    """

    meshes: Mapping[int, LoadedMesh] = field(default_factory=dict)
    pictures: Mapping[int, bytes] = field(default_factory=dict)


def nodes_of(batch: MarkerBatch, files: Files = Files()) -> dict[str, Node]:
    """Return the nodes that draw markers, in the coordinates of their group.

    Args:
        batch: such as from `batch_of`; markers that cannot be drawn are left out.
        files: what was loaded.
    """
    solids = itertools.chain(solids_of(batch), mesh_solids(batch, files.meshes))
    return {
        **instances_of(solids),
        **lines_of(batch),
        **points_of(batch),
        **texts_of(batch),
        **triangles_of(batch, files.pictures),
        **models_of(batch, files.meshes),
    }


def lines_of(batch: MarkerBatch) -> dict[str, Node]:
    """Return a node for the lines of each width and opacity."""
    widths, counts = batch.scales[:, 0], batch.counts
    is_list = (batch.types == Marker.LINE_LIST) & (counts % 2 == 0)
    is_line = is_list | (batch.types == Marker.LINE_STRIP)
    nodes: dict[str, Node] = {}
    for width, of_width in _by_value(widths, is_line & (counts > 1) & (widths > 0.0)):
        items = items_of(batch, np.flatnonzero(of_width))
        ends_of = _pairing(items.rows, is_list[items.rows])
        colors = ends_of(items.colors) if len(items.colors) > 1 else items.colors[None]
        # A node has one opacity: that of a segment is the mean of its ends.
        alphas = opacities(colors[..., 3]).mean(axis=1)
        levels = np.ceil(255 * alphas - 1e-3).astype(np.uint8)
        for level in np.unique(levels[levels > 0]).tolist():
            chosen = slice(None) if (levels == level).all() else levels == level
            xyz = ends_of(items.xyz)[chosen].astype(np.float32)
            ids = batch.ids[ends_of(items.rows)[chosen, 0]]
            key = f"lines {width:.6g}" + (f" {level}" if level < 255 else "")
            nodes[key] = Lines(xyz, _one(rgb(colors[chosen])), width, "m", ids, level / 255)
    return nodes


def _pairing(rows: Rows, is_list: NDArray[np.bool_]) -> Callable[[NDArray[Any]], NDArray[Any]]:
    """Return a function that makes segment ends (S, 2, ...) from values (M, ...) of points.

    Args:
        rows: (M,), the marker of each point.
        is_list: (M,), whether that is a LINE_LIST, not a LINE_STRIP.
    """
    if is_list.all():
        return lambda values: values.reshape(-1, 2, *values.shape[1:])
    is_first = np.r_[True, rows[1:] != rows[:-1]]
    starts = np.flatnonzero(is_first)
    number = np.arange(len(rows)) - np.repeat(starts, np.diff(np.r_[starts, len(rows)]))
    firsts = np.flatnonzero(~is_first[1:] & ~(is_list & (number % 2 == 1))[:-1])
    return lambda values: np.stack((values[firsts], values[firsts + 1]), axis=1)


def points_of(batch: MarkerBatch) -> dict[str, Node]:
    """Return a node for the points of each size and opacity."""
    sizes = batch.scales[:, 0]
    nodes: dict[str, Node] = {}
    is_list = (batch.types == Marker.POINTS) & (batch.counts > 0)
    for size, of_size in _by_value(sizes, is_list & (sizes > 0.0)):
        items = items_of(batch, np.flatnonzero(of_size))
        for opacity, alike in layers(opacities(items.colors[:, 3])):
            chosen = alike if len(items.colors) > 1 else slice(None)  # one colour is that of all
            xyz, ids = items.xyz[chosen].astype(np.float32), batch.ids[items.rows[chosen]]
            colors = _one(rgb(items.colors[alike]))
            key = _key("points", size, opacity)
            nodes[key] = Points(xyz, colors, size, "square", ids, opacity=opacity)
    return nodes


def texts_of(batch: MarkerBatch) -> dict[str, Node]:
    """Return a node for the texts of each height and opacity.

    Texts face the camera whatever their orientation is.
    """
    heights = batch.scales[:, 2]
    is_visible = (batch.types == Marker.TEXT_VIEW_FACING) & (batch.colors[:, 3] > 0.0)
    is_visible &= heights > 0.0
    is_visible[is_visible] = [
        bool(batch.contents[row].text.strip()) for row in np.flatnonzero(is_visible).tolist()
    ]
    nodes: dict[str, Node] = {}
    for height, some in _by_value(heights, is_visible):
        # Labels have four steps of opacity, of which the nearest is drawn.
        nearest = np.maximum(np.round(4.0 * opacities(batch.colors[:, 3])), 1.0) / 4.0
        steps = np.where(some, nearest, 0.0)
        for opacity, chosen in layers(steps):
            rows = np.flatnonzero(chosen)
            nodes[_key("texts", height, opacity)] = Labels(
                batch.positions[rows].astype(np.float32),
                tuple(batch.contents[row].text for row in rows.tolist()),
                height,
                colors=_one(rgb(batch.colors[rows])),
                ids=batch.ids[rows],
                opacity=opacity,
            )
    return nodes


def _by_value(
    values: NDArray[np.float64], among: NDArray[np.bool_]
) -> Iterator[tuple[float, NDArray[np.bool_]]]:
    """Each value, with the rows that have it."""
    for value in np.unique(values[among]).tolist():
        yield value, among & (values == value)


def _key(kind: str, size: float, opacity: float) -> str:
    return f"{kind} {size:.6g}" + (f" {round(255 * opacity)}" if opacity < 1.0 else "")


def _one(colors: U8) -> U8 | Rgb:
    """Return the colour of all if colours (..., 3) are equal, else the colours."""
    flat = colors.reshape(-1, 3)
    if (flat == flat[0]).all():
        red, green, blue = flat[0].tolist()
        return red, green, blue
    return colors
