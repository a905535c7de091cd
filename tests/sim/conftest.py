import pytest
from worlds import draw_world

from webviz_sim.options import BUILDING
from webviz_sim.world import World, load_world


@pytest.fixture(scope="module")
def building() -> World:
    """The building of the demo."""
    return load_world(BUILDING)


@pytest.fixture
def room() -> World:
    """A room of 5 m x 4 m inside walls, at 0.1 m; its inner corner is at (0.1, 0.1)."""
    rows = ["#" * 52, *["#" + "." * 50 + "#"] * 40, "#" * 52]
    return draw_world("\n".join(rows), resolution=0.1)
