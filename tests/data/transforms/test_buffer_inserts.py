"""Insertions into the buffer: tf2's setTransform tests and its surprises."""

import math

import pytest

from tests.data.transforms.conftest import HandFedBuffer
from webviz.data.transforms import (
    ConnectivityException,
    LookupException,
    NoDataForExtrapolationException,
    TransformBuffer,
)
from webviz.data.transforms.records import Surplus

S = 1_000_000_000
UNIT = (0.0, 0.0, 0.0, 1.0)
ZERO = (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    ("parent", "child", "translation", "rotation", "reason"),
    [
        ("same", "same", ZERO, UNIT, "TF_SELF_TRANSFORM"),
        ("/same", "same", ZERO, UNIT, "TF_SELF_TRANSFORM"),
        ("parent", "", ZERO, UNIT, "TF_NO_CHILD_FRAME_ID"),
        ("parent", "/", ZERO, UNIT, "TF_NO_CHILD_FRAME_ID"),
        ("", "child", ZERO, UNIT, "TF_NO_FRAME_ID"),
        ("/", "child", ZERO, UNIT, "TF_NO_FRAME_ID"),
        ("parent", "child", (0.0, math.nan, 0.0), UNIT, "TF_NAN_INPUT"),
        ("parent", "child", ZERO, (0.0, 0.0, math.nan, 1.0), "TF_NAN_INPUT"),
        ("parent", "child", ZERO, (0.0, 0.0, 0.0, 0.0), "TF_NAN_INPUT"),
        ("parent", "child", ZERO, (0.0, 0.0, 0.0, math.inf), "TF_NAN_INPUT"),
    ],
)
def test_an_invalid_transform_is_refused_with_tf2s_reason(
    buffer: TransformBuffer,
    parent: str,
    child: str,
    translation: tuple[float, float, float],
    rotation: tuple[float, float, float, float],
    reason: str,
) -> None:
    version = buffer.version
    assert not buffer.set_transform(parent, child, S, translation, rotation)
    assert buffer.refusals.rejections[child.removeprefix("/")].reason == reason
    assert buffer.frames() == []
    assert buffer.version == version


def test_a_valid_transform_is_stored_and_changes_the_version(buffer: HandFedBuffer) -> None:
    version = buffer.version
    assert buffer.put("parent", "child", 1.0, 3.0)
    assert buffer.version != version
    assert buffer.lookup("parent", "child", S).translation == (3.0, 0.0, 0.0)
    assert not buffer.refusals.rejections


@pytest.mark.parametrize("length", [1e-9, 0.3, 2.0, 1e6])
def test_a_quaternion_of_any_length_is_normalised(buffer: TransformBuffer, length: float) -> None:
    rotation = (0.0, 0.0, 0.6 * length, 0.8 * length)
    assert buffer.set_transform("parent", "child", S, ZERO, rotation)
    assert buffer.lookup("parent", "child", S).rotation == pytest.approx((0.0, 0.0, 0.6, 0.8))


@pytest.mark.parametrize(
    ("sent", "stored"),
    [
        ((0.0, 0.0, -0.6, -0.8), (0.0, 0.0, 0.6, 0.8)),
        ((-1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)),
        ((0.0, -1.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0)),
        ((0.0, 0.0, -1.0, 0.0), (0.0, 0.0, 1.0, 0.0)),
        ((0.0, 0.0, 0.96, -0.28), (0.0, 0.0, 0.96, -0.28)),
        ((-0.5, -0.5, -0.5, 0.5), (0.5, 0.5, 0.5, -0.5)),
    ],
)
def test_the_sign_of_a_rotation_is_canonical(
    buffer: TransformBuffer,
    sent: tuple[float, float, float, float],
    stored: tuple[float, float, float, float],
) -> None:
    buffer.set_transform("parent", "child", S, ZERO, sent)
    assert buffer.lookup("parent", "child", S).rotation == pytest.approx(stored, abs=1e-15)


def test_an_infinite_translation_is_accepted(buffer: TransformBuffer) -> None:
    assert buffer.set_transform("parent", "child", S, (math.inf, 0.0, 0.0), UNIT)
    assert not math.isfinite(buffer.lookup("parent", "child", S).translation[0])


def test_one_leading_slash_is_stripped_on_insertion_and_only_one(buffer: TransformBuffer) -> None:
    assert buffer.set_transform("/map", "//odom", S, ZERO, UNIT)
    assert buffer.frames() == ["/odom", "map"]


def test_frames_are_listed_child_before_parent_in_order_of_first_mention(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("odom", "base")
    buffer.put("map", "odom")
    buffer.put("base", "laser")
    assert buffer.frames() == ["base", "odom", "map", "laser"]


def test_data_older_than_the_cache_is_refused_and_counted(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 100.0)
    assert buffer.put("map", "odom", 90.0)
    assert not buffer.put("map", "odom", 89.999)
    assert not buffer.put("map", "odom", 1.0)
    rejection = buffer.refusals.rejections["odom"]
    assert (rejection.reason, rejection.count, rejection.stamp_ns) == ("TF_OLD_DATA", 2, S)


def test_a_refused_transform_still_makes_its_parent_known(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 100.0)
    assert not buffer.put("elsewhere", "odom", 1.0)
    with pytest.raises(ConnectivityException):
        buffer.lookup("elsewhere", "odom", 0)


def test_changing_between_static_and_moving_loses_the_history(buffer: HandFedBuffer) -> None:
    buffer.put("a", "b", 1.0, 1.0)
    buffer.put("a", "b", 2.0, 2.0)
    buffer.put("a", "b", 0.0, 7.0, is_static=True)
    assert buffer.lookup("a", "b", 123 * S).translation[0] == 7.0
    buffer.put("a", "b", 3.0, 3.0)
    with pytest.raises(NoDataForExtrapolationException):
        buffer.lookup("a", "b", 2 * S)
    assert buffer.lookup("a", "b", 3 * S).translation[0] == 3.0


def test_the_later_static_parent_wins(buffer: HandFedBuffer) -> None:
    buffer.put("a", "c", is_static=True)
    buffer.put("b", "c", is_static=True)
    assert buffer.can_transform("b", "c", S)
    assert not buffer.can_transform("a", "c", S)


def test_clear_keeps_static_transforms_names_and_publishers(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 1.0, authority="slam")
    buffer.put("odom", "base", is_static=True)
    buffer.clear()
    assert buffer.frames() == ["odom", "map", "base"]
    assert buffer.can_transform("odom", "base", 5 * S)
    assert buffer.publishers["odom"].current == "slam"
    with pytest.raises(ConnectivityException):
        buffer.lookup("map", "odom", 0)
    with pytest.raises(NoDataForExtrapolationException) as error:
        buffer.lookup("map", "odom", S)
    assert str(error.value) == ", when looking up transform from frame [odom] to frame [map]"
    assert buffer.all_frames_as_string() == (
        "Frame odom exists with parent NO_PARENT.\nFrame base exists with parent odom.\n"
    )


@pytest.mark.parametrize("before", [True, False])
def test_a_cleared_frame_can_become_static(buffer: HandFedBuffer, before: bool) -> None:
    buffer.put("map", "odom", 1.0, is_static=before)
    buffer.clear()
    buffer.put("map", "odom", 1.0, 4.0, is_static=True)
    assert buffer.lookup("map", "odom", 99 * S).translation[0] == 4.0


def test_after_a_clear_older_data_is_welcome(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 100.0)
    buffer.clear()
    assert buffer.put("map", "odom", 1.0)


def test_the_structure_version_stands_while_only_poses_of_moving_frames_change(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("map", "odom", 1.0)
    buffer.put("odom", "base", is_static=True)
    structure, version = buffer.structure_version, buffer.version
    buffer.put("map", "odom", 2.0, 5.0)
    buffer.put("odom", "base", is_static=True)
    assert buffer.structure_version == structure
    assert buffer.version > version
    buffer.put("odom", "base", x=1.0, is_static=True)
    assert buffer.structure_version > structure
    structure = buffer.structure_version
    buffer.put("world", "odom", 3.0)
    assert buffer.structure_version > structure


def test_frames_joined_by_static_transforms_share_a_rigid_root(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 1.0)
    buffer.put("odom", "base", 1.0)
    buffer.put("base", "laser", is_static=True)
    buffer.put("laser", "beam", is_static=True)
    roots = {frame: buffer.rigid_root(frame) for frame in (*buffer.frames(), "unknown")}
    assert roots == {
        "odom": "odom",
        "map": "map",
        "base": "base",
        "laser": "base",
        "beam": "base",
        "unknown": "unknown",
    }


def test_a_loop_of_static_transforms_has_some_rigid_root(buffer: HandFedBuffer) -> None:
    buffer.put("a", "b", is_static=True)
    buffer.put("b", "a", is_static=True)
    assert buffer.rigid_root("a") in ("a", "b")


def test_nothing_is_known_of_a_frame_never_mentioned(buffer: TransformBuffer) -> None:
    with pytest.raises(LookupException):
        buffer.latest_common_time("a", "b")


def test_expired_frames_make_room_and_further_ones_are_refused_and_counted(
    buffer: HandFedBuffer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.data.transforms.buffer.MAX_FRAMES", 4)
    buffer.put("map", "odom", 1.0)
    buffer.put("base", "laser", 1.0, is_static=True)
    assert not buffer.put("map", "person_1", 1.5)
    assert not buffer.put("person_2", "odom", 1.5), "a new parent is a new frame, too"
    assert buffer.refusals.surplus == Surplus("odom", 2, 0)
    assert buffer.put("map", "odom", 2.0), "frames that are known still move"
    assert buffer.put("map", "person_3", 13.0)
    assert buffer.frames() == ["laser", "base", "person_3", "map"]
    assert "odom" not in buffer.publishers
    assert not buffer.put("map", "odom", 13.0)
    buffer.forget()
    assert buffer.refusals.surplus is None
    assert buffer.put("map", "odom", 1.0)


def test_refusals_are_kept_of_the_frames_refused_last(
    buffer: HandFedBuffer, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.data.transforms.refusals.MAX_REJECTIONS", 2)
    for frame in ("a", "b", "a", "c"):
        buffer.put(frame, frame)
    assert {frame: each.count for frame, each in buffer.refusals.rejections.items()} == {
        "a": 2,
        "c": 1,
    }


def test_a_stamp_is_seen_when_it_first_comes_and_a_static_pose_when_it_changes(
    buffer: TransformBuffer,
) -> None:
    def seen_ns(child: str, stamp_ns: int, x: float, received_ns: int) -> int:
        is_static = child == "laser"
        buffer.set_transform(
            "base", child, stamp_ns, (x, 0.0, 0.0), UNIT, is_static, "", received_ns
        )
        return buffer.tree.caches[child].seen_ns

    assert seen_ns("wheel", S, 1.0, 2 * S) == 2 * S
    assert seen_ns("wheel", S, 1.0, 3 * S) == 2 * S, "repeated"
    assert seen_ns("wheel", 2 * S, 1.0, 4 * S) == 4 * S
    assert seen_ns("wheel", S, 1.0, 5 * S) == 4 * S, "older than the newest"
    assert seen_ns("laser", S, 1.0, 2 * S) == 2 * S
    assert seen_ns("laser", 2 * S, 1.0, 3 * S) == 2 * S
    assert seen_ns("laser", 3 * S, 2.0, 4 * S) == 4 * S
