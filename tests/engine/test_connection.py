"""Topics of displays that follow a protocol of their own."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import pytest

from webviz.engine.pipeline import connection
from webviz.engine.pipeline.background import Workers
from webviz.engine.pipeline.connection import DisplayConnection
from webviz.sources import Offer, Publisher, Raw

WORDS = "/words"


@pytest.fixture
def connected() -> DisplayConnection:
    """A connection by which a display listens to a topic."""
    restricted_graph = cast(Any, SimpleNamespace(refusal=lambda name: ""))
    services = cast(Any, SimpleNamespace(resolve=lambda name: name, workers=Workers(lambda: None)))
    connection = DisplayConnection(services, restricted_graph)
    listen(connection)
    return connection


def listen(connection: DisplayConnection) -> tuple[list[int], bool]:
    """Sizes of the messages since the last call, and whether others were missed before them."""
    result = connection.listen(WORDS, "std_msgs/msg/String", 10)
    return [len(each) for each in result.messages], result.has_gap


def take(connection: DisplayConnection, *sizes: int) -> None:
    connection.take({WORDS: [Raw(bytes(size), 0) for size in sizes]}, {})


@pytest.mark.parametrize(("limit", "number"), [("LIMIT", 3), ("MAX_BYTES", 90)])
def test_messages_waiting_for_a_display_are_bounded_and_a_gap_is_reported(
    connected: DisplayConnection, monkeypatch: pytest.MonkeyPatch, limit: str, number: int
) -> None:
    monkeypatch.setattr(connection, limit, number)
    take(connected, 30, 30, 30)
    assert listen(connected) == ([30, 30, 30], False)
    take(connected, 30, 30)
    take(connected, 30, 30)
    take(connected, 30)  # of no use after the gap
    assert listen(connected) == ([], True)
    take(connected, 30)
    assert listen(connected) == ([30], False)


def test_one_message_is_kept_however_large(
    connected: DisplayConnection, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "MAX_BYTES", 100)
    take(connected, 1000)
    assert listen(connected) == ([1000], False)


def test_topics_a_display_no_longer_names_are_released(connected: DisplayConnection) -> None:
    connected.advertise("/answers", "std_msgs/msg/String", 7)
    connected.forget_unnamed()
    assert (connected.topics(), [each.depth for each in connected.advertisements()]) == (
        (WORDS,),
        [7],
    )
    listen(connected)
    connected.forget_unnamed()
    assert (connected.topics(), connected.advertisements()) == ((WORDS,), [])
    connected.forget_unnamed()
    assert connected.topics() == ()


def test_a_pause_or_another_depth_is_a_gap(connected: DisplayConnection) -> None:
    take(connected, 30)
    connected.pause()
    take(connected, 30)
    assert listen(connected) == ([], True)
    take(connected, 30)
    assert listen(connected) == ([30], False)
    take(connected, 30)
    result = connected.listen(WORDS, "std_msgs/msg/String", 20)
    assert (result.messages, result.has_gap) == ((), True)
    assert connected.subscriptions()[WORDS].topic.depth == 20


def test_a_publisher_counts_once_its_type_fits_and_the_topic_is_subscribed(
    connected: DisplayConnection,
) -> None:
    right = Publisher("/a", "std_msgs/msg/String", "reliable", "volatile", b"1")
    other = Publisher("/b", "std_msgs/msg/Int8", "reliable", "volatile", b"2")
    requested = "reliable", "volatile"
    for offer, is_ready in (
        (Offer((right, other)), False),
        (Offer((right, other), requested, type=other.type), False),
        (Offer((right, other), requested, type=right.type), True),
    ):
        connected.take({}, {WORDS: offer})
        result = connected.listen(WORDS, right.type, 10)
        assert (result.publishers, result.endpoints) == (("/a",), {b"1"})
        assert result.is_ready == is_ready


def test_work_is_under_way_until_its_result_can_be_taken(connected: DisplayConnection) -> None:
    job = connected.run(len, "result")
    assert job.result(60) == 6
    assert connected.is_busy(), "the result has not been taken"
    connected.look()
    assert not connected.is_busy()
