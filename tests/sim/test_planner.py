import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from numpy.typing import NDArray
from worlds import draw_world

from webviz_sim.options import BUILDING
from webviz_sim.planner import SPACING, Planner, obstacle_distance
from webviz_sim.pose import Pose2D
from webviz_sim.robot import RADIUS
from webviz_sim.world import World, load_world

MAPS = Path(__file__).parents[2] / "../shared/data/maps"


@pytest.fixture(scope="module")
def planner(building: World) -> Planner:
    return Planner(building)


@settings(deadline=None)
@given(arrays(bool, st.tuples(st.integers(1, 9), st.integers(1, 9))), st.integers(1, 5))
def test_distances_to_obstacles_agree_with_measuring_to_every_cell(
    obstacles: NDArray[np.bool_], reach: int
) -> None:
    walls = np.argwhere(np.pad(obstacles, 1, constant_values=True)) - 1
    expected = np.empty(obstacles.shape)
    for cell in np.ndindex(obstacles.shape):
        outside = np.maximum(np.abs(walls - cell) - 0.5, 0.0) * (walls != cell)
        expected[cell] = min(np.hypot(*outside.T).min(), reach)
    assert np.allclose(obstacle_distance(obstacles, reach), expected, atol=1e-6)


PLACES = [(-5.0, 1.5), (1.2, 2.5), (4.1, 2.2), (-4.3, -2.7), (1.6, -3.3), (5.3, -2.2), (0.0, 0.0)]


@pytest.mark.parametrize("start", PLACES)
@pytest.mark.parametrize("goal", PLACES)
def test_paths_between_rooms_never_come_near_a_wall(
    building: World, planner: Planner, start: tuple[float, float], goal: tuple[float, float]
) -> None:
    path = planner.plan(Pose2D(*start), Pose2D(*goal))
    assert path is not None
    assert path[0] == pytest.approx(start)
    assert path[-1] == pytest.approx(goal)
    assert np.hypot(*np.diff(path, axis=0).T).max() < 1.5 * SPACING
    for x, y in path:
        assert building.clearance(Pose2D(x, y), 1.0) > RADIUS


def test_a_path_turns_gently(planner: Planner) -> None:
    path = planner.plan(Pose2D(-5.0, 1.5), Pose2D(1.2, 2.5))
    assert path is not None
    headings = np.unwrap(np.arctan2(*np.diff(path, axis=0).T[::-1]))
    assert np.abs(np.diff(headings)).max() < math.radians(20)


def test_a_path_is_not_much_longer_than_it_must_be() -> None:
    rows = ["#" * 60, *["#" + "." * 58 + "#"] * 40, "#" * 60]
    planner = Planner(draw_world("\n".join(rows), resolution=0.1))
    path = planner.plan(Pose2D(1.0, 1.0), Pose2D(5.0, 3.0))
    assert path is not None
    assert np.hypot(*np.diff(path, axis=0).T).sum() < 1.1 * math.hypot(4.0, 2.0)


def test_there_is_no_path_through_walls_or_unknown_cells() -> None:
    for wall in "#?":
        rows = ["." * 20 + wall * 2 + "." * 20] * 20
        planner = Planner(draw_world("\n".join(rows), resolution=0.1))
        assert planner.plan(Pose2D(1.0, 1.0), Pose2D(3.2, 1.0)) is None


def test_there_is_no_path_through_a_gap_narrower_than_the_robot() -> None:
    open_row, closed_row = "." * 42, "." * 20 + "#" * 2 + "." * 20
    narrow = Planner(
        draw_world("\n".join([closed_row] * 10 + [open_row] * 4 + [closed_row] * 10), 0.1)
    )
    wide = Planner(
        draw_world("\n".join([closed_row] * 10 + [open_row] * 8 + [closed_row] * 10), 0.1)
    )
    assert narrow.plan(Pose2D(1.0, 1.2), Pose2D(3.2, 1.2)) is None
    assert wide.plan(Pose2D(1.0, 1.4), Pose2D(3.2, 1.4)) is not None


def test_a_path_from_a_wall_begins_where_the_robot_has_room(
    building: World, planner: Planner
) -> None:
    path = planner.plan(Pose2D(-5.95, 0.5), Pose2D(0.0, 0.0))
    assert path is not None
    assert building.clearance(Pose2D(*path[0]), 1.0) > RADIUS
    assert math.dist(path[0], (-5.95, 0.5)) < 0.7


def test_a_path_to_where_the_robot_stands_has_two_points(planner: Planner) -> None:
    path = planner.plan(Pose2D(0.0, 0.0), Pose2D(0.0, 0.0))
    assert path == pytest.approx(np.zeros((2, 2)))


def test_a_world_without_room_has_no_paths() -> None:
    planner = Planner(draw_world("####\n####"))
    assert planner.plan(Pose2D(1.0, 1.0), Pose2D(2.0, 1.0)) is None
    assert planner.spread(Pose2D(1.0, 1.0), 5) == []
    assert planner.roomy_pose() is None


def test_places_to_visit_are_apart_and_in_every_room(planner: Planner) -> None:
    places = planner.spread(Pose2D(), 12)
    assert len(places) == 12
    gaps = [math.dist(a[:2], b[:2]) for a in places for b in places if a is not b]
    assert min(gaps) > 1.5
    rooms = {(p.y > 0.8, p.y < -0.8, p.x < -2.2, p.x > 0.6, p.x > 1.8) for p in places}
    assert len(rooms) >= 6


@settings(max_examples=15, deadline=None)
@given(st.floats(-math.pi, math.pi))
def test_a_turned_map_gives_turned_paths(yaw: float) -> None:
    world = load_world(BUILDING)
    turn = Pose2D(3.0, -1.0, yaw)
    turned = Planner(replace(world, origin=turn @ world.origin))
    path = turned.plan(turn @ Pose2D(-5.0, 1.5), turn @ Pose2D(1.2, 2.5))
    expected = Planner(world).plan(Pose2D(-5.0, 1.5), Pose2D(1.2, 2.5))
    assert path is not None
    back = np.array([(turn.inverse() @ Pose2D(x, y))[:2] for x, y in path])
    assert np.abs(back - expected).max() < 1e-6


@pytest.mark.parametrize("name", ["mac_1st_floor_final", "tb3_sandbox", "warehouse"])
def test_paths_are_found_in_maps_in_the_wild(name: str) -> None:
    path = MAPS / f"{name}.yaml"
    if not path.exists():
        pytest.skip(f"{path} is not there")
    world = load_world(path)
    planner = Planner(world)
    start = planner.roomy_pose()
    assert start is not None
    places = planner.spread(start, 3)
    assert places
    for place in places:
        route = planner.plan(start, place)
        assert route is not None
        for x, y in route:
            assert world.clearance(Pose2D(x, y), 1.0) > RADIUS
