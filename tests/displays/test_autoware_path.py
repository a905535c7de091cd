"""The displays of Autoware's paths and trajectories, and of the way along poses."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from autoware_scenes import BOUNDED, PASSED, PATH, POSE, TIMED, TRAJECTORY, WAY, planned
from autoware_scenes import POSE as POSE_STAMPED
from built_in_checks import BuiltInChecks
from inspecting import Benches
from plain_scenes import in_moving_frame

from webviz.shell.testing import check_details
from webviz_displays.autoware import AutowarePath, AutowareTrajectory, PoseHistory, path
from webviz_displays.autoware.look import FootprintView, LaneView, PointView, TextView

NAN = math.nan


def test_the_lane_is_as_wide_as_the_vehicle_and_coloured_by_velocity(
    display_bench: Callable,
) -> None:
    at = display_bench(AutowarePath(view_path=LaneView(alpha=0.5)), BOUNDED)
    lane = at.nodes()["lane"]
    np.testing.assert_allclose(at.xyz("lane")[:2], [(10, -0.915, 0), (10, 0.915, 0)], atol=1e-6)
    assert lane.colors[0].tolist() == [63, 46, 227, 128]
    assert lane.colors[-1].tolist() == [0, 230, 120, 128]
    edges = np.diff(lane.vertices[lane.faces], axis=1)
    assert (np.cross(edges[:, 0], edges[:, 1])[:, 2] > 0).all(), "seen from above"
    assert at.statuses()["Path"] == ("OK", "4 points, 0.00 to 3.00 m/s.")
    at.set("view_path.constant_width", True)
    np.testing.assert_allclose(at.xyz("lane")[:2, 1], (-1.0, 1.0), atol=1e-6)
    at.set("view_path.fade_out_distance", 4.0)
    assert at.nodes()["lane"].colors[::2, 3].tolist() == [128, 96, 64, 0]
    at.set("color_border_vel_max", 1.0)
    at.set("view_path.alpha", 1.0)
    assert at.nodes()["lane"].colors[2, :3].tolist() == [0, 230, 120]


def test_velocities_are_heights_and_backwards_is_below(display_bench: Callable) -> None:
    way = planned((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), speeds=(1.0, -3.0))
    at = display_bench(AutowarePath(), {"points": way})
    np.testing.assert_allclose(at.xyz("velocity line")[0, :, 2], (0.3, -0.9), atol=1e-6)
    assert at.nodes()["velocity line"].colors[0, 1].tolist() == [0, 230, 120]


def test_bounds_footprints_and_points(display_bench: Callable) -> None:
    at = display_bench(
        AutowarePath(
            view_footprint=FootprintView(
                value=True,
                vehicle_length=4.0,
                vehicle_width=2.0,
                rear_overhang=1.0,
                offset_from_baselink=0.25,
            ),
            view_point=PointView(value=True, offset=0.5, radius=0.2),
        ),
        BOUNDED,
    )
    np.testing.assert_allclose(at.xyz("left bound")[0], [(10, 3, 0), (14, 3, 0)], atol=1e-6)
    outline = at.xyz("footprints")[:4, 0]
    expected = [(12.75, 1, 0), (12.75, -1, 0), (9.25, -1, 0), (9.25, 1, 0)]
    np.testing.assert_allclose(outline, expected, atol=1e-6)
    np.testing.assert_allclose(at.xyz("points")[1], (11.5, 0, 0.1), atol=1e-6)


def test_numbers_stand_above_their_points(display_bench: Callable) -> None:
    names = ("velocity", "slope", "time")
    texts: dict[str, Any] = {f"view_text_{name}": TextView(value=True) for name in names}
    at = display_bench(AutowareTrajectory(**texts), TIMED)
    nodes = at.nodes()
    assert nodes["velocities"].texts == ("0.00", "1.00", "2.00", "3.00")
    assert nodes["slopes"].texts == ("0.10", "0.20", "0.00", "0.00")
    assert nodes["times"].texts == ("0.00", "0.25", "0.50", "0.75")
    np.testing.assert_allclose(at.xyz("times")[1], (11, 0, 0.25), atol=1e-6)


@pytest.mark.parametrize(
    ("change", "level", "sentence"),
    [
        ({"points": []}, "WARN", "The path is empty. Check the planner's log."),
        (
            {"points": planned((0.0, NAN, 0.0))},
            "ERROR",
            "A pose or velocity is not finite or too large. Fix the planner.",
        ),
    ],
)
def test_an_empty_or_invalid_path_is_named(
    change: dict[str, Any], level: str, sentence: str, display_bench: Callable
) -> None:
    at = display_bench(AutowarePath(), BOUNDED | change)
    assert at.nodes() == {}
    assert at.statuses()["Path"] == (level, sentence)


def test_an_invalid_bound_is_named_and_the_path_stays(display_bench: Callable) -> None:
    at = display_bench(AutowarePath(), BOUNDED | {"left_bound": [{"x": NAN}]})
    assert set(at.nodes()) == {"lane", "velocity line", "right bound"}
    sentence = "The left bound is not finite. Fix the planner."
    assert at.statuses()["Drivable area"] == ("ERROR", sentence)


def test_a_long_path_is_cut_with_a_warning(
    display_bench: Callable, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(path, "MAX_POINTS", 2)
    at = display_bench(AutowarePath(), {"points": WAY})
    assert len(at.nodes()["velocity line"].segments) == 1
    sentence = "Showing the first 2 points, 0.00 to 1.00 m/s; the path has 4."
    assert at.statuses()["Path"] == ("WARN", sentence)


def test_poses_become_a_line_of_the_newest(bench: Benches) -> None:
    at = bench(PoseHistory(buffer_size=2))
    for x, values in enumerate(PASSED):
        at.transform("map", "odom", (10.0 * x, 0.0, 0.0), stamp_ns=at.now_ns)
        at.send(POSE, values, frame="odom")
        at.turn(0.1)
    np.testing.assert_allclose(at.xyz("line")[0], [(11, 0.5, 0), (22, 0, 0)], atol=1e-6)
    assert at.statuses()["Poses"] == ("OK", "Showing 2 poses.")
    at.set("line.value", False)
    assert at.statuses()["Poses"] == ("WARN", "2 poses; Line is switched off.")
    assert at.nodes() == {}


class TestAutowarePath(BuiltInChecks):
    display = AutowarePath
    scene = in_moving_frame(PATH, BOUNDED)


class TestAutowareTrajectory(BuiltInChecks):
    display = AutowareTrajectory
    scene = in_moving_frame(TRAJECTORY, TIMED)
    variants = (lambda: AutowareTrajectory(view_footprint=FootprintView(value=True)),)


class TestPoseHistory(BuiltInChecks):
    display = PoseHistory
    scene = in_moving_frame(POSE, *PASSED * 110)
    later = ("buffer_size",)


def test_selecting_point_of_a_trajectory(turned: Benches) -> None:
    check_details(
        turned(AutowareTrajectory(), TIMED).pick("velocity line", 2),
        "Point 2 of 4",
        {
            "Velocity": "2 m/s",
            "Lateral velocity": "0.25 m/s",
            "Heading rate": "0.125 rad/s",
            "Time": "0.5 s",
            "Acceleration": "0.5 m/s²",
            "Front wheels": "0 rad",
        },
    )


def test_selecting_pose_of_a_history(bench: Benches) -> None:
    at = bench(PoseHistory())
    for values in PASSED:
        at.send(POSE_STAMPED, values, frame="map")
        at.turn(0.1)
    check_details(at.pick("line", 1), "Pose 1", {})
