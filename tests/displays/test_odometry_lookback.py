"""The trail of odometry after a seek: as many messages as it follows from, and no more."""

from __future__ import annotations

import math
import random
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import SimpleNamespace
from typing import Any

import pytest

from webviz.data.messages import Odometry as Message
from webviz.data.messages import decode, encode
from webviz_displays.odometry import Odometry

TYPE = "nav_msgs/msg/Odometry"
KEEP = 15


def drive(seed: int, count: int) -> list[Message]:
    """A robot that drives, turns and rests by chance."""
    chance = random.Random(seed)
    x = y = yaw = speed = turn = 0.0
    results: list[Message] = []
    for step in range(count):
        if step % 40 == 0:
            speed = chance.choice([0.0, 0.0, 0.02, 0.05])
            turn = chance.choice([0.0, 0.0, 0.01, -0.04])
        yaw += turn * chance.uniform(0.8, 1.2)
        way = speed * chance.uniform(0.8, 1.2)
        x, y = x + way * math.cos(yaw), y + way * math.sin(yaw)
        orientation = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
        if chance.random() < 0.01:
            orientation = {}  # a fault
        pose = {"pose": {"position": {"x": x, "y": y}, "orientation": orientation}}
        results.append(decode(TYPE, encode(TYPE, {"pose": pose})))
    return results


@dataclass
class CountedPast:
    """Counts the messages that are read of a past."""

    past: Sequence[Message]
    count: int = 0

    def newest(self) -> Iterator[Message]:
        for message in reversed(self.past):
            self.count += 1
            yield message


def trail(display: Odometry, past: Sequence[Message]) -> list[Message]:
    """The newest poses after playing from the first message."""
    remaining: list[Any] = []
    for message in past:
        sample = SimpleNamespace(message=message)
        if display.accept(sample, remaining) is True:  # pyright: ignore[reportArgumentType]
            remaining.append(sample)
    return [sample.message for sample in remaining[-KEEP:]]


@pytest.mark.parametrize("seed", range(5))
def test_the_trail_after_a_seek_is_that_of_playing(seed: int) -> None:
    display = Odometry(keep=KEEP)
    chooses = display.lookback("topic").chooses
    assert chooses is not None
    drives = drive(seed, 8000)
    chance = random.Random(seed)
    read: list[int] = []
    for _ in range(8):
        past = drives[: chance.randrange(1, len(drives))]
        reader = CountedPast(past)
        chosen = sorted(chooses(reader.newest()), reverse=True)
        assert trail(display, [past[-1 - number] for number in chosen]) == trail(display, past)
        read.append(reader.count)
    assert sorted(read)[len(read) // 2] <= 2000


def test_a_robot_that_rests_for_hours_is_not_read_to_the_end() -> None:
    (message,) = drive(1, 1)
    display = Odometry(keep=KEEP)
    chooses = display.lookback("topic").chooses
    assert chooses is not None
    reader = CountedPast([message] * 100_000)
    assert list(chooses(reader.newest())) == [2999]
    assert reader.count == 3000


def test_a_trail_without_end_begins_with_the_oldest_that_is_read() -> None:
    display = Odometry(keep=0)
    chooses = display.lookback("topic").chooses
    assert chooses is not None
    past = drive(2, 8000)
    assert max(chooses(iter(past[::-1]))) > 2900
