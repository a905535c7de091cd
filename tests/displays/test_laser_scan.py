import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import scans
from inspecting import Benches, check_empty, colors

from webviz.api.nodes import Instances, Lines, Points
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.laser_scan import LaserScan

SCAN = "sensor_msgs/msg/LaserScan"
SECOND = 1_000_000_000
NAN, INF = float("nan"), float("inf")


def scan(ranges: list[float], **values: Any) -> dict[str, Any]:
    """Beams to the front, left, back and right."""
    return {
        "angle_increment": np.pi / 2,
        "range_min": 0.1,
        "range_max": 10.0,
        "ranges": ranges,
        **values,
    }


@pytest.fixture
def lab(sensed: Benches) -> Callable[..., Any]:
    """Make a bench that has drawn one scan."""
    return lambda values, **properties: sensed(LaserScan(**properties), values)


def test_beams_become_points_in_the_frame_of_the_laser(lab: Benches) -> None:
    bench = lab(scan([1, 2, 3, 4]))
    node = bench.nodes()["points"]
    expected = [(1, 0, 1), (0, 2, 1), (-3, 0, 1), (0, -4, 1)]
    np.testing.assert_allclose(bench.xyz("points"), expected, atol=1e-6)
    assert (node.size, node.shape) == (0.01, "square")
    assert bench.statuses()["Points"] == ("OK", "Showing 4 of 4 points.")


def test_a_range_counts_from_range_min_to_just_below_range_max(lab: Benches) -> None:
    bench = lab(scan([0.5, 0.49, 7.99, 8.0, NAN, INF, -INF], range_min=0.5, range_max=8.0))
    lengths = np.linalg.norm(bench.xyz("points") - (0, 0, 1), axis=1)
    np.testing.assert_allclose(lengths, [0.5, 7.99], rtol=1e-6)
    assert bench.statuses()["Points"] == (
        "OK",
        "Showing 2 of 7 points; dropped 5: 1 NaN, 2 infinite, "
        "1 nearer than range_min (0.5 m), 1 not nearer than range_max (8 m).",
    )


@pytest.mark.parametrize(
    ("values", "level", "words"),
    [
        (scan([]), "ERROR", "no ranges"),
        (scan([NAN, INF]), "WARN", "Showing 0 of 2"),
        (scan([0.0]), "WARN", "range_min"),
        (scan([1.0, 1.0], range_max=0.1), "ERROR", "range_max (0.1 m) is not greater"),
        (scan([1.0, 1.0], range_min=5.0, range_max=-5.0), "ERROR", "range_max"),
        (scan([1.0], range_min=NAN), "ERROR", "range_min is nan"),
        (scan([1.0], range_max=NAN), "ERROR", "range_max is nan"),
        (scan([1.0, 1.0], angle_increment=NAN), "ERROR", "angle_increment is nan"),
        (scan([1.0, 1.0], angle_increment=INF), "ERROR", "angle_increment is inf"),
        (scan([1.0], angle_min=NAN), "ERROR", "angle_min is nan"),
        (scan([1.0], angle_min=-3e38), "ERROR", "angle_min is -3e+38 rad"),
        (scan([1.0], angle_increment=3e38), "ERROR", "expected a number from -6.28319 to"),
        (scan([1e30], range_max=INF), "WARN", "Showing 0 of 1"),
        (scan([-INF], range_min=-INF), "WARN", "1 infinite"),
    ],
)
def test_a_scan_without_points_has_a_status(
    lab: Benches, values: dict[str, Any], level: str, words: str
) -> None:
    bench = lab(values)
    check_empty(bench, level, words)


def test_beams_on_one_line_are_shown_with_a_warning(lab: Benches) -> None:
    bench = lab(scan([1, 2, 3], angle_increment=0.0))
    assert len(bench.nodes()["points"].xyz) == 3
    assert bench.statuses()["Angles"][0] == "WARN"


def test_a_scan_without_frame_is_refused_by_name(bench: Benches) -> None:
    at = bench(LaserScan())
    at.send(SCAN, scan([1.0]), frame="")
    at.turn()
    assert not at.nodes()
    assert {level for level, _ in at.statuses().values()} & {"WARN", "ERROR"}


# Colours


RED, GREEN, MAGENTA = [255, 0, 0], [0, 255, 0], [255, 0, 255]


def test_intensities_are_a_rainbow_from_red_to_magenta(lab: Benches) -> None:
    assert colors(lab(scan([1, 1, 1], intensities=[10, 14, 20]))) == [RED, GREEN, MAGENTA]


def test_colours_belong_to_the_points_that_are_left(lab: Benches) -> None:
    assert colors(lab(scan([1, NAN, 1], intensities=[10, 14, 20]))) == [RED, MAGENTA]


def test_equal_intensities_are_red(lab: Benches) -> None:
    assert colors(lab(scan([1, 1], intensities=[7, 7]))) == [RED, RED]


def test_bounds_may_be_given(lab: Benches) -> None:
    bench = lab(
        scan([1, 1, 1], intensities=[-5, 4, 99]),
        autocompute_intensity_bounds=False,
        min_intensity=0.0,
        max_intensity=10.0,
    )
    assert colors(bench) == [RED, GREEN, MAGENTA]


def test_two_colours_instead_of_the_rainbow(lab: Benches) -> None:
    bench = lab(scan([1, 1, 1], intensities=[0, 1, 2]), use_rainbow=False, min_color=(0, 0, 100))
    assert colors(bench) == [[0, 0, 100], [128, 128, 178], [255, 255, 255]]


def test_an_intensity_that_is_nan_has_the_lowest_colour(lab: Benches) -> None:
    assert colors(lab(scan([1, 1, 1], intensities=[NAN, 14, 20])))[0] == RED


def test_a_signalling_nan_is_a_beam_without_range_and_no_warning(lab: Benches) -> None:
    ranges = np.frombuffer(b"\x01\x00\xa0\x7f" + np.float32(1.0).tobytes(), np.float32)
    assert len(lab(scan([]) | {"ranges": ranges}).xyz("points")) == 1


def test_without_intensities_colours_show_the_range_with_a_status(lab: Benches) -> None:
    bench = lab(scan([1, 1.8, 3]))
    assert colors(bench) == [RED, GREEN, MAGENTA]
    assert "colouring by range" in bench.statuses()["Intensity"][1]


def test_intensities_of_another_number_are_not_used_and_named(lab: Benches) -> None:
    bench = lab(scan([1, 1.8, 3], intensities=[1, 2]))
    assert colors(bench) == [RED, GREEN, MAGENTA]
    level, text = bench.statuses()["Intensity"]
    assert level == "WARN"
    assert "2 intensities for 3 ranges" in text


def test_axis_colour_is_of_the_fixed_frame_or_of_the_laser(bench: Benches) -> None:
    at = bench(LaserScan(color_transformer="AxisColor", axis="Z"))
    # The laser lies on its side: its y points up.
    at.transform("map", "laser", (0, 0, 0), (np.sqrt(0.5), 0, 0, np.sqrt(0.5)))
    at.send(SCAN, scan([1, 1, 1, 1]), frame="laser")
    at.turn()
    assert colors(at)[1] == MAGENTA
    assert colors(at)[3] == RED
    at.set("use_fixed_frame", False)  # all z are 0 there, up to rounding
    assert colors(at) == [RED] * 4
    at.set("autocompute_value_bounds", {"value": False, "min_value": -10.0, "max_value": 15.0})
    assert colors(at) == [GREEN] * 4


def test_flat_points_are_really_transparent(lab: Benches) -> None:
    bench = lab(scan([1]), color_transformer="FlatColor", color=(248, 48, 48), alpha=0.5)
    points = bench.nodes()["points"]
    assert (points.colors, points.opacity) == ((248, 48, 48), 0.5)


# Styles


@pytest.mark.parametrize(
    ("style", "shape"), [("Spheres", "sphere"), ("Boxes", "box"), ("Tiles", "square")]
)
def test_spheres_boxes_and_tiles_are_really_transparent(
    lab: Benches, style: str, shape: str
) -> None:
    bench = lab(
        scan([1, 2]),
        style=style,
        size=0.2,
        alpha=0.5,
        color_transformer="FlatColor",
        color=(1, 2, 3),
    )
    node = bench.nodes()["solids"]
    assert isinstance(node, Instances)
    assert (node.shape, node.opacity) == (shape, 0.5)
    np.testing.assert_allclose(bench.xyz("solids"), [(1, 0, 1), (0, 2, 1)], atol=1e-6)
    np.testing.assert_allclose(node.scales, 0.2)
    assert node.colors == (1, 2, 3)


def test_beams_over_the_limit_are_dropped_and_counted(
    lab: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz_displays.laser_scan.beams.MAX_BEAMS", 3)
    bench = lab(scan([1, 2, 3, NAN, 4, 5], intensities=[1, 2, 3, 4, 5, 6]))
    assert len(bench.nodes()["points"].xyz) == 3
    assert bench.statuses()["Points"][1].endswith("dropped 3: 1 NaN, 2 over the limit of 3.")


def test_boxes_stand_upright_in_the_fixed_frame_however_the_laser_is_tilted(bench: Benches) -> None:
    at = bench(LaserScan(style="Boxes"))
    at.transform("map", "laser", (1.0, 0.0, 0.0), (0.5, 0.5, 0.5, 0.5))
    at.send(SCAN, scan([1, 1]), frame="laser")
    at.turn()
    np.testing.assert_allclose(np.abs(at.nodes()["solids"].wxyzs), [(1, 0, 0, 0)] * 2, atol=1e-6)


def test_points_have_their_size_in_pixels(lab: Benches) -> None:
    node = lab(scan([1, 2]), style="Points", size_pixels=5.0).nodes()["points"]
    assert isinstance(node, Lines)
    assert (node.width, node.unit) == (5.0, "px")
    np.testing.assert_allclose(node.segments.mean(axis=1), [(1, 0, 1), (0, 2, 1)], atol=1e-6)
    assert np.ptp(node.segments, axis=1).max() < 1e-3


def test_a_style_that_viser_has_not_is_named(lab: Benches) -> None:
    bench = lab(scan([1]), style="Squares")
    assert isinstance(bench.nodes()["points"], Points)
    assert bench.statuses()["Style"][1].startswith("Squares are drawn as")


# Time


def moving(bench: Benches, **properties: Any) -> DisplayBench:
    """A bench whose laser moves along y by 1 m each second."""
    at = bench(LaserScan(**properties))
    start = at.now_ns
    for tenth in range(11):
        stamp_ns = start + tenth * SECOND // 10
        at.transform("map", "laser", (0.0, tenth / 10, 0.0), stamp_ns=stamp_ns)
    return at


FIVE_TO_THE_FRONT = scan([2.0] * 5, angle_increment=1e-9, time_increment=0.125)


def test_each_beam_is_placed_where_the_laser_was_at_its_time(bench: Benches) -> None:
    cloud = moving(bench)
    stamp_ns = cloud.now_ns + SECOND // 2
    cloud.send(SCAN, FIVE_TO_THE_FRONT, frame="laser", stamp_ns=stamp_ns)
    cloud.turn()
    expected = [(2, 0.5, 0), (2, 0.625, 0), (2, 0.75, 0), (2, 0.875, 0), (2, 1, 0)]
    np.testing.assert_allclose(cloud.xyz("points"), expected, atol=1e-6)
    cloud.set("deskew", "As measured")
    np.testing.assert_allclose(cloud.xyz("points"), [(2, 0.5, 0)] * 5, atol=1e-6)


def test_a_turning_laser_straightens_a_wall(bench: Benches) -> None:
    at = bench(LaserScan())
    for i in range(11):  # it turns by 0.5 rad in 1 s
        turn = (0.0, 0.0, np.sin(0.025 * i), np.cos(0.025 * i))
        stamp_ns = at.now_ns + i * SECOND // 10
        at.transform("map", "laser", (0, 0, 0), turn, stamp_ns=stamp_ns)
    angles = np.linspace(-0.5, 0.5, 21)
    apart = 3 / 64  # seconds between beams, exact in float32
    facing = angles + 0.5 * np.arange(21) * apart  # of each beam in the map
    ranges = (3 / np.cos(facing)).tolist()
    values = scan(ranges, angle_min=-0.5, angle_increment=0.05, time_increment=apart)
    at.send(SCAN, values, frame="laser")
    at.turn()
    np.testing.assert_allclose(at.xyz("points")[:, 0], 3.0, atol=1e-5)
    at.set("deskew", "As measured")
    assert np.ptp(at.xyz("points")[:, 0]) > 0.5


@pytest.mark.parametrize("time_increment", [0.125, 0.5], ids=["half a second", "two seconds"])
def test_a_scan_waits_for_the_transform_of_its_last_beam(
    bench: Benches, time_increment: float
) -> None:
    at = bench(LaserScan())
    start = at.now_ns
    lasts_ns = round(4 * time_increment * SECOND)
    at.transform("map", "laser", (0.0, 0.0, 0.0), stamp_ns=start)
    at.transform("map", "laser", (0.0, 1.0, 0.0), stamp_ns=start + lasts_ns - 1)
    values = scan([2.0] * 5, angle_increment=1e-9, time_increment=time_increment)
    at.send(SCAN, values, frame="laser", stamp_ns=start)
    at.turn()
    assert not at.nodes()
    at.transform("map", "laser", (0.0, 1.0, 0.0), stamp_ns=start + lasts_ns)
    at.turn()
    np.testing.assert_allclose(at.xyz("points")[:, 1], [0, 0.25, 0.5, 0.75, 1], atol=1e-6)
    assert "De-skew" not in at.statuses()


def test_beams_of_an_endless_scan_without_a_transform_are_counted(bench: Benches) -> None:
    cloud = moving(bench)
    stamp_ns = cloud.now_ns + 3 * SECOND // 4
    values = scan([2.0] * 101, angle_increment=1e-9, time_increment=0.125)
    cloud.send(SCAN, values, frame="laser", stamp_ns=stamp_ns)
    cloud.turn()
    expected = [0.75, 0.875] + [1.0] * 99
    np.testing.assert_allclose(cloud.xyz("points")[:, 1], expected, atol=1e-6)
    level, text = cloud.statuses()["De-skew"]
    assert level == "WARN"
    assert text.startswith("98 of 101 beams")


@pytest.mark.parametrize("time_increment", [NAN, INF, 1e30, -1e30])
def test_a_time_increment_without_sense_counts_as_zero(
    bench: Benches, time_increment: float
) -> None:
    cloud = moving(bench)
    values = {**FIVE_TO_THE_FRONT, "time_increment": time_increment}
    cloud.send(SCAN, values, frame="laser")
    cloud.turn()
    np.testing.assert_allclose(cloud.xyz("points")[:, 1], 0, atol=1e-6)
    assert cloud.statuses()["Scan Time"][0] == "WARN"


def test_a_scan_that_takes_long_is_doubted(lab: Benches) -> None:
    values = scan([1, 1, 1], time_increment=0.6)
    assert "takes 1.2 s" in lab(values, deskew="As measured").statuses()["Scan Time"][1]


def test_scans_decay_by_the_time_they_arrived(bench: Benches) -> None:
    at = bench(LaserScan(decay_time=1.0))
    at.transform("map", "laser")
    for _ in range(4):
        at.send(SCAN, scan([1, 2]), frame="laser")
        at.turn(0.4)
    assert len(at.nodes()) == 2
    at.set("decay_time", 0.0)
    assert len(at.nodes()) == 1
    at.turn(100.0)
    assert len(at.nodes()) == 1


class TestLaserScan(BuiltInChecks):
    display = LaserScan
    scene = scans
    variants = (
        LaserScan,
        lambda: LaserScan(color_transformer="AxisColor", style="Boxes", decay_time=1.0),
    )


def test_selecting_beam_of_a_scan(bench: Benches) -> None:
    at = bench(LaserScan())
    at.transform("map", "laser")
    scan = {"angle_min": -0.5, "angle_increment": 0.25, "range_min": 0.1, "range_max": 10.0}
    ranges = {"ranges": [math.nan, 2.3, math.inf, 0.7, 20.0], "intensities": [1, 2, 3, 4.2, 5]}
    at.send("sensor_msgs/msg/LaserScan", scan | ranges, frame="laser")
    at.turn()
    check_details(
        at.pick("points", 1),
        "Beam 3",
        {
            "Range": "0.7 m",
            "Intensity": "4.2",
            "Angle": "0.250000 rad, 14.32°",
            "Beams in the scan": "5",
        },
    )
