"""Markers of type TRIANGLE_LIST."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from webviz import Glb, Mesh, Node
from webviz.data.messages.markers import Content, Marker
from webviz_displays.markers.batch import F32, Batch, Rows, opacities, rgb
from webviz_displays.markers.items import items_of
from webviz_urdf import MeshPart, Surface, write_glb

OneColor = tuple[int, int, int, float]


def triangles_of(batch: Batch, pictures: Mapping[int, bytes]) -> dict[str, Node]:
    """A node for the triangles of each colour, and one for each marker with several.

    Args:
        batch: the markers.
        pictures: PNG or JPEG by the row of the marker that it covers.
    """
    plain: dict[OneColor, list[int]] = {}
    nodes: dict[str, Node] = {}
    for row in np.flatnonzero(batch.types == Marker.TRIANGLE_LIST).tolist():
        content = batch.contents[row]
        if not len(content.points) or len(content.points) % 3:
            continue
        colors = corner_colors(content)
        if colors is None and row not in pictures:
            opacity = float(opacities(batch.colors[row, 3]))
            red, green, blue = rgb(batch.colors[row]).tolist()
            if opacity > 0.0:
                plain.setdefault((red, green, blue, opacity), []).append(row)
        elif colors is None or colors[:, 3].any():
            key = f"triangles {batch.ids[row]}"
            nodes[key] = Glb(_many_colors(batch, row, colors, pictures.get(row)))
    for (*color, opacity), rows in plain.items():
        vertices = _corners(batch, np.array(rows))
        faces = np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3)
        ids = np.repeat(batch.ids[rows], [len(batch.contents[row].points) // 3 for row in rows])
        if opacity < 1.0:  # transparent meshes show their front only
            faces = np.concatenate((faces, faces[:, ::-1] + np.uint32(len(vertices))))
            vertices = np.concatenate((vertices, vertices))
            ids = np.concatenate((ids, ids))
        red, green, blue = color
        nodes[f"triangles {red} {green} {blue} {opacity:.3f}"] = Mesh(
            vertices, faces, (red, green, blue), opacity, ids
        )
    return nodes


def corner_colors(content: Content) -> F32 | None:
    """The colour of each corner (N, 4), None if the triangles have one colour."""
    corners, given = len(content.points), len(content.colors)
    if given and given == corners:
        return content.colors
    return np.repeat(content.colors, 3, axis=0) if given and 3 * given == corners else None


def _corners(batch: Batch, rows: Rows) -> F32:
    """The corners of all triangles, float32 (N, 3)."""
    scaled = [batch.contents[row].points * batch.scales[row] for row in rows.tolist()]
    return items_of(batch, rows, scaled).xyz.astype(np.float32)


def _many_colors(batch: Batch, row: int, colors: F32 | None, picture: bytes | None) -> bytes:
    """A binary glTF of triangles with a colour for each corner, a picture, or both."""
    vertices = _corners(batch, np.array([row]))
    faces = np.arange(len(vertices), dtype=np.uint32).reshape(-1, 3)
    uvs = None if picture is None else batch.contents[row].uv_coordinates
    if colors is not None:
        alphas = np.rint(255.0 * opacities(colors[:, 3])).astype(np.uint8)
        surface = Surface(texture=picture, is_clear=bool(alphas.min() < 255) or picture is not None)
        corners = np.column_stack((rgb(colors), alphas))
        return write_glb([MeshPart(vertices, faces, surface, None, uvs, corners)])
    red, green, blue = (rgb(batch.colors[row]) / 255.0).tolist()
    rgba = (red, green, blue, float(opacities(batch.colors[row, 3])))
    return write_glb([MeshPart(vertices, faces, Surface(rgba, picture, is_clear=True), None, uvs)])
