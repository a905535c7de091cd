"""Drags of handles by pages: passed on in order, of several moves only the newest."""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

import msgspec

from webviz.page.asked import Asked
from webviz.page.dispatcher import Dispatcher

MAX_DRAGS = 50
"""Drags other than moves, of a browser within a second; people make one or two."""
FORGOTTEN_S = 10.0
"""After which the drag of a silent browser is forgotten."""


class _Hand(msgspec.Struct):
    """Drag of one browser.

    Args:
        sent: the last move, until the frame loop has taken it up.
        next: the newest move since.
        heard_s: when it did something.
    """

    sent: Future[str] | None = None
    next: tuple[Asked, Any] | None = None
    heard_s: float = 0.0


class DragMessages:
    """Passes on drags. Of these, only refusals are answered.

    Args:
        dispatcher: of what pages ask for.
        clock: monotonic time in seconds.
    """

    def __init__(
        self,
        dispatcher: Dispatcher,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._enqueue = dispatcher.enqueue
        dispatcher.take("DragHandle", self.drag, _most)
        self._clock = clock
        self._hands: dict[int, _Hand] = {}

    def drag(self, asked: Asked, command: Any) -> None:
        """Pass a drag on, at once unless a move before it still waits for the frame loop."""
        now = self._clock()
        hands = self._hands.items()
        self._hands = {id: hand for id, hand in hands if now - hand.heard_s < FORGOTTEN_S}
        hand = self._hands.setdefault(asked.browser, _Hand())
        hand.heard_s = now
        if command.drag.kind == "move":
            hand.next = asked, command
            if hand.sent is None or hand.sent.done():
                self._move(hand)
            return
        if hand.next is not None:
            self._move(hand)
        self._send(asked, command)

    def _move(self, hand: _Hand) -> None:
        """Pass on the newest move."""
        move, hand.next = hand.next, None
        if move is not None:
            hand.sent = self._send(*move)

    def _send(self, asked: Asked, command: Any) -> Future[str]:
        sent = self._enqueue(command, asked.sender)
        sent.add_done_callback(asked.refused_by)
        return sent


def _most(command: Any) -> int:
    """Return how many such drags a browser may send within a second: of moves, one is done."""
    return 0 if command.drag.kind == "move" else MAX_DRAGS
