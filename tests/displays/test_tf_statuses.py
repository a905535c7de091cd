"""Statuses of the TF display."""

import tracemalloc

import pytest
from inspecting import Benches

from webviz import OtherFixedFrame
from webviz.shell.testing import SECOND, DisplayBench
from webviz_displays.tf import TF


@pytest.fixture
def at(bench: Benches) -> DisplayBench:
    """The bench of the TF display."""
    return bench(TF())


def test_an_invalid_regular_expression_is_reported_and_ignored(bench: Benches) -> None:
    tf = TF(filter_whitelist="(", filter_blacklist="map")
    at = bench(tf)
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    level, text = at.statuses()["Filter (whitelist)"]
    assert level == "ERROR"
    assert "'(' is not a valid regular expression" in text
    assert len(at.nodes()["axes"].positions) == 1
    at.press("Filter (whitelist)")
    assert tf.filter_whitelist == ""


@pytest.mark.parametrize("text", ["(a+)+$", r"(\w+)*!", "^(a|aa)*$", "^((a?)+)+$", ".*.*.*.*x"])
def test_expressions_that_others_match_for_hours_are_answered_at_once(
    bench: Benches, text: str
) -> None:
    at = bench(TF(filter_whitelist=text))
    at.transform("map", "a" * 5000 + "b", (1.0, 0.0, 0.0))
    at.turn()
    assert at.nodes() == {}


def test_an_expression_beyond_linear_time_is_reported_and_ignored(
    bench: Benches,
) -> None:
    at = bench(TF(filter_whitelist="(?=odom)"))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    assert "(invalid perl operator: (?=); ignoring it." in at.statuses()["Filter (whitelist)"][1]
    assert at.nodes()


def test_a_long_name_takes_no_memory_for_each_frame(at: DisplayBench) -> None:
    for number in range(2000):
        at.transform("map", f"f{number}")
    at.transform("map", 50_000 * "n")
    tracemalloc.start()
    at.turn()
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert len(at.nodes()["axes"].positions) == 2002
    assert peak < 50e6


def test_without_any_transform_the_topic_to_look_at_is_named(at: DisplayBench) -> None:
    at.turn()
    level, text = at.statuses()["Frames"]
    assert level == "WARN"
    assert "/tf" in text


def test_with_everything_switched_off_it_is_not_ok(bench: Benches) -> None:
    at = bench(TF(all_enabled=False))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.turn()
    assert at.nodes() == {}
    assert at.statuses()["Frames"] == (
        "WARN",
        "0 of 2 frames shown, 2 switched off or filtered out.",
    )
    at.press("Frames")


def test_frames_of_another_tree_are_named_and_not_drawn(at: DisplayBench) -> None:
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.transform("camera", "lens", (1.0, 0.0, 0.0))
    at.turn()
    assert len(at.nodes()["axes"].positions) == 2
    statuses = at.statuses()
    assert statuses["Frames"] == ("WARN", "2 of 4 frames shown, 2 have no transform to 'map'.")
    assert statuses["camera"][0] == "WARN"
    assert "lens" not in statuses, "it is lost for the same reason"
    assert at.fixed_frame_remedy("camera") == OtherFixedFrame("camera")


def test_frames_without_a_transform_are_counted_with_a_few_reasons(at: DisplayBench) -> None:
    at.transform("map", "odom")
    for number in range(20):
        at.transform(f"elsewhere_{number // 2}", f"lost_{number}")
    at.turn()
    statuses = at.statuses()
    assert len([key for key in statuses if key.startswith(("lost", "elsewhere"))]) == 5
    assert "30 have no transform" in statuses["Frames"][1]


def test_a_missing_fixed_frame_is_reported_once(at: DisplayBench) -> None:
    for number in range(20):
        at.transform("odom", f"frame_{number}")
    at.turn()
    sentences = [text for _, text in at.statuses().values() if "does not exist" in text]
    assert sentences == [
        'Fixed frame "map" does not exist. Start localisation or SLAM, or use "odom", the root of '
        "the largest tree (21 frames)."
    ]


def test_the_tree_of_frames_is_a_status(at: DisplayBench) -> None:
    for parent, child in (("map", "odom"), ("odom", "base"), ("base", "wheel"), ("base", "laser")):
        at.transform(parent, child)
    at.transform("lab", "shelf")
    at.turn()
    assert at.statuses()["Tree"] == ("OK", "lab (shelf), map (odom (base (laser, wheel))).")
    at.transform("odom", "shelf")
    at.turn()
    assert at.statuses()["Tree"] == ("OK", "lab, map (odom (base (laser, wheel), shelf)).")


def test_the_status_of_a_large_tree_is_shortened(at: DisplayBench) -> None:
    for number in range(500):
        at.transform(f"f{number}", f"f{number + 1}")
    at.turn()
    text = at.statuses()["Tree"][1]
    assert text.startswith("f0 (f1 (f2 (")
    assert text.endswith("f39" + ")" * 39 + " and 461 more.")


def test_the_status_of_an_enabled_frame_gives_its_position(bench: Benches) -> None:
    at = bench(TF(frames={"odom": True, "robot": True, "map": True}))
    at.transform("map", "odom", (1.0, 0.0, 0.0))
    at.transform("odom", "robot", (0.0, 2.0, 0.0), (0.0, 0.0, 0.6, 0.8), stamp_ns=at.now_ns)
    at.turn()
    statuses = at.statuses()
    nothing = "roll, pitch and yaw (0.0, 0.0, 0.0) degrees"
    assert statuses["odom"] == (
        "OK",
        f"In 'map' (static): position (1.000, 0.000, 0.000) m, {nothing}.",
    )
    turned = "roll, pitch and yaw (0.0, 0.0, 73.7) degrees"
    assert statuses["robot"] == (
        "OK",
        f"In 'odom' (moving): position (0.000, 2.000, 0.000) m, {turned}. "
        f"In 'map': position (1.000, 2.000, 0.000) m, {turned}.",
    )
    assert "map" not in statuses  # has no parent


def test_a_frame_that_is_lost_within_the_same_second_is_named(at: DisplayBench) -> None:
    at.transform("map", "odom")
    at.transform("camera", "lens")
    at.turn()
    assert "camera" in at.statuses()
    at.transform("arm", "gripper")
    at.turn()
    assert "arm" in at.statuses()


def test_the_reason_why_a_frame_is_lost_is_that_of_now(at: DisplayBench) -> None:
    start_ns = at.now_ns
    for seconds in (0, 1):
        at.transform("map", "odom", stamp_ns=start_ns + seconds * SECOND)
        at.transform("odom", "base", stamp_ns=start_ns + (seconds + 5) * SECOND)
    at.turn()
    assert "Requested time 101.0" in at.statuses()["base"][1]
    at.transform("map", "odom", stamp_ns=start_ns + 2 * SECOND)
    at.turn(1.0)
    assert "Requested time 102.0" in at.statuses()["base"][1]
