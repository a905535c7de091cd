"""Lighting of opaque and transparent surfaces."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from tests.scene.conftest import View
from webviz.api.nodes import Axes, Instances, Mesh, Node
from webviz.scene.constants import DARKEST
from webviz.scene.schemes import BACKGROUND

COLOR = (200, 100, 50)
FROM_ABOVE, FROM_A_SIDE = ((0.0, -0.01, 10.0), (10.0, 0.0, 0.0))


def shaded(cos: float) -> np.ndarray:
    return (DARKEST + (1 - DARKEST) * cos) * np.array(COLOR)


def box(size: float, corners: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A closed box around the origin; the second number is added to its faces."""
    steps = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], np.float32)
    quads = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    # Each side has its own corners, so that it is flat.
    vertices = np.concatenate([steps[list(quad)] for quad in quads]) * np.float32(size / 2)
    faces = [
        (4 * n + i, 4 * n + j, 4 * n + k) for n in range(6) for i, j, k in ((0, 1, 2), (0, 2, 3))
    ]
    return vertices, np.array(faces, np.uint32) + np.uint32(corners)


@pytest.mark.parametrize("eye", [FROM_ABOVE, FROM_A_SIDE], ids=["above", "a side"])
def test_a_ball_is_lit_from_the_camera_and_not_black_at_its_rim(view: View, eye: Any) -> None:
    ball = Instances(np.zeros((1, 3), np.float32), np.full((1, 3), 4, np.float32), COLOR, "sphere")
    view.scene.upsert("room", "ball", ball)
    view.look(eye, (0.0, 0.0, 0.0))
    view.wait_for(lambda: view.draw(1) or view.color_at((0, 0, 0)) != BACKGROUND)
    assert view.color_at((0, 0, 0)) == pytest.approx(COLOR, abs=6)
    pixels = view.pixels().astype(int)
    row, column = view.row_column((0, 0, 0))
    line = pixels[row, column:, 0]
    rim = line[: int(np.argmax(line == BACKGROUND[0]))]
    assert (np.diff(rim) <= 2).all()
    assert rim[-2] < 0.65 * COLOR[0]
    assert rim[:-1].min() >= DARKEST * COLOR[0] - 2


def test_a_side_that_is_seen_at_an_angle_is_darker_by_its_cosine(view: View) -> None:
    view.scene.upsert("room", "box", Mesh(*box(2.0), COLOR))
    view.look((10.0, 10.0, 0.0), (0.0, 0.0, 0.0))
    for color in view.colors_at((1.0, 0.5, 0.0), (0.5, 1.0, 0.0)):
        assert color == pytest.approx(shaded(np.sqrt(0.5)), abs=3)


def test_axes_are_shaded_and_as_long_as_they_should_be(view: View) -> None:
    at = np.zeros((1, 3), np.float32)
    view.scene.upsert("room", "axes", Axes(at, np.array([(1, 0, 0, 0)], np.float32), 2.0, 0.5))
    view.show()
    assert view.color_at((1.5, 0, 0.5)) == pytest.approx((255, 0, 0), abs=8)
    edge = np.array(view.color_at((1.5, 0.45, 0.2)))
    assert edge[0] < 200
    assert edge[1:].tolist() == [0, 0]
    assert view.color_at((1.9, 0, 0.5))[0] > 150
    assert view.color_at((2.2, 0, 0)) == BACKGROUND


@pytest.mark.parametrize("kind", ["mesh", "batch"])
def test_transparent_shapes_show_no_inside(view: View, kind: str) -> None:
    node: Node = Mesh(*box(2.0), COLOR, opacity=0.5)
    if kind == "batch":
        at, size = np.zeros((1, 3), np.float32), np.full((1, 3), 2, np.float32)
        node = Instances(at, size, COLOR, "box", opacity=0.5)
    view.scene.upsert("room", "box", node)
    view.show()
    once = np.add(COLOR, BACKGROUND) / 2
    view.wait_for(lambda: view.draw(1) or view.color_at((0, 0, 1)) != BACKGROUND)
    assert view.color_at((0.5, 0.5, 1)) == pytest.approx(once, abs=3)


@pytest.mark.parametrize("sizes", [(1.0, 2.0), (2.0, 1.0)], ids=["inner first", "outer first"])
def test_a_transparent_shape_does_not_hide_its_farther_parts(
    view: View, sizes: tuple[float, float]
) -> None:
    (a, i), (b, j) = box(sizes[0]), box(sizes[1], corners=24)
    mesh = Mesh(np.concatenate((a, b)), np.concatenate((i, j)), COLOR, opacity=0.5)
    view.scene.upsert("room", "boxes", mesh)
    view.show()
    twice = np.array(COLOR) * 0.75 + np.array(BACKGROUND) * 0.25
    assert view.color_at((0, 0, 1)) == pytest.approx(twice, abs=3)
