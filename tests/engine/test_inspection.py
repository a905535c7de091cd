"""Pause, times, topics and the tree of transforms: what the panel's other tabs show."""

from __future__ import annotations

import time
from typing import Any

import pytest
from bench import Bench, Benches

from webviz.api.declared import Topic
from webviz.api.nodes import Lines
from webviz.api.status import Level
from webviz.commands import InspectTopic, InspectTopics, InspectTransforms, Pause, Reset
from webviz.engine.commands import Command
from webviz.engine.state import State
from webviz.features.topics import MAX_INSPECTED
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz.sources import Offer, Publisher
from webviz_displays.image import Image
from webviz_displays.path import Path

PATH = "nav_msgs/msg/Path"
STRING = "std_msgs/msg/String"


def do(b: Bench, *commands: Command) -> State:
    for command in commands:
        b.viewer.enqueue(command)
    b.turn(keep_up=True)
    return b.states[-1]


def publish(b: Bench, x: float) -> None:
    pose = {"position": {"x": x}, "orientation": {"w": 1.0}}
    poses = [{"header": header("map", b.source.now), "pose": pose}] * 2
    b.publish("/path", PATH, {"header": header("map", b.source.now), "poses": poses})


def drawn_starts(b: Bench) -> list[float]:
    """Return where the path begins, if it is drawn."""
    b.turn()
    return [float(node.segments[0, 0, 0]) for node in b.nodes(Lines)]


def test_while_paused_the_picture_and_the_time_stand_still_and_messages_wait(
    bench: Benches,
) -> None:
    b = bench(Path(name="P", topic=Topic("/path")))
    publish(b, 1.0)
    assert drawn_starts(b) == [1.0]
    do(b, Pause())
    b.source.now += SECOND
    publish(b, 2.0)
    assert drawn_starts(b) == [1.0]
    clock = do(b).clock
    assert (clock.is_paused, clock.ros_ns) == (True, 100 * SECOND)
    clock = do(b, Pause(False)).clock
    assert (clock.is_paused, clock.ros_ns) == (False, 101 * SECOND)
    assert drawn_starts(b) == [2.0]


def test_times_count_from_the_start_and_from_a_reset(bench: Benches) -> None:
    b = bench()
    b.source.now += 3 * SECOND
    assert do(b).clock.ros_elapsed_ns == 3 * SECOND
    assert do(b, Reset()).clock.ros_elapsed_ns == 0
    b.source.now += SECOND
    assert do(b).clock.ros_elapsed_ns == SECOND


def test_the_rates_of_topics_are_measured_over_the_last_seconds(bench: Benches) -> None:
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


def test_the_delay_of_a_topic_is_from_its_stamp_to_its_arrival(bench: Benches) -> None:
    b = bench(Path(name="P", topic=Topic("/path")))
    do(b)
    stamp = header("map", b.source.now)
    b.source.now += SECOND // 4
    b.publish("/path", PATH, {"header": stamp, "poses": []})
    b.clock += 1.0
    assert do(b).traffic["/path"].delay_s == pytest.approx(0.25)


def test_the_delay_of_a_topic_is_measured_once_a_second_and_unknown_without_a_stamp(
    bench: Benches,
) -> None:
    b = bench(Path(name="P", topic=Topic("/path")))
    do(b)

    def delay_s(after_s: float, stamp: dict[str, Any]) -> float | None:
        b.clock += after_s
        b.publish("/path", PATH, {"header": stamp, "poses": []})
        b.turn()
        b.clock += 0.25
        return do(b).traffic["/path"].delay_s

    now = header("map", b.source.now)
    assert delay_s(2.0, now) == 0.0
    b.source.now += SECOND
    assert delay_s(0.25, now) == 0.0
    assert delay_s(2.0, now) == pytest.approx(1.0)
    assert delay_s(2.0, header("map", 0)) is None


def test_a_topic_that_no_display_shows_can_be_looked_into(bench: Benches) -> None:
    b = bench()
    assert do(b, InspectTopic("/text")).inspected["/text"].problem == "No publisher on this topic."
    publisher = Publisher("/talker", STRING, "reliable", "volatile")
    b.source.topics["/text"] = Offer((publisher,))
    assert do(b).inspected["/text"].problem == "No message has arrived yet."
    assert b.source.subscriptions["/text"].type == STRING
    b.publish("/text", STRING, {"data": "hello"})
    inspected = do(b).inspected["/text"]
    assert (inspected.message, inspected.type) == ({"fields": {"data": "'hello'"}}, STRING)
    assert inspected.received_s == pytest.approx(time.time(), abs=30)
    b.scene.watched = False
    b.turn()
    assert "/text" not in b.source.subscriptions
    b.scene.watched = True
    b.turn()
    assert "/text" in b.source.subscriptions
    assert do(b, InspectTopic("")).inspected == {}
    assert "/text" not in b.source.subscriptions


def test_a_message_is_read_once_a_second_at_most(bench: Benches) -> None:
    b = bench()
    b.source.topics["/text"] = Offer((Publisher("/talker", STRING, "reliable", "volatile"),))
    do(b, InspectTopic("/text"))
    for text in ("one", "two"):
        b.publish("/text", STRING, {"data": text})
        b.clock += 0.1
        assert do(b).inspected["/text"].message == {"fields": {"data": "'one'"}}
    b.clock += 1.0
    assert do(b).inspected["/text"].message == {"fields": {"data": "'two'"}}


def test_pages_look_into_several_topics_besides_that_of_a_program(bench: Benches) -> None:
    b = bench()
    state = do(b, InspectTopic("/a"), InspectTopics(frozenset({"/b", "/c"})))
    assert set(state.inspected) == {"/a", "/b", "/c"}
    assert set(do(b, InspectTopics(frozenset({"/c"}))).inspected) == {"/a", "/c"}
    many = frozenset(f"/t{i}" for i in range(1000))
    assert len(do(b, InspectTopics(many)).inspected) == MAX_INSPECTED + 1


def test_an_undecodable_message_is_reported(bench: Benches) -> None:
    b = bench()
    publisher = Publisher("/talker", "nav_msgs/msg/Path", "reliable", "volatile")
    b.source.topics["/path"] = Offer((publisher,))
    do(b, InspectTopic("/path"))
    b.publish("/path", STRING, {"data": "no path"})
    assert do(b).inspected["/path"].problem.startswith("The last message cannot be read: ")


def test_a_topic_that_a_display_shows_is_looked_into_with_its_subscription(bench: Benches) -> None:
    b = bench(Path(name="P", topic=Topic("/path", reliability="best_effort")))
    publish(b, 1.0)
    do(b, InspectTopic("/path"))
    assert b.source.subscriptions["/path"].topic.reliability == "best_effort"
    publish(b, 7.5)
    b.clock += 1.0
    assert "7.5" in str(do(b).inspected["/path"].message)
    assert drawn_starts(b) == [7.5]


def test_the_tree_of_transforms_is_reported_on_request(bench: Benches) -> None:
    b = bench()
    b.transform("map", "odom", 0, static=True)
    assert do(b).transforms is None
    (report,) = do(b, InspectTransforms()).transforms.frames  # pyright: ignore[reportOptionalMemberAccess]
    assert (report.frame, report.parent, report.is_static) == ("odom", "map", True)
    b.scene.watched = False
    assert do(b).transforms is None
    b.scene.watched = True
    assert do(b, InspectTransforms(tree=False)).transforms is None


def test_the_transform_between_two_frames_is_read_out(bench: Benches) -> None:
    b = bench()
    b.transform("map", "odom", 0, 1.0, static=True)
    b.transform("odom", "base", b.source.now - SECOND // 2)
    pairs = frozenset({("map", "odom"), ("map", "base"), ("map", "moon")})
    result = do(b, InspectTransforms(tree=False, between=pairs)).between
    assert result["map", "odom"].translation == (1.0, 0.0, 0.0)
    assert result["map", "odom"].age_s is None
    assert result["map", "base"].age_s == 0.5
    assert result["map", "moon"].translation is None
    assert "moon" in result["map", "moon"].problem
    assert do(b, InspectTransforms(tree=False)).between == {}


def test_the_topic_of_a_hidden_pane_is_not_subscribed(bench: Benches) -> None:
    b = bench(Image(name="I", topic=Topic("/image")), Path(name="P", topic=Topic("/path")))
    b.turn()
    assert "/image" in b.source.subscriptions
    b.scene.unseen = {row.id for row in do(b).rows}
    b.turn()
    assert "/image" not in b.source.subscriptions
    assert "/path" in b.source.subscriptions  # which has no pane
    row = do(b).rows[0]
    assert row.level is Level.IDLE  # neither OK, as nothing is drawn, nor a problem
    statuses = row.statuses
    assert statuses["Display"].text.startswith("Not received: no browser shows its pane.")
    b.scene.unseen = set()
    b.turn()
    assert "/image" in b.source.subscriptions


def test_a_display_without_a_browser_is_ok(bench: Benches) -> None:
    b = bench(Path(name="P", topic=Topic("/path")))
    b.scene.watched = False
    publish(b, 1.0)
    b.turn()
    assert b.statuses()["Display"] == ("OK", "Nothing is drawn until a browser connects.")
    b.scene.watched = True
    b.turn()
    assert "Display" not in b.statuses()
