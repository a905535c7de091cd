"""The TF display: frames to batched nodes, and how they age."""

from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import frames
from inspecting import QUARTER, Benches
from numpy.typing import NDArray

from webviz import Axes as AxesNode
from webviz import Instances, Labels
from webviz.data.rotations import matrices
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.tf import TF

SECOND = 1_000_000_000


def near(at: DisplayBench, key: str) -> NDArray[np.float64]:
    """Positions of a node's batch in the fixed frame."""
    node, base = at.nodes()[key], np.array(at.poses()[key].position)
    return (node.positions if hasattr(node, "positions") else node.segments) + base


def ends(at: DisplayBench, key: str) -> NDArray[np.float64]:
    """Tails and tips (N, 2, 3) of rods in the fixed frame."""
    node = at.nodes()[key]
    half = node.scales[:, 2:] / 2 * matrices(node.wxyzs)[:, :, 2]
    return np.stack((near(at, key) - half, near(at, key) + half), axis=1)


def age_one_frame(at: DisplayBench, seconds: float) -> None:
    """A frame published once, so long ago."""
    at.transform("map", "robot", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    at.turn(seconds)


@pytest.fixture
def at(bench: Benches) -> DisplayBench:
    """The bench of the TF display."""
    return bench(TF())


def test_every_frame_has_axes_where_it_is(at: DisplayBench) -> None:
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.transform("odom", "robot", (0.0, 2.0, 0.0), (0.0, 0.0, 1.0, 0.0))
    at.turn()
    axes = at.nodes()["axes"]
    assert isinstance(axes, AxesNode)
    positions = {tuple(p) for p in near(at, "axes").tolist()}
    assert positions == {(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (1.0, 2.0, 0.0)}
    assert sorted(np.abs(axes.wxyzs).tolist()) == [[0, 0, 0, 1], [1, 0, 0, 0], [1, 0, 0, 0]]
    assert (axes.length, axes.radius) == (0.2, 0.01)
    assert at.statuses()["Frames"] == ("OK", "3 frames shown.")


def test_arrows_point_from_child_to_parent_in_the_colours_of_rviz(at: DisplayBench) -> None:
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    shafts, heads = at.nodes()["shafts"], at.nodes()["heads"]
    assert isinstance(shafts, Instances)
    assert isinstance(heads, Instances)
    assert (shafts.shape, heads.shape) == ("cylinder", "cone")
    assert ends(at, "shafts")[0] == pytest.approx(np.array([(1.0, 0, 0), (0.1, 0, 0)]), abs=1e-6)
    assert ends(at, "heads")[0] == pytest.approx(np.array([(0.1, 0, 0), (0.0, 0, 0)]), abs=1e-6)
    assert np.abs(np.array(shafts.colors) - (204, 204, 76.5)).max() <= 0.5
    assert np.abs(np.array(heads.colors) - (255, 25.5, 153)).max() <= 0.5
    assert shafts.scales[0] == pytest.approx([0.01, 0.01, 0.9])
    assert heads.scales[0] == pytest.approx([0.04, 0.04, 0.1])
    assert (shafts.opacity, heads.opacity) == (1.0, 1.0)


@pytest.mark.parametrize(("distance", "has_arrow"), [(0.0, False), (0.001, False), (0.0011, True)])
def test_a_frame_within_a_millimetre_of_its_parent_has_no_arrow(
    at: DisplayBench, distance: float, has_arrow: bool
) -> None:
    at.transform("map", "odom", (distance, 0.0, 0.0))
    at.turn()
    assert ("shafts" in at.nodes()) == has_arrow


def test_an_arrow_shorter_than_a_head_has_a_flat_head_and_stays_between_its_frames(
    at: DisplayBench,
) -> None:
    for name, distance in (("near", 0.05), ("nearer", 0.01), ("far", 0.5)):
        at.transform("map", name, (0.0, 0.0, distance))
    at.turn()
    tails, tips = ends(at, "heads").swapaxes(0, 1)
    assert np.sort(tails[:, 2]) == pytest.approx((0.001, 0.005, 0.1), abs=1e-6)
    assert tips == pytest.approx(np.zeros((3, 3)), abs=1e-6)
    assert np.sort(ends(at, "shafts")[:, 0, 2]) == pytest.approx((0.01, 0.05, 0.5), abs=1e-6)


def test_names_are_drawn_below_their_frames_when_enabled(bench: Benches) -> None:
    at = bench(TF(marker_scale=2.0))
    at.transform("map", "odom", (1.0, 0.0, 3.0))
    at.turn()
    assert "names" not in at.nodes()
    at.set("show_names", True)
    labels = at.nodes()["names"]
    assert isinstance(labels, Labels)
    places = dict(zip(labels.texts, near(at, "names").tolist(), strict=True))
    assert places["odom"] == pytest.approx([1.0, 0.0, 3.0])
    assert labels.below
    assert labels.height == pytest.approx(0.2)


def test_each_kind_of_mark_has_its_switch(at: DisplayBench) -> None:
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    at.set("show_axes", False)
    assert set(at.nodes()) == {"shafts", "heads"}
    at.set("show_arrows", False)
    assert at.nodes() == {}


def test_marker_scale_scales_everything(bench: Benches) -> None:
    at = bench(TF(marker_scale=0.5))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    assert at.nodes()["axes"].length == pytest.approx(0.1)
    assert at.nodes()["shafts"].scales[0] == pytest.approx([0.005, 0.005, 0.95])
    assert at.nodes()["heads"].scales[0] == pytest.approx([0.02, 0.02, 0.05])


@pytest.mark.parametrize(
    ("age", "red", "opacity"),
    [
        (7.5, (217, 89, 89), 1.0),  # half way to grey 0.7
        (10.0, (178, 178, 178), 1.0),
        (12.5, (178, 178, 178), 0.5),
    ],
)
def test_an_ageing_frame_fades(
    bench: Benches, age: float, red: tuple[int, int, int], opacity: float
) -> None:
    at = bench(TF(frame_timeout=15.0, frames={"map": False}))
    age_one_frame(at, age)
    faint = "faint " if opacity < 1.0 else ""
    assert set(at.nodes()) == {f"{faint}old axes", f"{faint}shafts", f"{faint}heads"}
    for node in at.nodes().values():
        assert np.asarray(node.opacity) == pytest.approx(opacity)
        assert len(node.positions)
    axes = at.nodes()[f"{faint}old axes"]
    assert np.abs(axes.colors[0].astype(int) - red).max() <= 1
    expected = np.array([(1, 0, 0), (1, 0.2, 0)])
    assert ends(at, f"{faint}old axes")[1] == pytest.approx(expected, abs=1e-6)


def test_a_fresh_frame_has_its_colours(bench: Benches) -> None:
    at = bench(TF(frames={"map": False}))
    age_one_frame(at, 4.9)
    assert "axes" in at.nodes()
    assert "old axes" not in at.nodes()


def test_a_frame_beyond_the_timeout_is_hidden_counted_and_comes_back(
    bench: Benches,
) -> None:
    at = bench(TF(frame_timeout=15.0))
    age_one_frame(at, 15.1)
    assert near(at, "axes").tolist() == [[0.0, 0.0, 0.0]]
    assert "old axes" not in at.nodes()
    level, text = at.statuses()["Frames"]
    assert level == "WARN"
    assert text == "1 of 2 frames shown, 1 not updated for more than 15 s."
    at.transform("map", "robot", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    assert len(near(at, "axes")) == 2
    assert at.statuses()["Frames"] == ("OK", "2 frames shown.")


def test_while_ros_time_stands_still_nothing_ages(at: DisplayBench) -> None:
    age_one_frame(at, 0.0)
    for _ in range(3):
        at.turn(0.0)
    assert len(at.nodes()["axes"].positions) == 2


def test_static_frames_never_age(bench: Benches) -> None:
    at = bench(TF(frame_timeout=1.0))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    at.turn(1e5)
    assert len(at.nodes()["axes"].positions) == 2


@pytest.mark.parametrize(
    ("properties", "names"),
    [
        ({}, {"map", "left_wheel", "right_wheel"}),
        ({"filter_whitelist": "wheel$"}, {"left_wheel", "right_wheel"}),
        ({"filter_blacklist": "^left"}, {"map", "right_wheel"}),
        ({"filter_whitelist": "wheel", "filter_blacklist": "right"}, {"left_wheel"}),
        ({"frames": {"map": False}}, {"left_wheel", "right_wheel"}),
        ({"all_enabled": False, "frames": {"map": True}}, {"map"}),
    ],
)
def test_filters_and_switches_choose_the_frames(
    bench: Benches, properties: dict[str, Any], names: set[str]
) -> None:
    at = bench(TF(show_names=True, **properties))
    at.transform("map", "left_wheel", (0.0, 1.0, 0.0))
    at.transform("map", "right_wheel", (0.0, -1.0, 0.0))
    at.turn()
    assert set(at.nodes()["names"].texts) == names


def test_a_frame_that_appears_later_goes_through_the_filters_too(bench: Benches) -> None:
    at = bench(TF(show_names=True, filter_blacklist="wheel"))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    at.transform("odom", "wheel", (1.0, 0.0, 0.0))
    at.turn()
    assert set(at.nodes()["names"].texts) == {"map", "odom"}
    at.set("filter_blacklist", "")
    assert set(at.nodes()["names"].texts) == {"map", "odom", "wheel"}


def test_an_arrow_leads_to_the_new_parent_when_a_frame_changes_it(at: DisplayBench) -> None:
    at.transform("map", "shelf", (0.0, 5.0, 0.0))
    at.transform("map", "box", (3.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    at.transform("shelf", "box", (3.0, 0.0, 0.0), stamp_ns=at.now_ns + 1)
    at.turn(0.1)
    tips = {tuple(np.round(tip, 3) + 0.0) for tip in ends(at, "heads")[:, 1].tolist()}
    assert tips == {(0.0, 0.0, 0.0), (0.0, 5.0, 0.0)}


def test_far_from_the_origin_a_millimetre_is_not_lost(bench: Benches) -> None:
    at = bench(TF(), fixed_frame="utm")
    x = 691_603.125
    at.transform("utm", "robot", (x, 5_334_760.375, 0.0))
    at.transform("robot", "sensor", (0.001_953_125, 0.0, 0.0))
    at.set("frames", {"utm": False})
    xs = sorted(near(at, "axes")[:, 0].tolist())
    assert xs == pytest.approx([x, x + 0.001_953_125], abs=1e-5)


def test_between_updates_the_picture_stays(bench: Benches) -> None:
    at = bench(TF(update_interval=1.0))
    at.transform("map", "odom", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    before = at.nodes()["axes"]
    at.transform("map", "odom", (2.0, 0.0, 0.0), stamp_ns=at.now_ns + SECOND // 2)
    at.turn(0.5)
    assert at.nodes()["axes"] is before
    assert at.statuses()["Frames"] == ("OK", "2 frames shown.")
    at.turn(0.5)
    assert at.nodes()["axes"] != before


def test_a_new_fixed_frame_moves_all_frames_and_keeps_their_age(bench: Benches) -> None:
    at = bench(TF(show_names=True))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.transform("odom", "robot", (0.0, 1.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    at.turn(7.5)
    at.fixed_frame = "odom"
    at.turn()
    places = dict(zip(at.nodes()["names"].texts, near(at, "names").tolist(), strict=True))
    assert places["map"] == pytest.approx([-1.0, 0.0, 0.0])
    assert len(at.nodes()["old axes"].positions) == 3


class TestTF(BuiltInChecks):
    display = TF
    scene = frames
    later = ("update_interval",)


def test_selecting_frame_of_a_tree(bench: Benches) -> None:
    at = bench(TF(show_arrows=False))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.transform("odom", "base", (0.0, 2.0, 0.0), QUARTER, stamp_ns=at.now_ns - 500_000_000)
    at.turn()
    (number,) = np.flatnonzero(at.nodes()["axes"].ids == "base")
    check_details(at.pick("axes", int(number)), "Frame base", {"Parent": "odom", "Age": "0.50 s"})
