"""Points in a real browser: their size, and how many are drawn."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np
import pytest

from tests.scene.conftest import SIZE, View
from webviz.api.nodes import POINTS_HELD, POINTS_PER_BLOCK, Points
from webviz.scene.capacity import FEWEST_POINTS
from webviz.scene.names import node_path

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


POINT_AT = """async ([name, ...at]) => {
  const viser = await import("webviz/viser_page.js");
  const { pointAt } = await import("webviz/scene/picking/points.js");
  const found = [];
  viser.node(name).traverse((each) => each.isPoints && found.push(pointAt(each, at, 0)?.number));
  return found[0] ?? null;
}"""


def test_points_grow_with_the_distance_from_their_plane(view: View) -> None:
    places = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]], np.float32)
    plane = (1.0, 0.0, 0.0, 2.0)  # 1 m and 3 m away
    view.scene.upsert("g", "points", Points(places, RED, 0.25, plane=plane))
    view.look((0.0, -0.01, 4.0), (0.0, 0.0, 0.0))
    assert edges(view) == [pytest.approx(0.25, abs=0.03), pytest.approx(0.75, abs=0.03)]
    beside = [view.pixel_of(x + 0.25, 0.0, 0.0) for x in (-1.0, 1.0)]
    assert [view.evaluate(POINT_AT, [node_path("g", "points"), *at]) for at in beside] == [None, 1]
    view.scene.upsert("g", "points", Points(places, RED, 0.25))
    view.show()
    assert edges(view) == [pytest.approx(0.25, abs=0.03)] * 2


def edges(view: View) -> list[float]:
    """Metres that the red of each half of the picture is wide, 4 m away."""
    red = view.pixels()[..., 0] > 150
    metre = SIZE[1] / 2 / math.tan(math.pi / 8) / 4.0
    halves = red[:, : SIZE[0] // 2], red[:, SIZE[0] // 2 :]
    return [float(np.ptp(np.nonzero(half.any(axis=0))) + 1) / metre for half in halves]


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


def test_a_large_cloud_is_drawn_up_to_the_limit_of_the_page(hidden: View) -> None:
    blocks = 16
    rng = np.random.default_rng(0)
    xyz = np.zeros((blocks, POINTS_PER_BLOCK, 3), np.float32)
    xyz[:, :, :2] = rng.uniform(-0.5, 0.5, (blocks, POINTS_PER_BLOCK, 2))
    xyz[1:, :, 0] += 10.0 * np.arange(1 - blocks // 2, blocks // 2)[:, None]
    hidden.scene.upsert("map", "more", Points(xyz.reshape(-1, 3), RED, 0.01, thins=True))
    hidden.look((0.0, -0.01, 10.0), (0.0, 0.0, 0.0))
    render_info = "() => window.__viserMutable.scene.__r3f.root.getState().gl.info.render"
    near = hidden.evaluate(render_info)
    assert near["points"] == 2 * POINTS_PER_BLOCK + 8, "one block is in sight, the first always"
    hidden.look((0.0, -0.1, 200.0), (0.0, 0.0, 0.0))
    hidden.draw()  # what else is drawn is known from the picture before
    far = hidden.evaluate(render_info)
    assert far["calls"] == near["calls"] + blocks - 2
    assert FEWEST_POINTS - blocks <= far["points"] <= POINTS_HELD
