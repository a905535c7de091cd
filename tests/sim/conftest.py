import numpy as np
import pytest

from webviz_sim.options import BUILDING
from webviz_sim.pose import Pose2D
from webviz_sim.world import World, load_world


@pytest.fixture(scope="module")
def building() -> World:
    """The building of the demo."""
    return load_world(BUILDING)


@pytest.fixture
def draw():
    """Make a world of cells from lines of text, first line topmost: # wall, . free, ? unknown."""

    def make(text: str, resolution: float = 1.0, origin: Pose2D = Pose2D()) -> World:  # noqa: B008
        lines = text.split()
        meaning = {"#": 100, ".": 0, "?": -1}
        cells = np.array([[meaning[c] for c in line] for line in lines[::-1]], dtype=np.int8)
        return World(cells, resolution, origin)

    return make


@pytest.fixture
def room(draw):
    """A room of 5 m x 4 m inside walls, at 0.1 m; its inner corner is at (0.1, 0.1)."""
    rows = ["#" * 52, *["#" + "." * 50 + "#"] * 40, "#" * 52]
    return draw("\n".join(rows), resolution=0.1)
