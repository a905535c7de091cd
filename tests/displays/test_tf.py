"""The TF display: frames to batched nodes, and how they age."""

import numpy as np
import pytest

from webviz import Arrows, Labels, Lines
from webviz import Axes as AxesNode
from webviz_displays.tf import TF

SECOND = 1_000_000_000


def near(at, key):
    """Positions of a node's batch in the fixed frame."""
    node, base = at.nodes()[key], np.array(at.poses()[key].position)
    return (node.positions if hasattr(node, "positions") else node.segments) + base


def age_one_frame(at, seconds: float) -> None:
    """A frame published once, so long ago."""
    at.transform("map", "robot", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    at.turn(seconds)


def test_every_frame_has_axes_where_it_is(bench) -> None:
    at = bench(TF())
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


def test_arrows_point_from_child_to_parent_in_the_colours_of_rviz(bench) -> None:
    at = bench(TF())
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    shafts, heads = at.nodes()["shafts"], at.nodes()["heads"]
    assert isinstance(shafts, Lines)
    assert isinstance(heads, Arrows)
    assert near(at, "shafts")[0] == pytest.approx(np.array([(1.0, 0, 0), (0.1, 0, 0)]))
    assert near(at, "heads")[0] == pytest.approx(np.array([(0.1, 0, 0), (0.0, 0, 0)]), abs=1e-6)
    assert np.abs(np.array(shafts.colors) - (204, 204, 76.5)).max() <= 0.5
    assert np.abs(np.array(heads.colors) - (255, 25.5, 153)).max() <= 0.5
    assert (shafts.width, shafts.unit) == (0.01, "m")
    assert (heads.head_radius, heads.head_length) == (0.02, 0.1)


@pytest.mark.parametrize(("distance", "has_arrow"), [(0.0, False), (0.001, False), (0.0011, True)])
def test_a_frame_within_a_millimetre_of_its_parent_has_no_arrow(bench, distance, has_arrow) -> None:
    at = bench(TF())
    at.transform("map", "odom", (distance, 0.0, 0.0))
    at.turn()
    assert ("shafts" in at.nodes()) == has_arrow


def test_an_arrow_shorter_than_a_head_has_a_flat_head_and_stays_between_its_frames(bench) -> None:
    at = bench(TF())
    at.transform("map", "near", (0.05, 0.0, 0.0))
    at.transform("map", "far", (0.5, 0.0, 0.0))
    at.turn()
    assert len(at.nodes()["heads"].segments) == 1
    assert at.nodes()["short heads"].head_length == pytest.approx(0.005)
    tail, tip = near(at, "short heads")[0]
    assert tail == pytest.approx((0.005, 0, 0), abs=1e-6)
    assert tip == pytest.approx((0, 0, 0), abs=1e-6)


def test_names_are_drawn_only_when_wanted_and_below_their_frames(bench) -> None:
    at = bench(TF(marker_scale=2.0))
    at.transform("map", "odom", (1.0, 0.0, 3.0))
    at.turn()
    assert "names" not in at.nodes()
    at.set("show_names", True)
    labels = at.nodes()["names"]
    assert isinstance(labels, Labels)
    places = dict(zip(labels.texts, near(at, "names").tolist(), strict=True))
    assert places["odom"] == pytest.approx([1.0, 0.0, 2.8])
    assert labels.height == pytest.approx(0.2)


def test_each_kind_of_mark_has_its_switch(bench) -> None:
    at = bench(TF())
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    at.set("show_axes", False)
    assert set(at.nodes()) == {"shafts", "heads"}
    at.set("show_arrows", False)
    assert at.nodes() == {}


def test_marker_scale_scales_everything(bench) -> None:
    at = bench(TF(marker_scale=0.5))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    assert at.nodes()["axes"].length == pytest.approx(0.1)
    assert at.nodes()["shafts"].width == pytest.approx(0.005)
    assert at.nodes()["heads"].head_length == pytest.approx(0.05)


@pytest.mark.parametrize(
    ("age", "red"),
    [
        (7.5, (217, 89, 89)),  # half way to grey 0.7
        (10.0, (178, 178, 178)),
        (12.5, (113, 113, 113)),  # half of it, and half of RViz's background, 48
    ],
)
def test_an_ageing_frame_fades(bench, age, red) -> None:
    at = bench(TF(frame_timeout=15.0, frames={"map": False}))
    age_one_frame(at, age)
    lines = at.nodes()["ageing axes"]
    assert "axes" not in at.nodes()
    assert isinstance(lines, Lines)
    assert lines.segments.shape == (3, 2, 3)
    colors = np.array(lines.colors, int)
    assert np.abs(colors[0] - red).max() <= 1
    assert (colors[:, 0] == colors[:, 1]).all()
    assert near(at, "ageing axes")[1] == pytest.approx(np.array([(1, 0, 0), (1, 0.2, 0)]))


def test_a_fresh_frame_has_its_colours(bench) -> None:
    at = bench(TF(frames={"map": False}))
    age_one_frame(at, 4.9)
    assert "axes" in at.nodes()
    assert "ageing axes" not in at.nodes()


def test_a_frame_beyond_the_timeout_is_hidden_counted_and_comes_back(bench) -> None:
    at = bench(TF(frame_timeout=15.0))
    age_one_frame(at, 15.1)
    assert near(at, "axes").tolist() == [[0.0, 0.0, 0.0]]
    assert "ageing axes" not in at.nodes()
    level, text = at.statuses()["Frames"]
    assert level == "WARN"
    assert text == "1 of 2 frames shown, 1 not updated for more than 15 s."
    at.transform("map", "robot", (1.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    assert len(near(at, "axes")) == 2
    assert at.statuses()["Frames"] == ("OK", "2 frames shown.")


def test_while_ros_time_stands_still_nothing_ages(bench) -> None:
    at = bench(TF())
    age_one_frame(at, 0.0)
    for _ in range(3):
        at.turn(0.0)
    assert len(at.nodes()["axes"].positions) == 2


def test_static_frames_never_age(bench) -> None:
    at = bench(TF(frame_timeout=1.0))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    at.turn(1e5)
    assert len(at.nodes()["axes"].positions) == 2


@pytest.mark.parametrize(
    ("properties", "shown"),
    [
        ({}, {"map", "left_wheel", "right_wheel"}),
        ({"filter_whitelist": "wheel$"}, {"left_wheel", "right_wheel"}),
        ({"filter_blacklist": "^left"}, {"map", "right_wheel"}),
        ({"filter_whitelist": "wheel", "filter_blacklist": "right"}, {"left_wheel"}),
        ({"frames": {"map": False}}, {"left_wheel", "right_wheel"}),
        ({"all_enabled": False, "frames": {"map": True}}, {"map"}),
    ],
)
def test_filters_and_switches_choose_the_frames(bench, properties, shown) -> None:
    at = bench(TF(show_names=True, **properties))
    at.transform("map", "left_wheel", (0.0, 1.0, 0.0))
    at.transform("map", "right_wheel", (0.0, -1.0, 0.0))
    at.turn()
    assert set(at.nodes()["names"].texts) == shown


def test_a_frame_that_appears_later_goes_through_the_filters_too(bench) -> None:
    at = bench(TF(show_names=True, filter_blacklist="wheel"))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    at.transform("odom", "wheel", (1.0, 0.0, 0.0))
    at.turn()
    assert set(at.nodes()["names"].texts) == {"map", "odom"}
    at.set("filter_blacklist", "")
    assert set(at.nodes()["names"].texts) == {"map", "odom", "wheel"}


def test_a_bad_regular_expression_is_said_and_ignored(bench) -> None:
    at = bench(TF(filter_whitelist="(", filter_blacklist="map"))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    level, text = at.statuses()["Filter (whitelist)"]
    assert level == "ERROR"
    assert "'(' is no regular expression" in text
    assert len(at.nodes()["axes"].positions) == 1
    at.set("filter_whitelist", "odom")
    assert "Filter (whitelist)" not in at.statuses()


def test_without_any_transform_the_topic_to_look_at_is_named(bench) -> None:
    at = bench(TF())
    at.turn()
    level, text = at.statuses()["Frames"]
    assert level == "WARN"
    assert "/tf" in text


def test_with_everything_switched_off_it_is_not_ok(bench) -> None:
    at = bench(TF(all_enabled=False))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    assert at.nodes() == {}
    assert at.statuses()["Frames"] == (
        "WARN",
        "0 of 2 frames shown, 2 switched off or filtered out.",
    )


def test_frames_of_another_tree_are_named_and_not_drawn(bench) -> None:
    at = bench(TF())
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.transform("camera", "lens", (1.0, 0.0, 0.0))
    at.turn()
    assert len(at.nodes()["axes"].positions) == 2
    statuses = at.statuses()
    assert statuses["Frames"] == ("WARN", "2 of 4 frames shown, 2 have no transform to 'map'.")
    assert statuses["lens"][0] == "WARN"
    assert statuses["camera"][0] == "WARN"


def test_many_lost_frames_are_counted_and_only_a_few_named(bench) -> None:
    at = bench(TF())
    at.transform("map", "odom")
    for number in range(20):
        at.transform("elsewhere", f"lost_{number}")
    at.turn()
    statuses = at.statuses()
    assert len([key for key in statuses if key.startswith(("lost", "elsewhere"))]) == 5
    assert "21 have no transform" in statuses["Frames"][1]


def test_an_arrow_leads_to_the_new_parent_when_a_frame_changes_it(bench) -> None:
    at = bench(TF())
    at.transform("map", "shelf", (0.0, 5.0, 0.0))
    at.transform("map", "box", (3.0, 0.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    at.transform("shelf", "box", (3.0, 0.0, 0.0), stamp_ns=at.now_ns + 1)
    at.turn(0.1)
    tips = {tuple(np.round(tip, 3)) for tip in near(at, "heads")[:, 1].tolist()}
    assert tips == {(0.0, 0.0, 0.0), (0.0, 5.0, 0.0)}


def test_far_from_the_origin_a_millimetre_is_not_lost(bench) -> None:
    at = bench(TF(), fixed_frame="utm")
    x = 691_603.125
    at.transform("utm", "robot", (x, 5_334_760.375, 0.0))
    at.transform("robot", "sensor", (0.001_953_125, 0.0, 0.0))
    at.set("frames", {"utm": False})
    xs = sorted(near(at, "axes")[:, 0].tolist())
    assert xs == pytest.approx([x, x + 0.001_953_125], abs=1e-5)


def test_between_updates_the_picture_stays(bench) -> None:
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


def test_a_new_fixed_frame_places_all_frames_anew_without_making_them_young(bench) -> None:
    at = bench(TF(show_names=True))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.transform("odom", "robot", (0.0, 1.0, 0.0), stamp_ns=at.now_ns)
    at.turn()
    at.turn(7.5)
    at.fixed_frame = "odom"
    at.turn()
    places = dict(zip(at.nodes()["names"].texts, near(at, "names").tolist(), strict=True))
    assert places["map"] == pytest.approx([-1.0, 0.0, -0.1])
    assert len(at.nodes()["ageing axes"].segments) == 3
