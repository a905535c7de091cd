"""Set-points of pages that drive, straight from the channel: the frame loop may be busy."""

from __future__ import annotations

import secrets
import time
from collections import deque
from collections.abc import Callable
from typing import TypeAlias

from webviz.api.vehicle import Velocity
from webviz.engine.driving import DrivingAnswer
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Drive, DrivingReport

FRESH_S = 0.5
"""A heartbeat counts if it answers a beat no older than this: the slowest link that can drive."""
BEAT_S = 0.02
"""Pause in seconds between two beats, less than between the heartbeats of a page, so that each
brings a new one."""

SLOW = "The connection to webviz is too slow to drive."

Steer: TypeAlias = Callable[[str, int, Velocity, float | None], DrivingAnswer]


class DrivingMessages:
    """Passes on what is held on pages.

    A page that is gone may have left messages behind, in buffers of the network or because it sent
    more than is read. Therefore a set-point counts only if it comes with a beat, a random number,
    that the page has just received.

    Args:
        channel: to the pages.
        steer: takes a set-point: tool, browser, shares of the highest speeds, and when the beat
            that comes with it was sent, None if that is too long ago.
        note: is told which browser begins to drive.
        clock: the time in seconds.
    """

    def __init__(
        self,
        channel: Channel,
        steer: Steer,
        note: Callable[[int, str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._channel = channel
        self._steer = steer
        self._note = note
        self._clock = clock
        self._drivers: dict[str, int] = {}
        self._beats: deque[tuple[float, int]] = deque(maxlen=round(FRESH_S / BEAT_S) + 1)
        channel.on(Drive, self._hear)

    def _hear(self, browser: int, drive: Drive) -> None:
        now = self._clock()
        velocity = Velocity(drive.linear, drive.lateral, drive.angular)
        fresh = (at for at, beat in self._beats if beat == drive.beat and now - at < FRESH_S)
        heartbeat = next(fresh, None)
        answer = self._steer(drive.tool, browser, velocity, heartbeat)
        if answer.driver is None:
            self._drivers.pop(drive.tool, None)
        elif answer.driver == browser and self._drivers.get(drive.tool) != browser:
            self._drivers[drive.tool] = browser
            self._note(browser, "Started driving.")
        if not self._beats or now - self._beats[-1][0] >= BEAT_S:
            self._beats.append((now, 1 + secrets.randbits(52)))
        beat = self._beats[-1][1]
        problem = answer.problem or (SLOW if drive.beat and heartbeat is None else "")
        self._channel.send(DrivingReport(drive.tool, beat, answer.driver, problem), browser)
