"""Marker and MarkerArray as people see them."""

from __future__ import annotations

import io
import math
from collections.abc import Callable
from typing import Any

import numpy as np
import trimesh
from marker_fields import colors, named, points
from PIL import Image
from trimesh.visual import ColorVisuals

from webviz.api.views import Orbit
from webviz.shell.testing import Harness
from webviz_displays.grid import Grid
from webviz_displays.markers import Marker, MarkerArray

Stages = Callable[..., Harness]

VIEW = Orbit(distance=6.0, yaw=-math.pi / 2, pitch=0.75)
TURN = {"z": math.sin(0.2), "w": math.cos(0.2)}
ARROW, CUBE, SPHERE, CYLINDER, STRIP, LINES, CUBES, SPHERES, POINTS, TEXT, MESH, TRIANGLES = range(
    12
)
ARROWS = 12


def marker(type_: int, x: float, y: float, scale: Any, rgba: Any, **more: Any) -> dict[str, Any]:
    return {
        "header": {"frame_id": "map"},
        "ns": "all",
        "id": round(100 * x + 7 * y) + 1000 * type_,
        "type": type_,
        "pose": {"position": {"x": x, "y": y, "z": 0.3}, "orientation": TURN},
        "scale": named("xyz", scale),
        "color": named("rgba", rgba),
        **more,
    }


ZIGZAG = points((0, 0, 0), (0.3, 0.5, 0), (0.6, 0, 0), (0.9, 0.5, 0.2))
RAINBOW = colors((1, 0, 0, 1), (1, 1, 0, 1), (0, 1, 0, 1), (0.2, 0.4, 1, 1))


def test_shapes_and_arrows(webviz_harness: Stages) -> None:
    harness = webviz_harness(Marker(), Grid(plane_cell_count=6), view=VIEW)
    harness.transform("map", "elsewhere")
    for y, alpha in ((1.2, 1.0), (0.0, 0.4)):
        for x, type_, scale, rgb in (
            (-2.2, ARROW, (0.9, 0.15, 0.25), (1, 0, 0)),
            (-0.8, CUBE, (0.8, 0.5, 0.4), (1, 0.6, 0)),
            (0.6, SPHERE, (0.8, 0.5, 0.5), (0, 1, 0)),
            (2.0, CYLINDER, (0.6, 0.6, 0.8), (0.2, 0.4, 1)),
        ):
            shape = marker(type_, x, y, scale, (*rgb, alpha))
            harness.publish("/visualization_marker", "visualization_msgs/msg/Marker", shape)
    way = points((0, 0, 0), (1.2, 0.2, 0))
    for each in (
        marker(ARROW, -2.4, -1.4, (0.08, 0.25, 0), (0, 1, 1, 1), points=way),
        marker(ARROWS, -0.6, -1.4, (0.06, 0.15, 0.2), (1, 0, 1, 1), points=ZIGZAG),
        marker(STRIP, 0.8, -1.4, (0.06, 0, 0), (1, 1, 1, 1), points=ZIGZAG, colors=RAINBOW),
        marker(TEXT, 2.2, -1.2, (0, 0, 0.3), (1, 1, 0, 1), text="two\nlines"),
    ):
        harness.publish("/visualization_marker", "visualization_msgs/msg/Marker", each)
    harness.turn()
    harness.check_picture("marker/default")


def test_lists_meshes_and_textures(webviz_harness: Stages) -> None:
    harness = webviz_harness(MarkerArray(), Grid(plane_cell_count=6), view=VIEW)
    harness.transform("map", "elsewhere")
    fading = colors(*((1, 1, 0, 1 - 0.25 * i) for i in range(4)))
    lists = [
        marker(type_, x, y, scale, (1, 0.4, 0, 1), points=ZIGZAG, colors=each)
        for x, type_, scale in (
            (-2.7, LINES, (0.06, 0, 0)),
            (-1.3, CUBES, (0.2, 0.3, 0.1)),
            (0.1, SPHERES, (0.25, 0.25, 0.25)),
            (1.5, POINTS, (0.15, 0.15, 0)),
        )
        for y, each in ((1.4, RAINBOW), (0.4, fading))
    ]
    ring = [(math.cos(a), math.sin(a), 0.0) for a in np.linspace(0, 2 * math.pi, 7)]
    fan = [corner for i in range(6) for corner in ((0, 0, 0.5), ring[i], ring[i + 1])]
    hues = [RAINBOW[i % 4] for i in range(18)]
    square = points((0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 0), (1, 0, 1), (0, 0, 1))
    uvs = [{"u": float(p["x"]), "v": float(p["z"])} for p in square]
    board = Image.fromarray((np.indices((4, 4)).sum(axis=0) % 2 * 255).astype(np.uint8))
    png = io.BytesIO()
    board.resize((64, 64), Image.Resampling.NEAREST).convert("RGB").save(png, "PNG")
    ball = trimesh.creation.annulus(0.2, 0.4, 0.3)
    own = trimesh.creation.box((0.6, 0.6, 0.4))
    faces = np.repeat([(255, 80, 80), (80, 255, 80), (80, 80, 255)], 4, axis=0)
    own.visual = ColorVisuals(own, face_colors=faces)

    def file(mesh: Any, kind: str) -> dict[str, Any]:
        data = mesh.export(file_type=kind)
        name = f"part.{kind}"
        return {
            "mesh_resource": f"embedded://{name}",
            "mesh_file": {"filename": name, "data": data},
        }

    meshes = [
        marker(TRIANGLES, -2.4, -0.8, (0.5, 0.5, 0.5), (0, 1, 1, 0.6), points=points(*fan)),
        marker(
            TRIANGLES, -1.2, -0.8, (0.5, 0.5, 0.5), (1, 1, 1, 1), points=points(*fan), colors=hues
        ),
        marker(
            TRIANGLES,
            -0.5,
            -1.0,
            (1, 1, 1),
            (1, 1, 1, 1),
            points=square,
            uv_coordinates=uvs,
            texture_resource="embedded://board.png",
            texture={"format": "png", "data": png.getvalue()},
        ),
        marker(MESH, 1.2, -1.0, (1, 1, 1), (1, 0.5, 0, 1), **file(ball, "stl")),
        marker(
            MESH,
            2.3,
            -1.0,
            (1, 1, 1.5),
            (0, 0, 0, 0),
            mesh_use_embedded_materials=True,
            **file(own, "glb"),
        ),
    ]
    array = {"markers": [*lists, *meshes]}
    harness.publish("/visualization_marker_array", "visualization_msgs/msg/MarkerArray", array)
    harness.settle()
    harness.check_picture("marker_array/default")
