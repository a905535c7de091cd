"""Pause, times, topics and the tree of transforms: what the panel's other tabs show."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from webviz.api.declared import Topic
from webviz.engine.commands import Command, InspectTopic, InspectTransforms, Pause, Reset
from webviz.engine.sources import Offer, Publisher
from webviz.engine.state import State
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz_displays.path import Path

PATH = "nav_msgs/msg/Path"


def do(b: Any, *commands: Command) -> State:
    for command in commands:
        b.viewer.enqueue(command)
    b.viewer._next_panel = 0.0
    b.turn()
    return b.states[-1]


def publish(b: Any, x: float) -> None:
    pose = {"position": {"x": x}, "orientation": {"w": 1.0}}
    poses = [{"header": header("map", b.source.now), "pose": pose}] * 2
    b.publish("/path", PATH, {"header": header("map", b.source.now), "poses": poses})


def drawn(b: Any) -> list[float]:
    """Where the path begins, if it is drawn."""
    b.turn()
    return [float(node.segments[0, 0, 0]) for _, _, node in b.scene.visible()]


def test_while_paused_the_picture_and_the_time_stand_still_and_messages_wait(
    bench: Callable[..., Any],
) -> None:
    b = bench(Path(name="P", topic=Topic("/path")))
    publish(b, 1.0)
    assert drawn(b) == [1.0]
    do(b, Pause())
    b.source.now += SECOND
    publish(b, 2.0)
    assert drawn(b) == [1.0]
    clock = do(b).clock
    assert (clock.is_paused, clock.ros_ns) == (True, 100 * SECOND)
    clock = do(b, Pause(False)).clock
    assert (clock.is_paused, clock.ros_ns) == (False, 101 * SECOND)
    assert drawn(b) == [2.0]


def test_times_count_from_the_start_and_from_a_reset(bench: Callable[..., Any]) -> None:
    b = bench()
    b.source.now += 3 * SECOND
    assert do(b).clock.ros_elapsed_ns == 3 * SECOND
    assert do(b, Reset()).clock.ros_elapsed_ns == 0
    b.source.now += SECOND
    assert do(b).clock.ros_elapsed_ns == SECOND


def test_the_rates_of_topics_are_measured_over_the_last_seconds(
    bench: Callable[..., Any],
) -> None:
    b = bench(Path(name="P", topic=Topic("/path")))
    do(b)
    for _ in range(20):
        b.clock += 0.5
        for _ in range(5):
            publish(b, 1.0)
        do(b)
    traffic = do(b).traffic["/path"]
    assert traffic.rate_hz == pytest.approx(10.0)
    assert 100 < traffic.bytes_per_s / traffic.rate_hz < 400
    for _ in range(20):
        b.clock += 0.5
        do(b)
    assert do(b).traffic["/path"].rate_hz == 0.0


def test_a_topic_that_no_display_shows_can_be_looked_into(bench: Callable[..., Any]) -> None:
    b = bench()
    inspected = do(b, InspectTopic("/text")).inspected
    assert inspected is not None
    assert inspected.text == "No publisher on this topic."
    publisher = Publisher("/talker", "std_msgs/msg/String", "reliable", "volatile")
    b.source.known["/text"] = Offer((publisher,))
    assert "No message" in do(b).inspected.text  # pyright: ignore[reportOptionalMemberAccess]
    assert b.source.wanted["/text"].type == "std_msgs/msg/String"
    b.publish("/text", "std_msgs/msg/String", {"data": "hello"})
    inspected = do(b).inspected
    assert inspected is not None
    assert (inspected.text, inspected.age_s) == ("data: 'hello'", 0.0)
    b.clock += 2.0
    inspected = do(b).inspected
    assert inspected is not None
    assert inspected.age_s == 2.0
    b.scene.watched = False
    b.turn()
    assert "/text" not in b.source.wanted
    b.scene.watched = True
    b.turn()
    assert "/text" in b.source.wanted
    assert do(b, InspectTopic("")).inspected is None
    assert "/text" not in b.source.wanted


def test_a_message_that_cannot_be_read_is_told(bench: Callable[..., Any]) -> None:
    b = bench()
    publisher = Publisher("/talker", "nav_msgs/msg/Path", "reliable", "volatile")
    b.source.known["/path"] = Offer((publisher,))
    do(b, InspectTopic("/path"))
    b.publish("/path", "std_msgs/msg/String", {"data": "no path"})
    inspected = do(b).inspected
    assert inspected is not None
    assert inspected.text.startswith("The last message cannot be read: ")


def test_a_topic_that_a_display_shows_is_looked_into_with_its_subscription(
    bench: Callable[..., Any],
) -> None:
    b = bench(Path(name="P", topic=Topic("/path", reliability="best_effort")))
    publish(b, 1.0)
    do(b, InspectTopic("/path"))
    assert b.source.wanted["/path"].topic.reliability == "best_effort"
    publish(b, 7.5)
    inspected = do(b).inspected
    assert inspected is not None
    assert "7.5" in inspected.text
    assert drawn(b) == [7.5]


def test_the_tree_of_transforms_is_reported_while_somebody_wants_it(
    bench: Callable[..., Any],
) -> None:
    b = bench()
    b.transform("map", "odom", 0, static=True)
    assert do(b).transforms == ""
    assert do(b, InspectTransforms()).transforms.splitlines()[1].startswith("└─ odom  [static")
    b.scene.watched = False
    assert do(b).transforms == ""
    b.scene.watched = True
    assert do(b, InspectTransforms(False)).transforms == ""


def test_a_display_that_nobody_watches_does_not_ask_for_something_to_draw(
    bench: Callable[..., Any],
) -> None:
    b = bench(Path(name="P", topic=Topic("/path")))
    b.scene.watched = False
    publish(b, 1.0)
    b.turn()
    assert b.statuses()["Display"] == ("OK", "Nothing is drawn until a browser connects.")
    b.scene.watched = True
    b.turn()
    assert "Display" not in b.statuses()
