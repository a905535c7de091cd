"""Two publishers of one frame: told from a restart, named as far as known, and forgotten."""

import pytest

from tests.data.transforms.conftest import HandFedBuffer
from webviz.data.transforms import TransformBuffer
from webviz.data.transforms.publishers import Contest

S = 1_000_000_000


def conflicts(buffer: TransformBuffer, frame: str) -> list[str]:
    return [str(conflict.problem) for conflict in buffer.conflicts.of(frame)]


def contest(buffer: TransformBuffer, frame: str) -> Contest | None:
    return buffer.publishers[frame].contest


def test_alternating_authorities_are_distinguished_from_a_restart(buffer: HandFedBuffer) -> None:
    buffer.put("map", "odom", 1.0, authority="amcl")
    buffer.put("map", "odom", 1.1, authority="amcl again")
    buffer.put("map", "odom", 1.2, authority="amcl again")
    assert contest(buffer, "odom") is None
    buffer.put("map", "odom", 1.3, authority="amcl")
    assert contest(buffer, "odom") == Contest(("amcl again", "amcl"), 1_300_000_000)
    assert set(buffer.publishers["odom"].names()) == {"amcl", "amcl again"}
    assert conflicts(buffer, "odom") == [
        '"odom" has two publishers, amcl again and amcl. Stop one of the publishers.'
    ]


def test_a_contest_of_authorities_is_over_when_one_is_silent_for_the_cache_time(
    buffer: HandFedBuffer,
) -> None:
    for i in range(4):
        buffer.put("map", "odom", 1.0 + i / 10, authority=("amcl", "slam")[i % 2])
    buffer.put("map", "odom", 11.2, authority="slam")
    assert len(conflicts(buffer, "odom")) == 1
    buffer.put("map", "odom", 11.4, authority="slam")
    assert conflicts(buffer, "odom") == []


def test_a_static_publisher_that_restarts_with_another_pose_is_not_contested(
    buffer: HandFedBuffer,
) -> None:
    buffer.put("base", "laser", x=1.0, is_static=True, authority="first")
    buffer.put("base", "laser", x=2.0, is_static=True, authority="second")
    buffer.put("base", "laser", x=2.0, is_static=True, authority="second")
    assert contest(buffer, "laser") is None
    assert buffer.publishers["laser"].changes == 1


def test_static_publishers_that_agree_are_not_contested(buffer: HandFedBuffer) -> None:
    for name in ("first", "second", "first", "second"):
        buffer.put("base", "laser", x=1.0, is_static=True, authority=name)
    assert contest(buffer, "laser") is None
    assert buffer.publishers["laser"].changes == 0
    assert buffer.publishers["laser"].current == "second"


@pytest.mark.parametrize(
    ("other", "x", "words"),
    [
        ("camera", 1.0, 'two parents in static transforms, "base" and "camera"'),
        ("base", 1.25, 'two static poses in "base", 0.250 m apart'),
    ],
)
def test_alternating_static_transforms_are_a_conflict_without_known_publishers(
    buffer: HandFedBuffer, other: str, x: float, words: str
) -> None:
    for _ in range(2):
        buffer.put("base", "laser", x=1.0, is_static=True)
        buffer.put(other, "laser", x=x, is_static=True)
    (sentence,) = conflicts(buffer, "laser")
    assert words in sentence


def test_three_static_publishers_are_contested_as_well(buffer: HandFedBuffer) -> None:
    for parent in ("a", "b", "c", "a"):
        buffer.put(parent, "laser", is_static=True)
    assert contest(buffer, "laser") is not None


def test_a_frame_that_is_static_and_moving_in_turn_is_contested(buffer: HandFedBuffer) -> None:
    buffer.put("base", "laser", is_static=True)
    buffer.put("base", "laser", 1.0)
    assert contest(buffer, "laser") is None
    buffer.put("base", "laser", is_static=True)
    buffer.put("base", "laser", 50.0)
    (sentence,) = conflicts(buffer, "laser")
    assert 'published on /tf and as a static transform in "base"' in sentence


def test_quarrels_are_forgotten_when_publishers_came_or_went(buffer: HandFedBuffer) -> None:
    for parent in ("a", "b", "a"):
        buffer.put(parent, "laser", is_static=True)
    buffer.forget_publishers()
    assert conflicts(buffer, "laser") == []
    buffer.put("b", "laser", is_static=True)
    assert contest(buffer, "laser") is None
    buffer.put("a", "laser", is_static=True)
    buffer.clear()
    assert contest(buffer, "laser") is None


def test_poses_that_leap_to_and_fro_betray_two_publishers_without_names(
    buffer: HandFedBuffer,
) -> None:
    for i in range(20):
        buffer.put("map", "odom", 1.0 + i / 10, x=0.01 * i + (3.0 if i % 2 else 0.0))
    (sentence,) = conflicts(buffer, "odom")
    assert "alternates between two poses" in sentence


def test_neither_a_drive_nor_a_leap_nor_standing_still_is_a_quarrel(buffer: HandFedBuffer) -> None:
    for i in range(30):
        buffer.put("map", "drive", 1.0 + i / 10, x=0.1 * i)
        buffer.put("map", "leap", 1.0 + i / 10, x=0.1 * i + (5.0 if i > 20 else 0.0))
        buffer.put("map", "stand", 1.0 + i / 10, x=1.0)
        buffer.put("map", "tick", 1.0 + i / 10, x=0.001 * (i % 2))
    assert [conflicts(buffer, f) for f in ("drive", "leap", "stand", "tick")] == [[]] * 4


def test_conflicts_are_sought_again_only_where_a_transform_has_arrived(
    buffer: HandFedBuffer,
) -> None:
    for i in range(4):
        buffer.put("map", "odom", 1.0 + i / 10, authority=("amcl", "slam")[i % 2])
    buffer.put("base", "laser", is_static=True)
    before = {frame: buffer.conflicts.of(frame) for frame in ("odom", "laser")}
    buffer.put("base", "camera", is_static=True)
    assert all(buffer.conflicts.of(frame) is conflict for frame, conflict in before.items())
    buffer.put("map", "odom", 1.4, authority="slam")
    assert buffer.conflicts.of("odom") is not before["odom"]
