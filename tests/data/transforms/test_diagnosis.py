"""The state of the whole tree."""

import pytest

from tests.data.transforms.conftest import HandFedBuffer
from webviz.data.transforms import FrameReport, TransformBuffer, diagnose, tree_text

S = 1_000_000_000


def report(buffer: TransformBuffer, frame: str, now_s: float = 0.0) -> FrameReport:
    frames = diagnose(buffer, round(now_s * S)).frames
    return next(each for each in frames if each.frame == frame)


def test_a_moving_frame_is_reported_with_rate_age_and_history(buffer: HandFedBuffer) -> None:
    for i in range(21):
        buffer.put("map", "odom", 10.0 + i / 20, authority="slam")
    result = report(buffer, "odom", 11.1)
    assert (result.parent, result.is_static, result.publishers) == ("map", False, ("slam",))
    assert result.rate_hz == pytest.approx(20.0)
    assert result.age_ns == 100_000_000
    assert (result.samples, result.history_ns, result.newest_ns) == (21, S, 11 * S)
    assert result.problems == ()


def test_a_static_frame_has_neither_age_nor_rate(buffer: HandFedBuffer) -> None:
    buffer.put("base", "laser", is_static=True)
    result = report(buffer, "laser", 50.0)
    assert (result.is_static, result.age_ns, result.rate_hz) == (True, None, 0.0)


def test_the_delay_is_the_time_from_stamp_to_reception(buffer: TransformBuffer) -> None:
    identity = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    buffer.set_transform("map", "odom", S, *identity, received_ns=S + 5)
    buffer.set_transform("odom", "base", S, *identity)
    assert report(buffer, "odom").delay_ns == 5
    assert report(buffer, "base").delay_ns is None


def test_roots_of_unconnected_trees_are_a_problem(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 1.0)
    assert diagnose(buffer).problems == []
    buffer.put("world", "drone", 1.0)
    diagnosis = diagnose(buffer)
    assert diagnosis.roots == ("map", "world")
    assert "roots map, world" in diagnosis.problems[0]


def test_a_loop_is_reported_once(buffer: HandFedBuffer) -> None:
    for parent, child in (("a", "b"), ("b", "c"), ("c", "a"), ("a", "tail")):
        buffer.put(parent, child, 1.0)
    diagnosis = diagnose(buffer)
    assert diagnosis.loops == (("b", "a", "c", "b"),)
    assert "b → a → c → b" in diagnosis.problems[0]
    assert "(loop)" in tree_text(buffer)


def test_a_link_that_stopped_is_a_problem_until_it_resumes(buffer: HandFedBuffer) -> None:
    for i in range(11):
        buffer.put("map", "odom", 10.0 + i / 10)
    assert (
        "has stopped: its last transform is 4.0 s old" in report(buffer, "odom", 15.0).problems[0]
    )
    buffer.put("map", "odom", 15.0)
    assert report(buffer, "odom", 15.0).problems == ()


def test_a_slow_link_is_not_taken_for_a_stopped_one(buffer: HandFedBuffer) -> None:
    for i in range(4):
        buffer.put("map", "odom", 10.0 + 2 * i)
    assert report(buffer, "odom", 17.9).problems == ()


def test_two_publishers_with_different_parents_are_found_without_their_names(
    buffer: HandFedBuffer,
) -> None:
    for i in range(6):
        buffer.put("map" if i % 2 else "world", "odom", 1.0 + i / 10)
    problems = report(buffer, "odom").problems
    assert any('between "map" and "world"' in problem for problem in problems)


def test_one_change_of_parent_is_not_a_conflict(buffer: HandFedBuffer) -> None:
    for i in range(6):
        buffer.put("map" if i < 3 else "world", "odom", 1.0 + i / 10)
    assert report(buffer, "odom").problems == ()


def test_two_publishers_of_the_same_stamps_are_found_without_their_names(
    buffer: HandFedBuffer,
) -> None:
    for i in range(4):
        buffer.put("map", "odom", 1.0 + i, 0.0)
        buffer.put("map", "odom", 1.0 + i, 5.0)
    assert "same stamp" in report(buffer, "odom").problems[0]


def test_two_publishers_are_named_while_they_quarrel(buffer: HandFedBuffer) -> None:
    for i in range(6):
        buffer.put("map", "odom", 1.0 + i / 10, authority=("amcl", "slam_toolbox")[i % 2])
    assert "amcl and slam_toolbox" in report(buffer, "odom").problems[0]
    for i in range(30):
        buffer.put("map", "odom", 2.0 + i, authority="slam_toolbox")
    assert report(buffer, "odom").problems == ()


def test_refused_transforms_are_counted_with_the_reason(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 100.0)
    for _ in range(3):
        buffer.put("map", "odom", 1.0)
    problem = report(buffer, "odom", 100.0).problems[0]
    assert problem.startswith('3 transforms of "odom" were refused')
    assert "TF_OLD_DATA" in problem


def test_a_cleared_frame_is_reported_as_silent(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 1.0)
    buffer.clear()
    result = report(buffer, "odom", 1.0)
    assert (result.parent, result.samples) == ("", 0)
    assert "since the transforms were cleared" in result.problems[0]


def test_the_tree_is_drawn_with_kind_rate_age_and_publisher(buffer: HandFedBuffer) -> None:
    for i in range(3):
        buffer.put("map", "odom", 1.0 + i / 10, authority="slam")
    buffer.put("odom", "base", 1.2)
    buffer.put("base", "laser", is_static=True, authority="robot_state_publisher")
    buffer.put("odom", "goal", 1.2)
    buffer.put("world", "drone", 1.1)
    assert tree_text(buffer, round(1.25 * S)).splitlines() == [
        "map",
        "└─ odom  [10.0 Hz, 50 ms old, from slam]",
        "   ├─ base  [one sample, 50 ms old]",
        "   │  └─ laser  [static, from robot_state_publisher]",
        "   └─ goal  [one sample, 50 ms old]",
        "world",
        "└─ drone  [one sample, 150 ms old]",
    ]


def test_the_report_has_stamps_ahead_simulated_time_and_known_nodes(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("map", "odom", 1.7e9 + 0.193, authority="/tf")
    buffer.put("map", "sim", 12.5, authority="/other")
    buffer.nodes = {"/tf": "/ekf"}
    assert tree_text(buffer, round(1.7e9) * S).splitlines() == [
        "map",
        "├─ odom  [one sample, 193 ms ahead, from /ekf]",
        "└─ sim  [one sample, simulated time 12.5 s, from /other]",
    ]


def test_an_empty_buffer_has_an_empty_diagnosis(buffer: TransformBuffer) -> None:
    diagnosis = diagnose(buffer)
    assert (diagnosis.roots, diagnosis.frames, diagnosis.problems) == ((), (), [])
    assert tree_text(buffer) == ""


def test_a_gap_is_reported_until_it_is_long_ago(buffer: HandFedBuffer) -> None:
    stamps = [i / 20 for i in range(20)]
    for stamp in (*stamps, *(3.0 + each for each in stamps)):
        buffer.put("map", "odom", 10.0 + stamp)
    assert report(buffer, "odom", 14.0).gap_ns == pytest.approx(2.05 * S, abs=1000)
    assert report(buffer, "odom", 14.0).problems == ()
    for i in range(200):
        buffer.put("map", "odom", 14.0 + i / 20)
    assert report(buffer, "odom", 24.0).gap_ns == 0
