"""Markers that consist of lines, points or texts."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from webviz import Labels, Lines, Node, Points, Rgb
from webviz.data.messages.markers import Marker
from webviz_displays.markers.batch import F32, U8, Batch, opacities, rgb
from webviz_displays.markers.items import items_of
from webviz_displays.shared.colors import faded


def lines_of(batch: Batch) -> dict[str, Node]:
    """A node for the lines of each width."""
    is_strip = (batch.types == Marker.LINE_STRIP) & (batch.scales[:, 0] > 0.0)
    counts = np.array([len(content.points) for content in batch.contents], np.intp)
    is_list = (batch.types == Marker.LINE_LIST) & (batch.scales[:, 0] > 0.0) & (counts % 2 == 0)
    strips = items_of(batch, np.flatnonzero(is_strip))
    pairs = items_of(batch, np.flatnonzero(is_list))
    is_joined = np.flatnonzero(strips.rows[:-1] == strips.rows[1:])
    starts, ends = strips.only(is_joined), strips.only(is_joined + 1)
    firsts, seconds = pairs.only(slice(None, None, 2)), pairs.only(slice(1, None, 2))
    segments = np.concatenate(
        (
            np.stack((starts.xyz, ends.xyz), axis=1),
            np.stack((firsts.xyz, seconds.xyz), axis=1),
        )
    )
    colors = np.concatenate(
        (
            np.stack((starts.colors, ends.colors), axis=1),
            np.stack((firsts.colors, seconds.colors), axis=1),
        )
    )
    rows = np.concatenate((starts.rows, firsts.rows))
    is_visible = colors[..., 3].max(axis=1, initial=0.0) > 0.0
    nodes: dict[str, Node] = {}
    for width, some in _by_value(batch.scales[rows, 0], is_visible):
        xyz = segments[some].astype(np.float32)
        ids = batch.ids[rows[some]]
        nodes[f"lines {width:.6g}"] = Lines(xyz, _opaque(colors[some]), width, "m", ids)
    return nodes


def points_of(batch: Batch) -> dict[str, Node]:
    """A node for the points of each size."""
    items = items_of(batch, np.flatnonzero(batch.types == Marker.POINTS))
    sizes = batch.scales[items.rows, 0]
    nodes: dict[str, Node] = {}
    for size, some in _by_value(sizes, (items.colors[:, 3] > 0.0) & (sizes > 0.0)):
        xyz = items.xyz[some].astype(np.float32)
        ids = batch.ids[items.rows[some]]
        nodes[f"points {size:.6g}"] = Points(xyz, _opaque(items.colors[some]), size, "square", ids)
    return nodes


def texts_of(batch: Batch) -> dict[str, Node]:
    """A node for the texts of each height; texts face the camera whatever their orientation is."""
    heights = batch.scales[:, 2]
    is_visible = (batch.types == Marker.TEXT_VIEW_FACING) & (batch.colors[:, 3] > 0.0)
    is_visible &= heights > 0.0
    is_visible[is_visible] = [
        bool(batch.contents[row].text.strip()) for row in np.flatnonzero(is_visible).tolist()
    ]
    nodes: dict[str, Node] = {}
    for height, some in _by_value(heights, is_visible):
        texts = tuple(batch.contents[row].text for row in np.flatnonzero(some).tolist())
        positions = batch.positions[some].astype(np.float32)
        colors = _opaque(batch.colors[some])
        nodes[f"texts {height:.6g}"] = Labels(positions, texts, height, colors=colors)
    return nodes


def _by_value(
    values: NDArray[np.float64], among: NDArray[np.bool_]
) -> Iterator[tuple[float, NDArray[np.bool_]]]:
    """Each value, with the rows that have it."""
    for value in np.unique(values[among]).tolist():
        yield value, among & (values == value)


def _opaque(colors: F32) -> U8 | Rgb:
    """Colours (..., 4) blended with the background by their alpha; one if all are equal."""
    flat = colors.reshape(-1, 4)
    if (flat == flat[0]).all():
        red, green, blue = _mixed(flat[:1])[0].tolist()
        return red, green, blue
    return _mixed(colors)


def _mixed(colors: F32) -> U8:
    return faded(rgb(colors), opacities(colors[..., 3])[..., None])
