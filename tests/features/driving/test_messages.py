"""Acceptance of set-points from pages."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from webviz.api.vehicle import Velocity
from webviz.engine.driving import DrivingAnswer
from webviz.features.driving.messages import BEAT_S, FRESH_S, SLOW, DrivingMessages
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Drive, DrivingReport

HEARTBEAT_S = 0.05
"""Pause in seconds between two heartbeats of a page."""


class Pages(Channel):
    """Pages whose messages a test sends, and whose answers it reads."""

    def __init__(self) -> None:
        super().__init__()
        self.answers: list[DrivingReport] = []
        self.beats: list[float | None] = []
        self.now = 100.0
        self.noted: list[int] = []
        self.other: int | None = None
        """Another browser that drives."""
        DrivingMessages(self, self._steer, lambda browser, _: self.noted.append(browser), self._at)

    def on(self, kind: Any, listener: Callable[[int, Any], object]) -> None:
        self._hear_drive = listener

    def send(self, message: Any, browser: int | None = None) -> None:
        self.answers.append(message)

    def _at(self) -> float:
        return self.now

    def _steer(self, tool: str, browser: int, share: Velocity, beat: float | None) -> DrivingAnswer:
        self.beats.append(beat)
        return DrivingAnswer(self.other if beat is None else browser)

    def drive(self, beat: int, after: float = 0.0) -> DrivingReport:
        """Send a set-point after some seconds; the answer."""
        self.now += after
        self._hear_drive(1, Drive("drive", beat, 1.0, 0.0, 0.0))
        return self.answers[-1]


@pytest.fixture
def pages() -> Pages:
    return Pages()


def test_a_set_point_counts_with_a_beat_that_the_page_has_just_received(pages: Pages) -> None:
    first = pages.drive(0)
    assert first.problem == ""
    second = pages.drive(first.beat, FRESH_S - 0.01)
    third = pages.drive(second.beat, HEARTBEAT_S)
    assert pages.beats == [None, 100.0, pytest.approx(100.0 + FRESH_S - 0.01)]
    assert len({first.beat, second.beat, third.beat}) == 3
    assert third.problem == ""


def test_a_stale_set_point_is_refused_with_the_reason(pages: Pages) -> None:
    answer = pages.drive(pages.drive(0).beat, FRESH_S)
    assert pages.beats == [None, None]
    assert (answer.driver, answer.problem) == (None, SLOW)
    pages.drive(pages.drive(answer.beat).beat)
    assert pages.beats[2:] == [pages.now, pages.now]


def test_each_heartbeat_of_a_page_brings_a_new_beat_and_a_flood_keeps_them(pages: Pages) -> None:
    first = pages.drive(0)
    for _ in range(200):
        pages.drive(first.beat, 0.002)
    assert pages.beats[-1] == 100.0
    assert len({answer.beat for answer in pages.answers}) <= 0.4 / BEAT_S + 1


def test_the_beginning_of_each_drive_is_noted_once(pages: Pages) -> None:
    answer = pages.drive(0)
    for _ in range(3):
        answer = pages.drive(answer.beat, HEARTBEAT_S)
    answer = pages.drive(answer.beat, 2 * FRESH_S)  # it has let go
    pages.drive(answer.beat)
    assert pages.noted == [1, 1]


@pytest.mark.parametrize("other", [0, 2])
def test_an_onlooker_is_not_in_the_journal_while_another_browser_drives(
    pages: Pages, other: int
) -> None:
    pages.other = other
    assert pages.drive(0).driver == other
    assert pages.noted == []
