"""Points in a real browser: their size, and how many are drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from tests.scene.conftest import SIZE, View
from webviz.api.nodes import POINTS_HELD, POINTS_PER_BLOCK, Points
from webviz.scene.capacity import FEWEST_POINTS

RED = (255, 0, 0)


@pytest.fixture
def resized(view: View) -> Iterator[View]:
    """A page that gets its size back."""
    yield view
    view.resize_picture(*SIZE)


def test_a_point_has_its_edge_in_metres(resized: View) -> None:
    resized.scene.upsert("g", "point", Points(np.zeros((1, 3), np.float32), RED, 0.5))
    resized.look((0.0, -0.01, 4.0), (0.0, 0.0, 0.0))
    for height in (200, 400):
        resized.resize_picture(SIZE[0], height)
        resized.settle()
        resized.draw()
        red = resized.pixels()[..., 0] > 150
        edge = 0.5 * height / 2 / math.tan(math.pi / 8) / 4.0
        for along in (0, 1):
            assert np.ptp(np.nonzero(red)[along]) + 1 == pytest.approx(edge, abs=1)


@pytest.fixture
def hidden(view: View) -> Iterator[View]:
    """A page that is not seen: else it would hold less as soon as it found itself slow."""
    view.evaluate("""() => {
      Object.defineProperty(document, "hidden", { get: () => true, configurable: true });
    }""")
    yield view
    view.scene.clear()
    view.show()
    view.evaluate("() => { delete document.hidden; }")


def test_of_a_large_cloud_as_many_points_are_drawn_as_the_page_holds(hidden: View) -> None:
    blocks = 16
    rng = np.random.default_rng(0)
    xyz = np.zeros((blocks, POINTS_PER_BLOCK, 3), np.float32)
    xyz[:, :, :2] = rng.uniform(-0.5, 0.5, (blocks, POINTS_PER_BLOCK, 2))
    xyz[1:, :, 0] += 10.0 * np.arange(1 - blocks // 2, blocks // 2)[:, None]
    hidden.scene.upsert("map", "more", Points(xyz.reshape(-1, 3), RED, 0.01, thins=True))
    hidden.look((0.0, -0.01, 10.0), (0.0, 0.0, 0.0))
    drawn = "() => window.__viserMutable.scene.__r3f.root.getState().gl.info.render"
    near = hidden.evaluate(drawn)
    assert near["points"] == 2 * POINTS_PER_BLOCK + 8, "one block is in sight, the first always"
    hidden.look((0.0, -0.1, 200.0), (0.0, 0.0, 0.0))
    hidden.draw()  # what else is drawn is known from the picture before
    far = hidden.evaluate(drawn)
    assert far["calls"] == near["calls"] + blocks - 2
    assert FEWEST_POINTS - blocks <= far["points"] <= POINTS_HELD
