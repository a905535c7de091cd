"""The part of the past that a seek reads, and the reach of a step towards a time."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from bags import START_NS, TF, Bag, ns, strings

from webviz.api.declared import Topic
from webviz.api.lookback import Lookback
from webviz.sources import Subscription
from webviz.sources.bag.history import BagHistory
from webviz.sources.history.needed import NeededMessages
from webviz.sources.history.playhead import MAX_BATCH, Playhead
from webviz.sources.player import Player

STRING, POSE = "std_msgs/msg/String", "geometry_msgs/msg/PoseStamped"


@contextmanager
def open_history(path: Path) -> Iterator[BagHistory]:
    history = BagHistory(path)
    yield history
    history.close()


def moving(last_s: int) -> Bag:
    """A transform each second."""
    bag = Bag()
    for at_s in range(last_s + 1):
        bag.transform(at_s, "map", "base")
    return bag


def transforms_read(path: Path, at_s: int) -> list[int]:
    """Return when the transforms were recorded that a seek reads, with strings that are placed."""
    subscription = {
        "/tf": Subscription(TF, Topic("/tf")),
        "/words": Subscription(STRING, Topic("/words"), lookbacks=(Lookback(),), is_placed=True),
    }
    with open_history(path) as history:
        past = NeededMessages(
            history, history.channels(subscription), subscription, START_NS + ns(at_s)
        )
        return [(each.stamp_ns - START_NS) // ns(1) for each in past.messages() if each.type == TF]


def test_transforms_of_the_last_15_s_are_read(tmp_path: Path) -> None:
    path = moving(40).write(tmp_path / "run")
    assert transforms_read(path, 30) == [*range(15, 31)]


def test_transforms_around_an_older_message_are_read_too(tmp_path: Path) -> None:
    bag = moving(90)
    bag.add("/words", STRING)
    bag.put(30, "/words", {"data": "old"})
    assert transforms_read(bag.write(tmp_path / "run"), 80) == [*range(20, 34), *range(65, 81)]


@pytest.mark.parametrize(("count", "is_all"), [(100, False), (101, True)])
def test_all_transforms_are_read_if_more_than_100_messages_are_older(
    tmp_path: Path, count: int, is_all: bool
) -> None:
    bag = moving(120)
    bag.add("/words", STRING)
    for number in range(count):
        bag.put(80 if number else 20, "/words", {"data": "old"})
    parts = [*range(10, 24), *range(70, 84), *range(104, 120)]
    read = transforms_read(bag.write(tmp_path / "run"), 119)
    assert read == ([*range(120)] if is_all else parts)


def test_a_lookback_ends_where_a_message_starts_over(tmp_path: Path) -> None:
    path = strings(1, 2, 3, 4).write(tmp_path / "run")
    begins = Lookback(starts_over=lambda message, type_name: message.data.endswith("2"))
    subscription = {"/words": Subscription(STRING, Topic("/words"), lookbacks=(begins,))}
    with open_history(path) as history:
        past = NeededMessages(
            history, history.channels(subscription), subscription, START_NS + ns(4)
        )
        assert [(each.stamp_ns - START_NS) // ns(1) for each in past.messages()] == [2, 3, 4]


def test_messages_that_were_placed_when_transforms_ended_are_read(tmp_path: Path) -> None:
    bag = moving(10)
    bag.add("/pose", POSE)
    for at_s in range(41):
        bag.put(at_s, "/pose", {"header": {"frame_id": "base"}})
    newest = Subscription(POSE, Topic("/pose"), lookbacks=(Lookback(count=1),), is_placed=True)
    subscription = {"/tf": Subscription(TF, Topic("/tf")), "/pose": newest}
    with open_history(bag.write(tmp_path / "run")) as history:
        past = NeededMessages(
            history, history.channels(subscription), subscription, START_NS + ns(40)
        )
        poses = [each.stamp_ns - START_NS for each in past.messages() if each.type == POSE]
    assert poses == [ns(10), ns(11), ns(40)]


@pytest.mark.parametrize(("left_s", "step_s"), [(0.4, 0.1), (8, 1), (12, 1.5), (16, 2), (60, 2)])
def test_a_step_goes_an_eighth_of_the_way_within_bounds(
    tmp_path: Path, left_s: float, step_s: float
) -> None:
    source = Player(
        BagHistory(strings(*[0.1 * tenth for tenth in range(700)]).write(tmp_path / "run"))
    )
    source.want({"/words": Subscription(STRING, Topic("/words"))})
    source.play_until(source.history.start_ns)
    source.play_step(source.history.start_ns + ns(left_s))
    assert source.reached_ns == source.history.start_ns + ns(step_s)
    source.close()


def test_a_lookback_of_seconds_begins_to_the_nanosecond(tmp_path: Path) -> None:
    path = strings(1.999999999, 2, 3).write(tmp_path / "run")
    subscription = {
        "/words": Subscription(STRING, Topic("/words"), lookbacks=(Lookback(seconds=2.0),))
    }
    with open_history(path) as history:
        past = NeededMessages(
            history, history.channels(subscription), subscription, START_NS + ns(4)
        )
        assert [each.stamp_ns - START_NS for each in past.messages()] == [ns(2), ns(3)]


def test_as_many_messages_are_played_at_once_as_an_inbox_holds(tmp_path: Path) -> None:
    path = strings(*(number / 1000 for number in range(MAX_BATCH + 20))).write(tmp_path / "run")
    delivered: list[str] = []
    with open_history(path) as history:
        playhead = Playhead(history, lambda topic, raw: delivered.append(topic))
        playhead.subscribe({"/words": Subscription(STRING, Topic("/words"))})
        playhead.play(history.end_ns)
        assert (len(delivered), playhead.position_ns < history.end_ns) == (MAX_BATCH, True)
        playhead.play(history.end_ns)
        assert (len(delivered), playhead.position_ns) == (MAX_BATCH + 20, history.end_ns)
