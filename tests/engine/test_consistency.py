"""Conclusions from several displays: scans beside walls, paths through obstacles."""

from __future__ import annotations

import math
from typing import Any

import building
import numpy as np
import pytest
from bench import Bench, Benches

from webviz.api.declared import Topic
from webviz.engine.parts.scan_fit import fit
from webviz.shell.testing.messages import header, stamped_transform, turned
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.path import Path
from webviz_sim.pose import Pose2D

S = 1_000_000_000
HERE = Pose2D(-2.0, 0.0)
SCAN, MAP, PATH = 0, 1, 2


def place(b: Bench, pose: Pose2D, roll: float = 0.0, pitch: float = 0.0) -> None:
    """Say where the laser is."""
    stamped = stamped_transform(
        "map", "laser", 0, (pose.x, pose.y, 0.0), turned(roll, pitch, pose.yaw)
    )
    b.publish("/tf_static", "tf2_msgs/msg/TFMessage", {"transforms": [stamped]})


def look(b: Bench, scan: dict[str, Any] | None = None) -> None:
    """Publish the map and a scan from `HERE`, and compare."""
    b.publish("/map", "nav_msgs/msg/OccupancyGrid", {"header": header("map", S)} | building.grid())
    scan = building.scan(HERE) if scan is None else scan
    b.publish("/scan", "sensor_msgs/msg/LaserScan", {"header": header("laser", S)} | scan)
    b.turn()
    b.clock += 1.1


def match_status(b: Bench, row: int = SCAN, key: str = "Map") -> str:
    level, text = b.statuses(row).get(key, ("", ""))
    return f"{level} {text}".strip()


def test_a_laser_upside_down_is_named(bench: Benches) -> None:
    b = bench(LaserScan(), Map())
    here = Pose2D(-2.0, 0.0, 0.6)
    measured = building.scan(here)
    upside_down = measured | {"ranges": np.roll(measured["ranges"][::-1], 1)}
    place(b, here)
    look(b, upside_down)
    assert "The laser is upside down: give 'laser' a roll of 180°" in match_status(b)
    place(b, here, roll=math.pi)
    look(b, upside_down)
    assert match_status(b).startswith("OK 100%")


def test_a_scan_that_fits_nowhere_is_of_another_place(bench: Benches) -> None:
    b = bench(LaserScan(), Map())
    place(b, HERE)
    look(b, building.scan(HERE) | {"ranges": np.full(360, 2.0, np.float32)})
    assert match_status(b).startswith("WARN Only ")
    assert match_status(b).endswith("this is the map of another place.")


def test_a_second_scan_that_does_not_match_does_not_mean_a_misplaced_robot(bench: Benches) -> None:
    b = bench(LaserScan(), Map(), LaserScan(topic=Topic("/computed")))
    place(b, HERE)

    def look_twice(ranges: Any) -> str:
        computed = building.scan(HERE) | {"ranges": ranges}
        stamped = {"header": header("laser", S)} | computed
        b.publish("/computed", "sensor_msgs/msg/LaserScan", stamped)
        look(b)
        return match_status(b, row=2)

    status = look_twice(np.full(360, 2.0, np.float32))
    assert match_status(b).startswith("OK 100%")
    assert status.startswith("OK Only ")
    assert status.endswith("Another scan fits, so the robot is in place.")
    status = look_twice(building.scan(Pose2D(HERE.x + 0.6, HERE.y))["ranges"])
    assert status.startswith("WARN Only ")
    assert status.endswith("so the robot is in place: check the transform of 'laser'.")


@pytest.mark.parametrize(
    ("map_", "pose", "pitch"),
    [
        (Map(color_scheme="costmap"), HERE, 0.0),
        (Map(enabled=False), HERE, 0.0),
        (Map(alpha=0.0), HERE, 0.0),
        (Map(), HERE, 0.3),
        (Map(), Pose2D(1e6, 1e6), 0.0),
        (Map(), Pose2D(1e300, 0.0), 0.0),
    ],
    ids=["costmap", "hidden", "invisible", "tilted", "beyond the map", "out of reach"],
)
def test_ambiguous_matches_give_no_conclusion(
    bench: Benches, map_: Map, pose: Pose2D, pitch: float
) -> None:
    b = bench(LaserScan(), map_)
    place(b, pose, pitch=pitch)
    look(b)
    assert match_status(b) == ""


def test_the_map_that_fits_best_counts(bench: Benches) -> None:
    b = bench(LaserScan(), Map(), Map(topic=Topic("/mask")))
    place(b, HERE)
    empty = building.grid(np.zeros_like(building.WORLD.cells))
    b.publish("/mask", "nav_msgs/msg/OccupancyGrid", {"header": header("map", S)} | empty)
    look(b)
    assert match_status(b).startswith("OK 100%")
    assert match_status(b).endswith("walls of /map.")


def test_a_comparison_ends_with_its_displays(bench: Benches) -> None:
    b = bench(LaserScan(), Map())
    place(b, HERE)
    look(b)
    assert match_status(b) != ""
    b.scene.watched = False
    b.clock += 1.1
    assert match_status(b) == ""


@pytest.mark.parametrize(
    ("goal_x", "age_s", "expected"),
    [
        (4.5, 0.0, "does not know this obstacle. Check that its costmap subscribes to the scan."),
        (4.5, 8.0, "is 8.0 s old: the planner has not replanned since."),
        (1.0, 8.0, ""),  # it ends at the box: a robot may dock there
        (-2.0, 8.0, ""),
    ],
)
def test_a_path_through_a_box_has_a_reason(
    bench: Benches, goal_x: float, age_s: float, expected: str
) -> None:
    b = bench(LaserScan(), Map(), Path())
    place(b, HERE)
    way = building.path([(HERE.x, HERE.y), (goal_x, 0.0)])
    b.publish("/path", "nav_msgs/msg/Path", {"header": header("map", S)} | way)
    b.turn()
    b.source.now += round(age_s * S)
    look(b, building.scan(HERE, building.with_box(1.5, 0.0, 0.8)))
    assert match_status(b).startswith("OK")
    obstacles = match_status(b, PATH, "Obstacles")
    assert (expected in obstacles) if expected else (obstacles == "")


def test_coarse_and_fine_maps_are_compared_in_bounded_memory() -> None:
    points = (5.0 * np.exp(1j * np.linspace(0, math.tau, 360))).astype(np.complex128)
    cells: list[int] = []

    def window(row: int, column: int, rows: int, columns: int) -> np.ndarray:
        cells.append(rows * columns)
        return np.full((rows, columns), 100, np.int8)

    for resolution in (1e-6, 0.01, 5.0, 1e6):
        fit(0j, 0.0, points, resolution, window)
    assert max(cells) <= 600 * 600
