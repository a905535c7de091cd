"""Primitives in a real browser: right thing, place and colour."""

from __future__ import annotations

import io
import json
import math
import struct
from dataclasses import replace
from typing import Any, Literal

import numpy as np
import PIL.Image
import pytest

from tests.scene.conftest import View, floats
from webviz.api.nodes import (
    Arrows,
    Axes,
    Glb,
    Image,
    Labels,
    Lines,
    Mesh,
    Node,
    Points,
    Pose,
    Rgb,
)
from webviz.scene import set_background
from webviz.scene.points import PART
from webviz.scene.schemes import BACKGROUND
from webviz_urdf.glb import MeshPart, Surface, write_glb

COLOR = (200, 100, 50)
RED, GREEN, BLUE = (255, 0, 0), (0, 255, 0), (0, 0, 255)


@pytest.fixture(scope="package")
def tab(still: View) -> View:
    """None of these ask what is seen while something changes."""
    return still


def square(size: float) -> tuple[np.ndarray, np.ndarray]:
    """Corners and faces of a square around the origin that faces up."""
    h = size / 2
    corners = floats((-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0))
    return corners, np.array([[0, 1, 2], [0, 2, 3]], dtype=np.uint32)


def glb(size: float, color: Rgb, **extensions: Any) -> bytes:
    """A square of one colour as binary glTF that does not say whether it is metal."""
    corners, faces = square(size)
    data = corners.tobytes() + faces.tobytes()
    linear = [*(((c / 255 + 0.055) / 1.055) ** 2.4 for c in color), 1.0]
    content = {
        "asset": {"version": "2.0"},
        "extensionsUsed": list(extensions),
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "materials": [
            {
                "pbrMetallicRoughness": {"baseColorFactor": linear},
                "extensions": extensions,
            }
        ],
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": 0, "byteLength": 48},
            {"buffer": 0, "byteOffset": 48, "byteLength": 24},
        ],
        "accessors": [
            {
                "bufferView": 0,
                "componentType": 5126,
                "count": 4,
                "type": "VEC3",
                "min": corners.min(0).tolist(),
                "max": corners.max(0).tolist(),
            },
            {"bufferView": 1, "componentType": 5125, "count": 6, "type": "SCALAR"},
        ],
    }
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    return (
        struct.pack("<4sII", b"glTF", 2, 12 + 8 + len(text) + 8 + len(data))
        + struct.pack("<I4s", len(text), b"JSON")
        + text
        + struct.pack("<I4s", len(data), b"BIN\0")
        + data
    )


# Each covers the origin; then how far its colour may be off (light on a surface that faces up).
COLORED: dict[str, tuple[Node, int]] = {
    "points of one colour": (Points(floats((0, 0, 0), (1, 0, 0)), COLOR, 0.5), 0),
    "points of many colours": (
        Points(floats((0, 0, 0), (1, 0, 0)), np.array([COLOR, RED], np.uint8), 0.5),
        0,
    ),
    "round points": (Points(floats((0, 0, 0)), COLOR, 0.5, "circle"), 0),
    "lines in pixels": (Lines(floats(((-1, 0, 0), (1, 0, 0))), COLOR, 8.0), 0),
    "lines in metres": (Lines(floats(((-1, 0, 0), (1, 0, 0))), COLOR, 0.4, "m"), 0),
    "lines of many colours": (
        Lines(floats(((-1, 0, 0), (1, 0, 0))), np.array([[COLOR, COLOR]], np.uint8), 8.0),
        2,
    ),
    "arrows": (Arrows(floats(((-1, 0, 0), (1, 0, 0))), COLOR, 0.3, 0.5, 0.3), 12),
    "mesh": (Mesh(*square(1.0), COLOR), 2),
    "glb": (Glb(glb(1.0, COLOR)), 2),
    "unlit glb": (Glb(glb(1.0, COLOR, KHR_materials_unlit={})), 1),
    "image": (Image(np.full((4, 4, 4), (*COLOR, 255), np.uint8), 1.0, 1.0), 0),
}


@pytest.mark.parametrize(("node", "tolerance"), COLORED.values(), ids=COLORED)
def test_a_node_has_its_colour_where_its_group_stands(
    node: Node, tolerance: int, view: View
) -> None:
    place = (1.0, 0.5, 0.0)
    corner = (0.5, 0.0, 0.0)
    view.scene.set_pose("base_link", Pose(corner if isinstance(node, Image) else place))
    view.scene.upsert("base_link", "it", node)
    view.show()
    view.wait_for(lambda: view.draw(1) or view.color_at(place) != BACKGROUND)
    assert np.abs(np.subtract(view.color_at(place), COLOR)).max() <= tolerance
    assert view.color_at((-2.0, -1.0, 0.0)) == BACKGROUND


def test_axes_are_red_green_blue_along_x_y_z(view: View) -> None:
    turned = floats((np.sqrt(0.5), 0, 0, np.sqrt(0.5)))  # x along y
    view.scene.upsert("base_link", "axes", Axes(floats((0, 0, 0)), turned, 1.0, 0.2))
    view.show()
    assert np.argmax(view.color_at((0.0, 0.5, 0.0))) == 0
    assert np.argmax(view.color_at((-0.5, 0.0, 0.0))) == 1
    assert np.argmax(view.color_at((0.0, 0.0, 1.0))) == 2


XYZ = floats((0, 0, 0), (1, 0, 0), (2, 0, 0))


def test_labels_follow_their_texts_in_number_and_place(view: View) -> None:
    view.scene.upsert(
        "tf", "names", Labels(floats((0, 0, 0), (1, 0, 0), (2, 0, 0)), tuple("abc"), 0.5)
    )
    view.show()
    assert len(view.nodes() & {f"/webviz/tf/names/{i}" for i in range(9)}) == 3
    view.scene.upsert("tf", "names", Labels(floats((0, 1, 0)), ("d",), 0.5))
    view.show()
    assert len(view.nodes() & {f"/webviz/tf/names/{i}" for i in range(9)}) == 1
    assert view.color_at((2.0, 0.0, 0.0)) == BACKGROUND


@pytest.mark.parametrize(
    "node",
    [
        Points(floats((0, 0, np.nan), (0, 0, 0)), COLOR, 0.5),
        Lines(floats(((0, 0, np.nan), (1, 0, 0)), ((-1, 0, 0), (1, 0, 0))), COLOR, 8.0),
        Arrows(floats(((np.inf, 0, 0), (1, 0, 0)), ((-1, 0, 0), (1, 0, 0))), COLOR, 0.3, 0.5, 0.3),
        Mesh(
            np.concatenate([square(1.0)[0], floats((np.nan, 0, 0))]),
            np.concatenate([square(1.0)[1], np.array([[0, 1, 4]], np.uint32)]),
            COLOR,
        ),
    ],
    ids=lambda node: type(node).__name__,
)
def test_non_finite_items_are_dropped(node: Node, view: View) -> None:
    view.scene.upsert("base_link", "it", node)
    view.show()
    assert np.abs(np.subtract(view.color_at((0.0, 0.0, 0.0)), COLOR)).max() <= 12


@pytest.mark.parametrize("unit", ["px", "m"])
def test_transparent_lines_blend_with_the_background(unit: Literal["px", "m"], view: View) -> None:
    """Once, also in the bend of a line with a width in metres."""
    cells = np.full((2, 2, 4), (230, 240, 250, 128), np.uint8)
    width = 0.8 if unit == "m" else 40.0
    straight, corner = floats((-2, 0, 0), (0, 0, 0)), floats((0, 0, 0), (0, 2, 0))
    view.scene.set_pose("map", Pose((-0.5, -1.0, 0.0)))
    view.scene.upsert("map", "it", Image(cells, 3.0, 1.8))
    lines = Lines(np.stack((straight, corner)), COLOR, width, unit, opacity=0.25)
    view.scene.upsert("base_link", "it", lines)
    view.show()
    tile = (0.75, 0.5, 0.0)
    view.wait_for(lambda: view.draw(1) or view.color_at(tile) != BACKGROUND)
    empty, covered = (-1.5, 0.0, 0.0), (0.0, 0.7, 0.0)
    places = [empty, covered] + ([(0.25, -0.1, 0.0), (-0.1, 0.3, 0.0)] if unit == "m" else [])
    below = [BACKGROUND] + [view.color_at(tile)] * (len(places) - 1)
    for color, behind in zip(view.colors_at(*places), below, strict=True):
        assert color == near(0.25 * np.array(COLOR) + 0.75 * np.array(behind))
    view.scene.upsert("base_link", "it", replace(lines, opacity=1.0))
    view.show()
    assert view.color_at(covered) == COLOR


def test_translucent_points_blend_with_the_background(view: View) -> None:
    """Both the first points of a node and those after a change of its opacity."""
    sheet = Mesh(*square(1.0), (230, 240, 250), is_flat=True)
    view.scene.upsert("base_link", "sheet", sheet)
    points = Points(floats((0, 0, 0.1), (2, 0, 0.1)), COLOR, 0.6, opacity=0.25)
    view.scene.upsert("base_link", "it", points)
    on_sheet, beside = (0.1, 0.1, 0.1), (2.1, 0.1, 0.1)
    for opacity in (0.25, 1.0, 0.5):
        view.scene.upsert("base_link", "it", replace(points, opacity=opacity))
        view.show()
        for place, behind in ((on_sheet, (230, 240, 250)), (beside, BACKGROUND)):
            blended = opacity * np.array(COLOR) + (1 - opacity) * np.array(behind)
            assert view.color_at(place) == near(blended), (opacity, place)


@pytest.mark.parametrize("opacity", [1.0, 0.5], ids=["opaque", "transparent"])
@pytest.mark.parametrize("line_opacity", [1.0, 0.5], ids=["on a line", "on a faint line"])
def test_a_flat_mesh_has_its_colour_and_covers_lines_in_its_plane(
    opacity: float, line_opacity: float, view: View
) -> None:
    sheet = Mesh(*square(2.0), COLOR, opacity, is_flat=True)
    line = Lines(floats(((-2, 0, 0), (2, 0, 0))), RED, 8.0, opacity=line_opacity)
    view.scene.upsert("base_link", "line", line)
    view.scene.upsert("base_link", "sheet", sheet)
    behind = line_opacity * np.array(RED) + (1 - line_opacity) * np.array(BACKGROUND)
    for tilt, eye in ((0.0, (0.0, -0.01, 10.0)), (0.6, (-6.0, 0.0, 6.0))):
        wxyz = (math.cos(tilt / 2), math.sin(tilt / 2), 0.0, 0.0)
        view.scene.set_pose("base_link", Pose(wxyz=wxyz))
        view.look(eye, (0.0, 0.0, 0.0))
        assert view.color_at((1.5, 0.0, 0.0)) == near(behind)
        beside = (0.3, 0.5 * math.cos(tilt), 0.5 * math.sin(tilt))
        along = ((x, 0.0, 0.0) for x in np.linspace(-0.9, 0.9, 19).tolist())
        below = np.array([BACKGROUND] + [behind] * 19)
        blended = opacity * np.array(COLOR) + (1 - opacity) * below
        assert np.abs(view.colors_at(beside, *along) - blended).max() <= 2, tilt


def test_the_ends_of_a_line_in_metres_are_square_and_its_joints_mitred(view: View) -> None:
    straight, corner = floats((-2, 0, 0), (0, 0, 0)), floats((0, 0, 0), (0, 2, 0))
    view.scene.upsert("base_link", "it", Lines(np.stack((straight, corner)), COLOR, 0.8, "m"))
    view.show()
    inside = ((-1.9, 0.35, 0.0), (-1.9, -0.35, 0.0), (0.35, 1.9, 0.0), (0.35, -0.35, 0.0))
    outside = ((-2.1, 0.0, 0.0), (0.0, 2.1, 0.0), (0.45, -0.45, 0.0))
    assert view.colors_at(*inside, *outside) == [COLOR] * 4 + [BACKGROUND] * 3
    back = floats((0, 0, 0), (-2, 0.5, 0))
    view.scene.upsert("base_link", "it", Lines(np.stack((straight, back)), COLOR, 0.8, "m"))
    view.show()
    colors = view.colors_at((0.35, 0.0, 0.0), (0.35, -0.35, 0.0))
    assert colors == [COLOR, BACKGROUND]


EMPTY = np.zeros((0, 2, 3), np.float32)


@pytest.mark.parametrize(
    "node",
    [
        Points(EMPTY[:, 0], EMPTY[:, 0].astype(np.uint8), 0.1),
        Points(EMPTY[:, 0], COLOR, 0.1),
        Lines(EMPTY, EMPTY.astype(np.uint8)),
        Arrows(EMPTY, EMPTY[:, 0].astype(np.uint8), 0.1, 0.2, 0.3),
        Axes(EMPTY[:, 0], np.zeros((0, 4), np.float32), 1.0, 0.1),
        Labels(EMPTY[:, 0], (), 0.1),
        Mesh(EMPTY[:, 0], np.zeros((0, 3), np.uint32), COLOR),
        Image(np.zeros((0, 0, 4), np.uint8), 1.0, 1.0),
    ],
    ids=lambda node: type(node).__name__,
)
def test_nothing_can_be_drawn_too(node: Node, view: View) -> None:
    view.scene.upsert("base_link", "it", node)
    view.show()
    assert (view.pixels() == BACKGROUND).all()


def test_a_mesh_is_seen_from_below_and_never_black(view: View) -> None:
    view.scene.upsert("base_link", "it", Mesh(*square(1.0), COLOR))
    view.look((0.0, -0.01, -10.0), (0.0, 0.0, 0.0))
    red, green, blue = view.color_at((0.0, 0.0, 0.0))
    assert 100 < red <= 200
    assert blue < green < red


def test_colours_of_corners_and_ends_are_mixed_as_in_rviz(view: View) -> None:
    """Colours are mixed in sRGB; corners may change in number, and a mesh to one colour."""
    vertices, faces = square(1.0)
    is_left = vertices[:, 0] < 0
    rgba = np.where(is_left[:, None], (200, 0, 0, 255), (0, 200, 0, 255)).astype(np.uint8)
    ends = np.array([[(200, 0, 0), (0, 200, 0)]], np.uint8)
    middle = (100, 100, 0)

    def color_of(node: Node) -> Any:
        view.scene.upsert("base_link", "it", node)
        view.show()
        return view.color_at((0.0, 0.0, 0.0))

    assert color_of(Lines(floats(((-1, 0, 0), (1, 0, 0))), ends, 0.5, "m")) == near(middle)
    assert color_of(Mesh(vertices, faces, COLOR, colors=rgba)) == near(middle)
    twice = np.concatenate((vertices, vertices + floats(0, 0, 0.01)))
    both, blue = np.concatenate((faces, faces + np.uint32(4))), rgba[:, [2, 1, 0, 3]]
    mesh = Mesh(twice, both, COLOR, colors=np.concatenate((rgba, blue)))
    assert color_of(mesh) == near((0, 100, 100))
    clear = rgba * np.array((1, 1, 1, 0), np.uint8)
    assert color_of(Mesh(vertices, faces, COLOR, colors=clear)) == BACKGROUND
    assert color_of(Mesh(vertices, faces, COLOR)) == near(COLOR)


def near(color: Any) -> Any:
    return pytest.approx(color, abs=12)


def test_a_transparent_mesh_blends_with_the_background(view: View) -> None:
    view.scene.upsert("base_link", "it", Mesh(*square(1.0), (255, 255, 255), opacity=0.5))
    view.show()
    assert 100 < view.color_at((0.0, 0.0, 0.0))[0] < 220


def test_a_hidden_group_is_not_drawn(view: View) -> None:
    view.scene.upsert("base_link", "it", Points(floats((0, 0, 0)), COLOR, 0.5))
    view.show()
    view.scene.set_visible("base_link", False)
    view.show()
    assert (view.pixels() == BACKGROUND).all()


def test_far_from_home_the_scene_looks_the_same(view: View) -> None:
    x, y = 500_001.0, 4_000_000.5
    view.look((x, y - 0.01, 10.0), (x, y, 0.0))
    view.scene.set_pose("utm", Pose((x, y, 0.0)))
    view.scene.upsert("utm", "it", Points(floats((-0.2, 0, 0), (0.2, 0, 0)), COLOR, 0.2))
    view.show()
    assert view.color_at((x - 0.2, y, 0.0)) == view.color_at((x + 0.2, y, 0.0)) == COLOR
    assert view.color_at((x, y, 0.0)) == BACKGROUND


def test_the_background_can_be_changed(view: View) -> None:
    set_background(view.scene.link.server, (10, 20, 30))
    view.wait_for(lambda: view.draw(1) or (view.pixels() == (10, 20, 30)).all())
    set_background(view.scene.link.server, BACKGROUND)
    view.wait_for(lambda: view.draw(1) or (view.pixels() == BACKGROUND).all())


def test_parts_of_two_clouds_are_never_seen_together(view: View) -> None:
    xyz = np.zeros((PART + 1, 3), np.float32)
    xyz[-1] = (2, 0, 0)
    view.scene.upsert("lidar", "it", Points(xyz, RED, 0.5))
    view.show()
    (name,) = (name for name in view.nodes() if name.endswith("%part 1"))
    at = {name.rpartition("/")[0]: xyz[:1], name: xyz[-1:]}
    observed = []
    for node, place in at.items():
        updates = {
            "points": place,
            "colors": np.array(GREEN, np.uint8),
            "cloud": ("it", 7, len(at)),
        }
        view.scene.link.update(node, updates)
        view.show()
        observed.append(view.colors_at(*(each[0].tolist() for each in at.values())))
    assert observed == [[RED, RED], [GREEN, GREEN]]


def test_equal_textures_of_models_are_in_the_graphics_card_once(view: View) -> None:
    file = io.BytesIO()
    PIL.Image.new("RGB", (4, 4), COLOR).save(file, "PNG")
    corners, faces = square(1.0)

    def textures(*places: float) -> int:
        for x in places:
            look = Surface(texture=file.getvalue())
            part = MeshPart(corners + floats(x, 0, 0), faces, look, uvs=corners[:, :2])
            view.scene.upsert("g", f"at {x}", Glb(write_glb([part])))
        view.show()
        view.settle()
        view.draw()
        for color in view.colors_at(*((x, 0.0, 0.0) for x in places)):
            assert color == pytest.approx(COLOR, abs=2)
        memory = "() => window.__viserMutable.scene.__r3f.root.getState().gl.info.memory"
        return view.evaluate(memory)["textures"]

    of_one = textures(-1.0)
    assert textures(0.0, 1.0) == of_one
    view.scene.clear()
    view.show()
    textures(1.0)


def test_an_invalid_gltf_is_an_error(view: View) -> None:
    view.scene.upsert("base_link", "it", Glb(b"solid ascii stl"))
    with pytest.raises(ValueError, match=r"not a binary glTF 2\.0"):
        view.scene.flush()
