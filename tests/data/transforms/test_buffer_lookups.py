"""Questions to the buffer: tf2's buffer_core_test, simple_tf2_core and test_buffer_core."""

import math
from itertools import pairwise

import pytest

from tests.data.transforms.conftest import HandFedBuffer
from webviz.data.transforms import (
    BackwardExtrapolationException,
    ConnectivityException,
    ExtrapolationException,
    ForwardExtrapolationException,
    InvalidArgumentException,
    LookupException,
    NoDataForExtrapolationException,
    TimeoutException,
    TransformBuffer,
    TransformException,
)
from webviz.data.transforms.errors import format_stamp

S = 1_000_000_000
UNIT = (0.0, 0.0, 0.0, 1.0)
ZERO = (0.0, 0.0, 0.0)


def refusal(buffer: TransformBuffer, target: str, source: str, stamp_ns: int) -> tuple[type, str]:
    with pytest.raises(TransformException) as error:
        buffer.lookup(target, source, stamp_ns)
    return type(error.value), str(error.value)


@pytest.mark.parametrize(
    ("shape", "positions"),
    [
        ([("a", "b")], {"a": 0.0, "b": 1.0}),
        ([("a", "b"), ("b", "c")], {"a": 0.0, "b": 1.0, "c": 2.0}),
        ([("a", "b"), ("b", "c"), ("a", "d")], {"a": 0.0, "b": 1.0, "c": 2.0, "d": 1.0}),
        (
            [("a", "b"), ("b", "c"), ("c", "d"), ("a", "e"), ("e", "f"), ("f", "g")],
            {"a": 0.0, "b": 1.0, "c": 2.0, "d": 3.0, "e": 1.0, "f": 2.0, "g": 3.0},
        ),
    ],
    ids=["one link", "i", "v", "y"],
)
@pytest.mark.parametrize("stamp_s", [1, 10, 0])
def test_every_pair_of_frames_of_a_tree_sees_each_other(
    buffer: HandFedBuffer,
    shape: list[tuple[str, str]],
    positions: dict[str, float],
    stamp_s: int,
) -> None:
    for parent, child in shape:
        buffer.put(parent, child, 1.0, 1.0)
        buffer.put(parent, child, 10.0, 1.0)
    for target, x_target in positions.items():
        for source, x_source in positions.items():
            transform = buffer.lookup(target, source, stamp_s * S)
            assert transform.translation == (x_source - x_target, 0.0, 0.0)
            assert transform.rotation == UNIT
            if source != target:
                assert transform.stamp_ns == (stamp_s or 10) * S
            assert buffer.can_transform(target, source, stamp_s * S)


@pytest.mark.parametrize("stamp_s", [1, 10, 0])
def test_a_ring_of_nine_frames_by_45_degrees_has_canonical_signs(
    buffer: TransformBuffer, stamp_s: int
) -> None:
    names = list("abcdefghi")
    step = (0.0, 0.0, math.sin(math.pi / 8), math.cos(math.pi / 8))
    forward = (math.sqrt(2) / 2 - 1.0, math.sqrt(2) / 2, 0.0)
    for stamp in (S, 10 * S):
        for parent, child in pairwise(names):
            buffer.set_transform(parent, child, stamp, forward, step)
    for i, target in enumerate(names):
        for j, source in enumerate(names):
            transform = buffer.lookup(target, source, stamp_s * S)
            angle = (j - i) * math.pi / 4
            assert transform.translation == pytest.approx(
                (math.cos(angle) - 1.0, math.sin(angle), 0.0), abs=1e-12
            )
            z, w = math.sin(angle / 2), math.cos(angle / 2)
            trace = 1 + 2 * math.cos(angle)
            sign = math.copysign(1.0, w if trace > 0 else z)  # tf2's canonical sign
            assert transform.rotation == pytest.approx((0.0, 0.0, sign * z, sign * w), abs=1e-12)


def test_two_trees_are_not_connected(buffer: HandFedBuffer) -> None:
    buffer.put("a", "b", 1.0)
    buffer.put("c", "d", 1.0)
    assert not buffer.can_transform("a", "d", S)
    for stamp in (0, S):
        assert refusal(buffer, "a", "d", stamp) == (
            ConnectivityException,
            "Could not find a connection between 'a' and 'd' because they are not part of the "
            "same tree.Tf has two or more unconnected trees.",
        )


def test_an_unknown_frame_is_a_lookup_error_of_its_argument(buffer: HandFedBuffer) -> None:
    text = '"a" passed to lookupTransform argument target_frame does not exist. '
    assert refusal(buffer, "a", "b", S) == (LookupException, text)
    assert not buffer.can_transform("a", "b", S)
    buffer.put("c", "a")
    text = '"b" passed to lookupTransform argument source_frame does not exist. '
    assert refusal(buffer, "a", "b", S) == (LookupException, text)
    assert buffer.can_transform_error("a", "b", S) == (
        'Invalid frame ID "b" passed to canTransform argument source_frame - frame does not exist'
    )


@pytest.mark.parametrize(
    ("frame", "fault"), [("", "cannot be empty"), ("/a", "cannot start with a '/'")]
)
def test_an_empty_frame_or_a_leading_slash_is_an_invalid_argument(
    buffer: HandFedBuffer, frame: str, fault: str
) -> None:
    buffer.put("a", "b")
    for target, source, argument in ((frame, "b", "target"), ("b", frame, "source")):
        assert refusal(buffer, target, source, S) == (
            InvalidArgumentException,
            f'Invalid argument "{frame}" passed to lookupTransform argument {argument}_frame - '
            f"in tf2 frame_ids {fault}",
        )
        assert buffer.can_transform_error(target, source, S) == (
            f'Invalid frame ID "{frame}" passed to canTransform argument {argument}_frame - '
            f"in tf2 frame_ids {fault}"
        )


@pytest.mark.parametrize("frame", ["", "/slash", "never seen"])
def test_a_frame_in_itself_is_the_identity_without_validation(
    buffer: TransformBuffer, frame: str
) -> None:
    transform = buffer.lookup(frame, frame, 7)
    assert (transform.translation, transform.rotation, transform.stamp_ns) == (ZERO, UNIT, 7)
    assert buffer.lookup(frame, frame, 0).stamp_ns == 0
    assert buffer.can_transform(frame, frame, 7)


def test_the_latest_time_of_a_frame_in_itself_is_its_newest_stamp_as_a_child(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("map", "odom", 3.0)
    assert buffer.lookup("odom", "odom", 0).stamp_ns == 3 * S
    assert buffer.lookup("map", "map", 0).stamp_ns == 0


def test_one_sample_serves_only_its_own_stamp(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 2.0)
    assert buffer.can_transform("map", "odom", 2 * S)
    assert refusal(buffer, "map", "odom", S) == (
        NoDataForExtrapolationException,
        "Lookup would require extrapolation at time 1.000000, but only time 2.000000 is in the "
        "buffer, when looking up transform from frame [odom] to frame [map]",
    )


def test_times_outside_the_data_are_refused_by_direction(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 2.0)
    buffer.put("map", "odom", 3.0)
    tail = ", when looking up transform from frame [odom] to frame [map]"
    assert refusal(buffer, "map", "odom", S) == (
        BackwardExtrapolationException,
        "Lookup would require extrapolation into the past.  Requested time 1.000000 but the "
        f"earliest data is at time 2.000000{tail}",
    )
    assert refusal(buffer, "map", "odom", 4 * S) == (
        ForwardExtrapolationException,
        "Lookup would require extrapolation into the future.  Requested time 4.000000 but the "
        f"latest data is at time 3.000000{tail}",
    )
    assert (
        buffer.can_transform_error("map", "odom", 4 * S)
        == (refusal(buffer, "map", "odom", 4 * S)[1])
    )


def test_the_exceptions_stand_in_tf2s_hierarchy() -> None:
    assert issubclass(BackwardExtrapolationException, ExtrapolationException)
    assert issubclass(ForwardExtrapolationException, ExtrapolationException)
    assert issubclass(NoDataForExtrapolationException, ExtrapolationException)
    for kind in (
        LookupException,
        ConnectivityException,
        InvalidArgumentException,
        TimeoutException,
        ExtrapolationException,
    ):
        assert kind.__base__ is TransformException


def test_siblings_below_a_stale_parent_still_see_each_other(buffer: HandFedBuffer) -> None:
    buffer.put("map", "base", 1.0, 5.0)
    for stamp in (1.0, 60.0):
        buffer.put("base", "left", stamp, -1.0)
        buffer.put("base", "right", stamp, 1.0)
    assert buffer.lookup("left", "right", 30 * S).translation == (2.0, 0.0, 0.0)
    assert refusal(buffer, "map", "right", 30 * S)[0] is NoDataForExtrapolationException


def test_an_error_of_the_target_is_reported_before_one_of_the_source(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("root", "source", 1.0)
    buffer.put("root", "target", 2.0)
    assert "only time 2.000000" in refusal(buffer, "target", "source", 3 * S)[1]
    assert "only time 1.000000" in refusal(buffer, "target", "source", 2 * S)[1]


def test_a_loop_is_a_lookup_error_that_lists_the_frames(buffer: HandFedBuffer) -> None:
    buffer.put("a", "b")
    buffer.put("b", "c")
    buffer.put("c", "a")
    buffer.put("x", "y")
    for stamp in (0, S):
        assert refusal(buffer, "y", "a", stamp) == (
            LookupException,
            "The tf tree is invalid because it contains a loop.\n"
            "Frame b exists with parent a.\nFrame a exists with parent c.\n"
            "Frame c exists with parent b.\nFrame y exists with parent x.\n\n",
        )
    assert buffer.can_transform("b", "c", S)


def test_the_full_question_looks_at_two_times_past_a_frame_that_did_not_move(
    buffer: HandFedBuffer,
) -> None:
    for stamp, x in ((1.0, 0.0), (2.0, 10.0)):
        buffer.put("odom", "base", stamp, x)
        buffer.put("base", "laser", stamp, 1.0)
    transform = buffer.lookup_full("base", 2 * S, "laser", S, "odom")
    assert transform.translation == (-9.0, 0.0, 0.0)
    assert transform.stamp_ns == 2 * S
    assert buffer.lookup_full("base", 0, "base", S, "odom").translation == (-10.0, 0.0, 0.0)
    with pytest.raises(LookupException, match="argument fixed_frame does not exist"):
        buffer.lookup_full("base", S, "laser", S, "fixed")
    with pytest.raises(ForwardExtrapolationException, match=r"from frame \[laser\] to .*\[odom\]"):
        buffer.lookup_full("base", S, "laser", 3 * S, "odom")


def test_stamps_never_pass_through_floats(buffer: TransformBuffer) -> None:
    first = 1_000_000_000 * S
    buffer.set_transform("map", "odom", first, ZERO, UNIT)
    assert buffer.can_transform("map", "odom", first)
    assert not buffer.can_transform("map", "odom", first + 1)
    buffer.set_transform("map", "odom", first + 1, (1.0, 0.0, 0.0), UNIT)
    assert buffer.lookup("map", "odom", first + 1).translation[0] == 1.0
    assert buffer.lookup("map", "odom", first).translation[0] == 0.0
    assert buffer.lookup("map", "odom", 0).stamp_ns == first + 1


@pytest.mark.parametrize(
    ("stamp_ns", "text"),
    [
        (0, "0.000000"),
        (1_500_000_000, "1.500000"),
        (-1_500_000_000, "-1.500000"),
        (-1, "-0.000000"),
        (1_700_000_000_123_456_789, "1700000000.123457"),
    ],
)
def test_times_are_printed_in_seconds_with_six_decimals(stamp_ns: int, text: str) -> None:
    assert format_stamp(stamp_ns) == text


def test_the_yaml_listing_names_parent_publisher_rate_and_age(buffer: HandFedBuffer) -> None:
    assert buffer.all_frames_as_yaml() == "[]"
    for i in range(5):
        buffer.put("map", "odom", 1.0 + i / 4, authority="slam")
    buffer.put("odom", "laser", is_static=True)
    assert buffer.all_frames_as_yaml(2_500_000_000) == (
        "odom: \n  parent: 'map'\n  broadcaster: 'slam'\n  rate: 5.000\n"
        "  most_recent_transform: 2.000000\n  oldest_transform: 1.000000\n"
        "  transform_delay: 0.500\n  buffer_length: 1.000\n"
        "laser: \n  parent: 'odom'\n  broadcaster: ''\n  rate: 10000.000\n"
        "  most_recent_transform: 0.000000\n  oldest_transform: 0.000000\n"
        "  transform_delay: 2.500\n  buffer_length: 0.000\n"
    )
