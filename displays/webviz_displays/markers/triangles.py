"""Markers of type TRIANGLE_LIST."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

from webviz import Glb, Mesh, Node
from webviz.data.messages.markers import Content, Marker
from webviz_displays.markers.batch import F32, U8, MarkerBatch, Rows, opacities, rgb
from webviz_displays.markers.items import items_of
from webviz_urdf import MeshPart, Surface, write_glb

WHITE = (255, 255, 255)
OneColor = tuple[int, int, int, float]


def triangles_of(batch: MarkerBatch, pictures: Mapping[int, bytes]) -> dict[str, Node]:
    """Return a node for the triangles of each colour, of several colours, and of each texture.

    Args:
        batch: the markers.
        pictures: PNG or JPEG by the row of the marker that it covers.
    """
    plain: dict[OneColor, list[int]] = {}
    colorful: dict[bool, list[int]] = {}
    nodes: dict[str, Node] = {}
    for row in np.flatnonzero(batch.types == Marker.TRIANGLE_LIST).tolist():
        content = batch.contents[row]
        if not len(content.points) or len(content.points) % 3:
            continue
        colors = corner_colors(content)
        if row in pictures:
            if colors is None or colors[:, 3].any():
                nodes[f"triangles {batch.ids[row]}"] = Glb(_covered(batch, row, pictures[row]))
        elif colors is not None:
            is_clear = bool((opacities(colors[:, 3]) < 1.0).any())
            colorful.setdefault(is_clear, []).append(row)
        elif (opacity := float(opacities(batch.colors[row, 3]))) > 0.0:
            red, green, blue = rgb(batch.colors[row]).tolist()
            plain.setdefault((red, green, blue, opacity), []).append(row)
    for (*color, opacity), rows in plain.items():
        vertices, faces, ids = _joined(batch, rows)
        if opacity < 1.0:  # transparent meshes show their front only
            faces = np.concatenate((faces, faces[:, ::-1] + np.uint32(len(vertices))))
            vertices = np.concatenate((vertices, vertices))
            ids = np.concatenate((ids, ids))
        red, green, blue = color
        nodes[f"triangles {red} {green} {blue} {opacity:.3f}"] = Mesh(
            vertices, faces, (red, green, blue), opacity, ids
        )
    for is_clear, rows in colorful.items():
        vertices, faces, ids = _joined(batch, rows)
        rgba = np.concatenate([_rgba(batch.contents[row]) for row in rows])
        if is_clear:
            is_visible = rgba[faces, 3].any(axis=1)
            faces, ids = faces[is_visible], ids[is_visible]
        if len(faces):
            key = "clear triangles" if is_clear else "colorful triangles"
            nodes[key] = Mesh(vertices, faces, WHITE, ids=ids, colors=rgba)
    return nodes


def corner_colors(content: Content) -> F32 | None:
    """Return the colour of each corner (N, 4), None if the triangles have one colour."""
    corners, color_count = len(content.points), len(content.colors)
    if color_count and color_count == corners:
        return content.colors
    return (
        np.repeat(content.colors, 3, axis=0) if color_count and 3 * color_count == corners else None
    )


def _joined(
    batch: MarkerBatch, rows: list[int]
) -> tuple[F32, NDArray[np.uint32], NDArray[np.int64]]:
    """Return the corners of all triangles (N, 3), the faces (M, 3), and the marker of each (M,)."""
    vertices = _corners(batch, np.array(rows))
    faces = np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3)
    return vertices, faces, np.repeat(batch.ids[rows], batch.counts[rows] // 3)


def _corners(batch: MarkerBatch, rows: Rows) -> F32:
    """Return the corners of all triangles, float32 (N, 3)."""
    scaled = [batch.contents[row].points * batch.scales[row] for row in rows.tolist()]
    return items_of(batch, rows, scaled).xyz.astype(np.float32)


def _rgba(content: Content) -> U8:
    """Return the colour of each corner, uint8 (N, 4)."""
    colors = corner_colors(content)
    assert colors is not None
    alphas = np.rint(255.0 * opacities(colors[:, 3])).astype(np.uint8)
    return np.column_stack((rgb(colors), alphas))


def _covered(batch: MarkerBatch, row: int, picture: bytes) -> bytes:
    """Return a binary glTF of triangles with a picture, multiplied by their colours."""
    vertices, faces, _ = _joined(batch, [row])
    content = batch.contents[row]
    uvs = content.uv_coordinates
    if corner_colors(content) is not None:
        surface = Surface(texture=picture, is_clear=True)
        return write_glb([MeshPart(vertices, faces, surface, None, uvs, _rgba(content))])
    red, green, blue = (rgb(batch.colors[row]) / 255.0).tolist()
    rgba = (red, green, blue, float(opacities(batch.colors[row, 3])))
    return write_glb([MeshPart(vertices, faces, Surface(rgba, picture, is_clear=True), None, uvs)])
