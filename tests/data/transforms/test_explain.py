"""Reasons why a frame has no pose: every one in words and numbers, and what to do next."""

import math
from collections.abc import Iterable
from itertools import pairwise

import pytest

from tests.data.transforms.conftest import HandFedBuffer
from webviz.data.transforms import Explanation, Kind, TransformBuffer, explain
from webviz.data.transforms.diagnosis import STALE_PERIODS
from webviz.data.transforms.geometry import REACH_M, is_within_reach
from webviz.data.transforms.reasons import distinct, in_words, listed

S = 1_000_000_000


def why(
    buffer: TransformBuffer, frame: str, stamp_s: float, now_s: float = 0.0, fixed: str = "map"
) -> Explanation:
    return explain(buffer, fixed, frame, round(stamp_s * S), round(now_s * S))


def test_ten_frames_are_listed_and_more_are_counted() -> None:
    frames = [f"f{number}" for number in range(12)]
    assert listed(frames[:2], " and ") == "f0 and f1"
    assert listed(frames[:10]) == "f0, f1, f2, f3, f4, f5, f6, f7, f8, f9"
    assert listed(frames) == "f0, f1, f2, f3, f4, f5, f6, f7, f8, f9 and 2 more"


@pytest.mark.parametrize(
    ("value", "is_near"), [(REACH_M, True), (-2 * REACH_M, False), (math.nan, False)]
)
def test_distant_poses_are_out_of_reach(value: float, is_near: bool) -> None:
    assert is_within_reach((0.0, value, 0.0, 0.0, 0.0, 0.0, 1.0)) == is_near


def test_an_available_transform_is_ok(buffer: HandFedBuffer) -> None:
    buffer.put("map", "laser", 1.0)
    assert why(buffer, "laser", 1.0) == Explanation(Kind.AVAILABLE, "Transform OK")
    assert why(buffer, "map", 99.0).kind == Kind.AVAILABLE


def test_an_empty_frame_id_is_the_publishers_to_fill(buffer: TransformBuffer) -> None:
    result = why(buffer, "", 1.0)
    assert result.kind == Kind.EMPTY_FRAME
    assert "header.frame_id" in result.sentence


def test_a_leading_slash_is_named_with_the_right_spelling(buffer: HandFedBuffer) -> None:
    buffer.put("map", "laser", 1.0)
    result = why(buffer, "/laser", 1.0)
    assert result.kind == Kind.LEADING_SLASH
    assert 'use "laser"' in result.sentence
    assert why(buffer, "laser", 1.0, fixed="/map").kind == Kind.LEADING_SLASH


def test_without_any_transform_the_topics_are_named(buffer: TransformBuffer) -> None:
    result = why(buffer, "laser", 1.0)
    assert result.kind == Kind.NO_TRANSFORMS
    assert "/tf" in result.sentence


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("base_scann", "base_scan"),
        ("base_sacn", "base_scan"),
        ("Base_Scan", "base_scan"),
        ("robot1/Base_Scan", "base_scan"),
        ("lens", "camera/lens"),
    ],
)
def test_a_frame_that_is_a_slip_of_another_comes_with_its_name(
    buffer: HandFedBuffer, name: str, meant: str
) -> None:
    buffer.put("map", "base_scan", 1.0)
    buffer.put("map", "camera/lens", 1.0)
    result = why(buffer, name, 1.0)
    assert result.kind == Kind.UNKNOWN_FRAME
    assert result.sentence.startswith(f'Frame "{name}" does not exist. Did you mean "{meant}"?')


@pytest.mark.parametrize(
    ("name", "existing"),
    [
        ("laser_link", "base_link"),
        ("wheel_drop_left", "cliff_front_left"),
        ("front_left_wheel", "front_right_wheel"),
        ("camera2_link", "camera1_link"),
        ("robot2/base_link", "robot1/base_link"),
        ("base", "base_link"),
    ],
)
def test_dissimilar_names_are_not_suggested(
    buffer: HandFedBuffer, name: str, existing: str
) -> None:
    buffer.put("map", existing, 1.0)
    assert why(buffer, name, 1.0).sentence == (
        f'Frame "{name}" does not exist: no transform to it has arrived. Start the node that '
        "publishes it, such as robot_state_publisher, or fix the frame_id of the data."
    )


@pytest.mark.parametrize(("length", "is_compared"), [(200, True), (201, False)])
def test_names_of_any_length_are_not_compared_in_each_turn(
    buffer: HandFedBuffer, length: int, is_compared: bool
) -> None:
    buffer.put("map", length * "n", 1.0)
    for slip in (f"{(length - 1) * 'n'}m", f"{199 * 'n'}m"):
        assert ("Did you mean" in why(buffer, slip, 1.0).sentence) == is_compared


def test_an_unknown_fixed_frame_suggests_a_similar_name_or_the_root_of_the_largest_tree(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("odom", "base", 1.0)
    buffer.put("base", "laser", 1.0)
    buffer.put("world", "drone", 1.0)
    result = why(buffer, "laser", 1.0, fixed="Odom")
    assert result.kind == Kind.UNKNOWN_FIXED_FRAME
    assert result.sentence == 'Fixed frame "Odom" does not exist. Did you mean "odom"?'
    assert why(buffer, "laser", 1.0, fixed="earth").sentence == (
        'Fixed frame "earth" does not exist. Use "odom", the root of the largest tree (3 frames).'
    )
    assert "does not exist. Start localisation or SLAM, or use" in why(buffer, "laser", 1).sentence


@pytest.mark.parametrize(
    ("missing", "remedy"),
    [
        (("map", "odom"), 'Start localisation or SLAM, which publishes "map" → "odom"'),
        (("odom", "base_link"), 'Start the odometry of the robot, which publishes "odom" →'),
        (("base_link", "laser"), "Publish a transform from one to the other, or use"),
    ],
)
def test_two_trees_are_named_by_their_roots_and_the_node_that_usually_connects_them(
    buffer: HandFedBuffer, missing: tuple[str, str], remedy: str
) -> None:
    chain = ("map", "odom", "base_link", "laser", "lens")
    buffer.put("map", "landmark", 1.0)
    for link in pairwise(chain):
        if link != missing:
            buffer.put(*link, 1.0)
    result = why(buffer, "lens", 1.0, fixed="landmark")
    assert result.kind == Kind.NOT_CONNECTED
    assert f'the root "{missing[1]}", the other "map"' in result.sentence
    assert remedy in result.sentence
    assert result.other_frame == ("laser" if remedy.endswith("or use") else "")
    assert not result.other_frame or why(buffer, "lens", 1.0, fixed=result.other_frame).kind == (
        Kind.AVAILABLE
    )


def test_a_loop_is_spelled_out(buffer: HandFedBuffer) -> None:
    buffer.put("map", "other", 1.0)
    buffer.put("a", "b", 1.0)
    buffer.put("b", "a", 1.0)
    result = why(buffer, "a", 1.0)
    assert result.kind == Kind.LOOP
    assert "a → b → a" in result.sentence


def test_a_stamp_ahead_names_the_link_that_lags_and_by_how_much(buffer: HandFedBuffer) -> None:
    for stamp in (10.0, 10.5):
        buffer.put("map", "odom", stamp, authority="amcl")
    for stamp in (10.0, 10.5, 10.58):
        buffer.put("odom", "base", stamp)
    result = why(buffer, "base", 10.583, 10.6)
    assert result.kind == Kind.AHEAD
    assert result.is_catching_up
    assert result.lag_ns == 83_000_000
    assert 'The stamp is 83 ms ahead of the newest transform "map" → "odom" (from amcl)' in (
        result.sentence
    )
    assert "100 ms old" in result.sentence


@pytest.mark.parametrize(
    ("stamps", "at", "now", "kind", "phrase"),
    [
        ((10.0, 11.0), 23.0, 23.1, Kind.AHEAD, "which has stopped: its last is 12 s old"),
        ((10.0, 11.0), 15.0, 11.0, Kind.AHEAD, "4.0 s ahead of the present"),
        (range(100, 111), 96.5, 110.0, Kind.BEHIND, "3.5 s older than the oldest transform kept"),
        (range(100, 111), 96.5, 110.0, Kind.BEHIND, "10 s are kept"),
        ((100.0, 100.5), 99.0, 100.5, Kind.BEHIND, "began only 500 ms ago"),
    ],
    ids=["stopped", "future", "older", "kept", "began"],
)
def test_a_stamp_that_one_link_cannot_reach(
    buffer: HandFedBuffer,
    stamps: Iterable[float],
    at: float,
    now: float,
    kind: Kind,
    phrase: str,
) -> None:
    for stamp in stamps:
        buffer.put("map", "odom", float(stamp))
    result = why(buffer, "odom", at, now)
    assert result.kind == kind
    assert phrase in result.sentence
    assert not result.is_catching_up


def test_late_stamps_are_distinguished_from_stopped_transforms(
    buffer: TransformBuffer,
) -> None:
    for stamp in (10 * S, 11 * S):
        buffer.set_transform(
            "map", "odom", stamp, (0, 0, 0), (0, 0, 0, 1), received_ns=stamp + 2 * S
        )
    result = why(buffer, "odom", 13.0, 13.0)
    assert result.kind == Kind.CLOCKS
    assert not result.is_catching_up
    assert 'transform "map" → "odom", which comes stamped 2.0 s in the past' in result.sentence
    assert "which has stopped: its last is 7.0 s old" in why(buffer, "odom", 18.0, 18.0).sentence


def test_transforms_refused_long_ago_are_not_the_reason_now(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 100.0)
    assert not buffer.put("map", "odom", 1.0)
    for stamp in range(101, 121):
        buffer.put("map", "odom", float(stamp))
    assert why(buffer, "odom", 105.0, 120.0).kind == Kind.BEHIND


def test_a_refused_transform_explains_only_its_frames(buffer: HandFedBuffer) -> None:
    buffer.put("map", "base", 1.0)
    buffer.put("arm", "hand", 1.0)
    buffer.put("base", "laser", 1.0, x=math.nan)
    buffer.put("torso", "arm", 1.0, x=math.nan)
    for frame, cause in (("laser", "laser"), ("arm", "arm"), ("torso", "arm")):
        result = why(buffer, frame, 1.0)
        assert (result.kind, result.cause) == (Kind.REFUSED, cause)
    buffer.put("lone", "wheel", 1.0)
    assert why(buffer, "wheel", 1.0).kind is Kind.NOT_CONNECTED


def test_a_link_has_stopped_after_some_of_its_periods(buffer: HandFedBuffer) -> None:
    for second in range(3):
        buffer.put("map", "base", 2.0 * second)
    age_s = STALE_PERIODS * 2.0
    assert "stopped" not in why(buffer, "base", 5.0, 4.0 + age_s - 0.5).sentence
    assert "stopped" in why(buffer, "base", 5.0, 4.0 + age_s + 0.5).sentence


@pytest.mark.parametrize(("data_s", "tf_s"), [(12.0, 1.7e9), (1.7e9, 12.0)])
def test_wall_time_against_simulated_time_is_recognised_either_way(
    buffer: HandFedBuffer, data_s: float, tf_s: float
) -> None:
    buffer.put("map", "odom", tf_s)
    buffer.put("map", "odom", tf_s + 1)
    result = why(buffer, "odom", data_s)
    assert result.kind == Kind.CLOCKS
    assert "use_sim_time" in result.sentence
    simulated, wall = result.sentence.split("the transform" if data_s < tf_s else "the data")
    assert ("12.0 s" if data_s < tf_s else "13.0 s") in simulated
    assert "1700000" in wall


def test_clocks_hours_apart_are_reported_in_hours(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 1.7e9)
    buffer.put("map", "odom", 1.7e9 + 1)
    result = why(buffer, "odom", 1.7e9 + 18_001)
    assert result.kind == Kind.CLOCKS
    assert "5.0 hours apart" in result.sentence


def test_a_jump_back_in_time_is_recognised_by_refused_transforms(buffer: HandFedBuffer) -> None:
    for stamp in (100.0, 105.0, 110.0):
        buffer.put("map", "odom", stamp)
    for stamp in (50.0, 50.1):
        assert not buffer.put("map", "odom", stamp)
    result = why(buffer, "odom", 50.1, 50.2)
    assert result.kind == Kind.JUMPED_BACK
    assert "60 s older" in result.sentence
    assert "2 older transforms were refused" in result.sentence
    assert "Reset" in result.sentence


def test_a_link_that_stopped_before_all_that_others_keep_is_named(buffer: HandFedBuffer) -> None:
    """`laser` is fixed to `base`, whose odometry ended at 2 s."""
    for stamp_s in (1.0, 2.0):
        buffer.put("odom", "base", stamp_s)
        buffer.put("base", "laser", stamp_s)
    for stamp_s in range(5, 15):
        buffer.put("map", "odom", float(stamp_s))
        buffer.put("base", "laser", float(stamp_s))
    result = why(buffer, "laser", 0.0, 14.5)
    assert (result.kind, result.link) == (Kind.NO_DATA, "base")
    assert result.sentence == (
        'The transform "odom" → "base" has stopped: its last is 12 s old, older than all that are '
        'kept of "map" → "odom". Restart its publisher.'
    )


def test_a_single_sample_at_another_time_is_too_little(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 1.0)
    buffer.put("odom", "base", 1.1)
    result = explain(buffer, "map", "base", 0)
    assert result.kind == Kind.NO_DATA
    assert 'Only one transform "odom" → "base" has arrived' in result.sentence


def test_after_a_clear_the_silent_link_is_named(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 1.0)
    buffer.clear()
    for stamp in (0.0, 1.0):
        result = why(buffer, "odom", stamp)
        assert result.kind == Kind.NO_DATA
        assert '"odom" has arrived since the transforms were cleared' in result.sentence


@pytest.mark.parametrize(
    ("duration_ns", "text"),
    [
        (400_000, "0.4 ms"),
        (83_000_000, "83 ms"),
        (3_200_000_000, "3.2 s"),
        (-3_200_000_000, "3.2 s"),
        (600 * S, "10 min"),
        (5 * 3600 * S, "5.0 hours"),
        (72 * 3600 * S, "3 days"),
        (54 * 365 * 86400 * S, "54 years"),
    ],
)
def test_durations_have_a_readable_unit(duration_ns: int, text: str) -> None:
    assert in_words(duration_ns) == text


def test_the_largest_tree_is_that_of_now(buffer: HandFedBuffer) -> None:
    assert buffer.largest_tree() == ("", 0)
    buffer.put("small", "a")
    assert buffer.largest_tree() == ("small", 2)
    for child in ("b", "c"):
        buffer.put("large", child)
    buffer.put("c", "below")
    assert buffer.largest_tree() == ("large", 4)
    buffer.put("large", "b", 2.0)
    assert buffer.largest_tree() == ("large", 4)
    for child in ("b", "c"):
        buffer.put("small", child, 3.0)
    assert buffer.largest_tree() == ("small", 5)


def test_a_loop_is_one_reason_for_all_its_frames(buffer: HandFedBuffer) -> None:
    for parent, child in (("a", "b"), ("b", "c"), ("c", "a"), ("a", "tail"), ("map", "odom")):
        buffer.put(parent, child)
    result = distinct(["a", "b", "c", "tail"], lambda frame: why(buffer, frame, 0.0), 5)
    assert [reason.kind for reason in result.values()] == [Kind.LOOP]
