"""Drags of handles by pages: passed on in order, of several moves only the newest."""

from __future__ import annotations

import time
from collections import deque
from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field

from webviz.api.handles import Grip
from webviz.api.nodes import Pose
from webviz.engine.commands import Command, GripHandle, Sender
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Gripped, GripRefused

MAX_PER_SECOND = 50
"""Grips of a browser, moves aside, within a second."""


@dataclass
class _Hand:
    """Drag of one browser.

    Args:
        recent: when it did something else than move.
        sent: the last move, until the frame loop has taken it up.
        next: the newest move since.
        heard_s: when it did something.
    """

    recent: deque[float] = field(default_factory=lambda: deque(maxlen=MAX_PER_SECOND))
    sent: Future[str] | None = None
    next: Gripped | None = None
    heard_s: float = 0.0


class GripMessages:
    """Passes on grips as commands.

    Args:
        channel: to the pages.
        enqueue: takes commands, from any thread.
        clock: monotonic time in seconds.
    """

    def __init__(
        self,
        channel: Channel,
        enqueue: Callable[[Command, Sender], Future[str]],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._channel = channel
        self._enqueue = enqueue
        self._clock = clock
        self._hands: dict[int, _Hand] = {}
        channel.on(Gripped, self._hear)

    def _hear(self, browser: int, gripped: Gripped) -> None:
        now = self._clock()
        self._hands = {id: hand for id, hand in self._hands.items() if now - hand.heard_s < 10.0}
        hand = self._hands.setdefault(browser, _Hand())
        hand.heard_s = now
        if gripped.kind == "move":
            hand.next = gripped
            if hand.sent is None or hand.sent.done():
                self._move(browser, hand)
            return
        if len(hand.recent) == MAX_PER_SECOND and hand.recent[0] > now - 1.0:
            return
        hand.recent.append(now)
        if hand.next is not None:
            self._move(browser, hand)
        self._send(browser, gripped)

    def _move(self, browser: int, hand: _Hand) -> None:
        """Pass on the newest move, and then what has come meanwhile."""
        gripped, hand.next = hand.next, None
        if gripped is not None:
            hand.sent = self._send(browser, gripped)

    def _send(self, browser: int, gripped: Gripped) -> Future[str]:
        pose = Pose(gripped.position, gripped.wxyz) if gripped.position and gripped.wxyz else None
        grip = Grip(
            gripped.handle,
            gripped.control,
            gripped.kind,
            pose,
            gripped.turned,
            gripped.point,
            gripped.entry,
        )
        sent = self._enqueue(GripHandle(gripped.display, grip), Sender(browser))
        sent.add_done_callback(lambda sent: self._answer(browser, gripped, sent))
        return sent

    def _answer(self, browser: int, gripped: Gripped, sent: Future[str]) -> None:
        if not sent.cancelled() and (error := sent.exception()):
            refused = GripRefused(f"{gripped.display}/{gripped.handle}", gripped.kind, str(error))
            self._channel.send(refused, browser)
