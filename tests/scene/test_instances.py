"""Many solids as one node, as a real browser draws them."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.scene.conftest import View, floats
from webviz.api.nodes import Instances, Pose, Solid
from webviz.scene.schemes import BACKGROUND
from webviz.scene.solids import SOLIDS

COLOR = (200, 100, 50)
RED, GREEN, BLUE = (200, 0, 0), (0, 200, 0), (0, 0, 200)


ORIGIN, UNIT = floats((0, 0, 0)), floats((1, 1, 1))


def is_near(color: tuple[int, int, int], expected: tuple[int, int, int], by: int = 20) -> bool:
    return bool(np.abs(np.subtract(color, expected)).max() <= by)


@pytest.mark.parametrize("shape", ["box", "cylinder", "sphere"])
def test_a_solid_has_its_colour_where_it_stands(shape: Solid, view: View) -> None:
    view.scene.set_pose("room", Pose((1.0, 0.5, 0.0)))
    view.scene.upsert("room", "solids", Instances(ORIGIN, UNIT, COLOR, shape))
    view.show()
    assert is_near(view.color_at((1.0, 0.5, 0.0)), COLOR)
    assert view.color_at((0.0, -1.0, 0.0)) == BACKGROUND


@pytest.mark.parametrize("opacity", [1.0, np.ones(1, np.float32)], ids=["one for all", "each"])
def test_a_ball_of_data_has_its_colour_in_the_middle_and_0_8_of_it_at_the_rim(
    opacity: Any, view: View
) -> None:
    ball = Instances(ORIGIN, 3 * UNIT, COLOR, "sphere", opacity=opacity, is_data=True)
    view.scene.upsert("room", "solids", ball)
    view.show()
    assert is_near(view.color_at((0.0, 0.0, 0.0)), COLOR, 3)
    for color in view.colors_at((1.45, 0.0, 0.0), (0.0, 1.45, 0.0), (0.0, -1.45, 0.0)):
        assert is_near(color, (163, 81, 41), 8)


SIDES = {
    (1, 0, 0): 0.6,
    (0, 1, 0): 0.4,
    (0, 0, 1): 0.9,
    (-1, 0, 0): 0.6,
    (0, -1, 0): 1.0,
    (0, 0, -1): 0.5,
}
"""Outward directions and brightness of the sides of RViz's boxes."""


@pytest.mark.parametrize("side", SIDES, ids=str)
def test_each_side_of_a_box_of_data_has_a_brightness_and_dark_edges(side: Any, view: View) -> None:
    view.scene.upsert("room", "solids", Instances(ORIGIN, 3 * UNIT, COLOR, "box", is_data=True))
    outward = np.array(side)
    view.look(tuple((outward * 8.0 + (0.5, 0.3, 0.4)).tolist()), (0.0, 0.0, 0.0))
    for share, brightness in ((0.0, SIDES[side]), (0.7, SIDES[side]), (0.98, SIDES[side] / 2)):
        place = 1.5 * (outward + share * np.roll(outward, 1))
        color = np.round(brightness * np.array(COLOR))
        assert is_near(view.color_at(tuple(place.tolist())), tuple(color), 3), share


@pytest.mark.parametrize("eye", [(3.0, 2.0, 8.0), (6.0, 0.0, -3.0)], ids=["above", "below"])
def test_a_square_of_data_has_its_colour_from_both_sides_at_any_slant(
    eye: tuple[float, float, float], view: View
) -> None:
    view.scene.upsert("room", "tiles", Instances(ORIGIN, 3 * UNIT, COLOR, "square", is_data=True))
    view.look(eye, (0.0, 0.0, 0.0))
    for color in view.colors_at((0.0, 0.0, 0.0), (1.4, 1.4, 0.0), (-1.4, 0.5, 0.0)):
        assert is_near(color, COLOR, 1)
    assert view.colors_at((1.7, 0.0, 0.0), (0.0, -1.7, 0.0)) == [BACKGROUND] * 2


def test_each_solid_has_its_place_extent_turn_and_colour(view: View) -> None:
    quarter = floats((1, 0, 0, 0), (np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    centers, sizes = floats((-1, 0, 0), (1.5, 0, 0)), floats((0.4, 2, 0.1), (0.4, 2, 0.1))
    colors = np.array((RED, GREEN), np.uint8)
    view.scene.upsert("room", "solids", Instances(centers, sizes, colors, "box", quarter))
    view.show()
    assert is_near(view.color_at((-1.0, 0.9, 0.0)), RED)
    assert view.color_at((-0.6, 0.0, 0.0)) == BACKGROUND
    assert is_near(view.color_at((2.4, 0.0, 0.0)), GREEN)
    assert view.color_at((1.5, 0.9, 0.0)) == BACKGROUND


def test_solids_change_in_number_place_colour_and_shape(view: View) -> None:
    for count in (1, 5, 0, 3):
        places = floats(*[(x, 0, 0) for x in range(count)]).reshape(-1, 3)
        colors = np.array([RED, GREEN, BLUE, GREEN, RED][:count], np.uint8).reshape(-1, 3)
        view.scene.upsert("room", "solids", Instances(places, np.full_like(places, 0.5), colors))
        view.show()
        colors_at = view.colors_at(*((x, 0.0, 0.0) for x in range(5)))
        visible = [color != BACKGROUND for color in colors_at]
        assert visible == [True] * count + [False] * (5 - count)
    assert is_near(view.color_at((2.0, 0.0, 0.0)), BLUE)
    corner = (0.45, 0.45, 0.0)
    view.scene.upsert("room", "solids", Instances(ORIGIN, UNIT, RED, "box"))
    view.show()
    assert is_near(view.color_at(corner), RED)
    view.scene.upsert("room", "solids", Instances(ORIGIN, UNIT, RED, "sphere"))
    view.show()
    assert view.color_at(corner) == BACKGROUND


def test_transparent_instances_show_the_background(view: View) -> None:
    places, sizes = floats((-1, 0, 0), (1, 0, 0)), floats((1, 1, 1), (1, 1, 1))
    white = (255, 255, 255)
    view.scene.upsert("room", "solids", Instances(places, sizes, white, opacity=0.5))
    view.show()
    assert 100 < view.color_at((-1.0, 0.0, 0.0))[0] < 220
    each = floats(1.0, 0.5)
    view.scene.upsert("room", "solids", Instances(places, sizes, white, opacity=each))
    view.show()
    opaque, faint = view.color_at((-1.0, 0.0, 0.0)), view.color_at((1.0, 0.0, 0.0))
    assert opaque[0] > 230
    assert 100 < faint[0] < 220
    view.scene.upsert("room", "solids", Instances(places, sizes, white))
    view.show()
    assert view.color_at((1.0, 0.0, 0.0))[0] > 230


def test_solids_that_fade_leave_nothing_in_the_graphics_card(view: View) -> None:
    memory = "() => window.__viserMutable.scene.__r3f.root.getState().gl.info.memory.geometries"
    counts = []
    for opacity in (0.9, 0.8, 0.7, 0.6, 0.5):
        each = np.full(1, opacity, np.float32)
        view.scene.upsert("room", "solids", Instances(ORIGIN, UNIT, COLOR, "box", opacity=each))
        view.show()
        view.draw()
        counts.append(view.evaluate(memory))
    assert counts[-1] == counts[0]


def test_non_finite_instances_are_dropped(view: View) -> None:
    places = floats((0, 0, np.nan), (1, 0, 0))
    colors = np.array((RED, GREEN), np.uint8)
    node = Instances(places, floats((1, 1, 1), (1, 1, 1)), colors, opacity=floats(1.0, 1.0))
    view.scene.upsert("room", "solids", node)
    view.show()
    assert is_near(view.color_at((1.0, 0.0, 0.0)), GREEN)
    assert view.color_at((-1.0, 0.0, 0.0)) == BACKGROUND


@pytest.mark.parametrize(
    ("shape", "volume"),
    [("box", 1), ("sphere", np.pi / 6), ("cylinder", np.pi / 4), ("cone", np.pi / 12)],
)
def test_solids_are_of_size_1_and_not_inside_out(shape: str, volume: float) -> None:
    vertices, faces = SOLIDS[shape]
    a, b, c = np.swapaxes(vertices[faces].astype(float), 0, 1)
    assert np.ptp(vertices, axis=0) == pytest.approx((1, 1, 1))
    # The sum of the signed volumes of tetrahedra from the origin; round ones are cut corners.
    assert np.einsum("ij,ij->", a, np.cross(b, c)) / 6 == pytest.approx(volume, rel=0.07)
    outwards = np.einsum("ij,ij->i", np.cross(b - a, c - a), a + b + c)
    assert outwards.min() >= -1e-9


def test_a_cone_points_along_z(view: View) -> None:
    along_y = floats((np.sqrt(0.5), -np.sqrt(0.5), 0, 0))
    node = Instances(ORIGIN, floats((1, 1, 2)), RED, "cone", along_y)
    view.scene.upsert("room", "solids", node)
    view.show()
    assert view.color_at((0.4, -0.9, 0.0)) != BACKGROUND
    assert view.color_at((0.0, 0.8, 0.0)) != BACKGROUND
    assert view.color_at((0.4, 0.8, 0.0)) == BACKGROUND
