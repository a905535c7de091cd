from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import paths
from inspecting import Benches

from webviz.shell.testing import check_details
from webviz_displays.path import Path

NAN, INF = float("nan"), float("inf")
QUARTER = (0.0, 0.0, np.sqrt(0.5), np.sqrt(0.5))
"""90 degrees about z, xyzw."""


def path(*positions: tuple[float, ...], turn: tuple[float, ...] = (0, 0, 0, 1)) -> dict[str, Any]:
    """A path through positions whose poses are all turned the same."""
    orientation = dict(zip("xyzw", turn, strict=True))
    return {
        "poses": [
            {
                "pose": {
                    "position": dict(zip("xyz", position, strict=True)),
                    "orientation": orientation,
                }
            }
            for position in positions
        ]
    }


def test_poses_are_joined_in_the_frame_of_the_header(turned: Benches) -> None:
    bench = turned(Path(), path((0, 0, 0), (1, 0, 0), (1, 2, 0)))
    expected = [[(10, 0, 0), (10, 1, 0)], [(10, 1, 0), (8, 1, 0)]]
    np.testing.assert_allclose(bench.xyz("line"), expected, atol=1e-6)
    node = bench.nodes()["line"]
    assert (node.colors, node.width, node.unit) == ((25, 255, 0), 1.0, "px")
    assert bench.statuses()["Path"] == ("OK", "Showing 3 poses.")


def test_the_offset_is_along_the_axes_of_the_fixed_frame(turned: Benches) -> None:
    bench = turned(Path(offset=(0.0, 0.5, 3.0)), path((0, 0, 0), (1, 0, 0)))
    expected = [[(10, 0.5, 3), (10, 1.5, 3)]]
    np.testing.assert_allclose(bench.xyz("line"), expected, atol=1e-6)


def test_billboards_have_a_width_in_metres(turned: Benches) -> None:
    node = turned(Path(line_style="Billboards"), path((0, 0, 0), (1, 0, 0))).nodes()["line"]
    assert (node.width, node.unit) == (0.03, "m")


def test_colour_and_alpha_change_the_present_line(turned: Benches) -> None:
    bench = turned(Path(), path((0, 0, 0), (1, 0, 0)))
    bench.set("color", (248, 48, 48))
    assert bench.nodes()["line"].colors == (248, 48, 48)
    bench.set("alpha", 0.5)
    assert bench.nodes()["line"].opacity == 0.5


def test_a_path_over_the_limit_is_thinned_with_a_warning(
    turned: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz_displays.path.MAX_POSES", 3)
    bench = turned(Path(pose_style="Axes"), path(*((x, 0, 0) for x in range(9))))
    assert len(bench.nodes()["line"].segments) == 2
    assert len(bench.nodes()["poses"].positions) == 3
    level, text = bench.statuses()["Path"]
    assert (level, text) == ("WARN", "Showing 3 of 9 poses, evenly picked.")


def test_the_newest_paths_stay_up_to_the_buffer_length(turned: Benches) -> None:
    paths = [path((0, 0, i), (1, 0, i)) for i in range(4)]
    bench = turned(Path(buffer_length=3), *paths)
    heights = sorted(bench.xyz(key)[0, 0, 2] for key in bench.nodes())
    assert heights == [1, 2, 3]
    bench.set("buffer_length", 1)
    assert [bench.xyz(key)[0, 0, 2] for key in bench.nodes()] == [3]


def test_arrows_point_along_x_of_each_pose(turned: Benches) -> None:
    bench = turned(Path(pose_style="Arrows"), path((0, 0, 0), (5, 0, 0), turn=QUARTER))
    node = bench.nodes()["poses"]
    expected = [[(10, 0, 0), (9.7, 0, 0)], [(10, 5, 0), (9.7, 5, 0)]]
    np.testing.assert_allclose(bench.xyz("poses"), expected, atol=1e-6)
    assert (node.shaft_radius, node.head_radius, node.head_length) == (0.05, 0.15, 0.2)
    assert node.colors == (255, 85, 255)


def test_axes_are_turned_as_each_pose(turned: Benches) -> None:
    bench = turned(Path(pose_style="Axes"), path((1, 2, 3), turn=QUARTER))
    np.testing.assert_allclose(bench.xyz("poses"), [(8, 1, 3)], atol=1e-6)
    node = bench.nodes()["poses"]  # two quarter turns, of odom and of the pose
    np.testing.assert_allclose(np.abs(node.wxyzs), [(0, 0, 0, 1)], atol=1e-6)
    assert (node.length, node.radius) == (0.3, 0.03)


def test_orientations_that_planners_leave_at_zero_are_drawn_unturned_and_named(
    turned: Benches,
) -> None:
    bench = turned(Path(pose_style="Arrows"), path((0, 0, 0), (1, 0, 0), turn=(0, 0, 0, 0)))
    np.testing.assert_allclose(bench.xyz("poses")[0, 1], (10, 0.3, 0), atol=1e-6)
    assert bench.statuses()["Orientation"][0] == "WARN"
    bench.set("pose_style", "None")
    assert "Orientation" not in bench.statuses()


def test_unnormalized_orientations_are_normalized(turned: Benches) -> None:
    bench = turned(Path(pose_style="Arrows"), path((0, 0, 0), turn=(0, 0, 0, 7)))
    np.testing.assert_allclose(bench.xyz("poses")[0, 1], (10, 0.3, 0), atol=1e-6)


def test_an_empty_path_is_named(turned: Benches) -> None:
    bench = turned(Path(), path((0, 0, 0), (1, 0, 0)), path())
    assert bench.nodes() == {}
    assert bench.statuses()["Path"] == ("WARN", "The path is empty. Check the planner's log.")


def test_a_single_pose_draws_no_line(turned: Benches) -> None:
    bench = turned(Path(), path((0, 0, 0)))
    assert bench.statuses()["Path"][0] == "WARN"
    bench.set("pose_style", "Axes")
    assert bench.statuses()["Path"] == ("OK", "Showing 1 pose.")


@pytest.mark.parametrize("bad", [NAN, INF, -INF, 1e300])
def test_a_path_with_a_bad_position_is_refused_with_its_index(turned: Benches, bad: float) -> None:
    bench = turned(Path(), path((0, 0, 0), (1, 0, 0), (2, bad, 0), (bad, 0, 0)))
    assert bench.nodes() == {}
    level, text = bench.statuses()["Path"]
    assert level == "ERROR"
    assert text.startswith(f"Pose 2 of 4 has position (2, {bad:g}, 0)")
    assert "1 more" in text


def test_a_path_with_a_bad_orientation_is_refused(turned: Benches) -> None:
    bench = turned(Path(), path((0, 0, 0), (1, 0, 0), turn=(0, 0, NAN, 1)))
    assert bench.nodes() == {}
    assert bench.statuses()["Path"][1].startswith("Pose 0 of 2")


def test_far_from_the_origin_a_path_keeps_its_millimetres(turned: Benches) -> None:
    east, north = 448_262.123, 5_411_932.456
    bench = turned(Path(), path((east, north, 0), (east + 0.25, north, 0)))
    expected = [[(10 - north, east, 0), (10 - north, east + 0.25, 0)]]
    np.testing.assert_allclose(bench.xyz("line"), expected, atol=1e-4, rtol=0)


class TestPath(BuiltInChecks):
    display = Path
    scene = paths
    variants = (
        Path,
        lambda: Path(line_style="Billboards", pose_style="Axes"),
        lambda: Path(pose_style="Arrows"),
    )
    later = ("buffer_length",)


def test_selecting_pose_of_a_path(bench: Benches) -> None:
    at = bench(Path(pose_style="Arrows"))
    at.transform("map", "odom", (10.0, 0.0, 0.0))
    places = [{"x": float(i), "y": 1.0} for i in range(3)]
    poses = [
        {"header": {"stamp": {"sec": 7 + i}}, "pose": {"position": place}}
        for i, place in enumerate(places)
    ]
    at.send("nav_msgs/msg/Path", {"poses": poses}, frame="odom")
    at.turn()
    assert at.pick("line", 1) == at.pick("poses", 1)
    check_details(
        at.pick("poses", 2), "Pose 2", {"Poses in the path": "3", "Stamp of the pose": "9.000000 s"}
    )
