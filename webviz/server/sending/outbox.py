"""Orders the messages for a browser: small ones first, large ones as fast as it can take them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any, Protocol, TypeVar

import msgspec
import numpy as np

from webviz.server.sending.congestion import CongestionControl
from webviz.server.sending.pieces import Piece, Pieces
from webviz.server.sending.thinning import Thinning, is_cloud, thinned

BULK_BYTES = 1 << 15
"""Size above which a message is large: clouds, images, meshes."""

LEAST_BULK_BYTES = 1 << 11
BULK_S = 0.02
"""Time in seconds; on slow links, what takes so long is large, too: scans."""

WINDOW_BYTES = 1 << 19
"""Large messages per frame. At 1 MB/s, they delay the next frame by half a second."""

TURNS = 3
"""Number of frames of which one begins with the largest messages, the others with scans."""

SLOTS = {0, 1, 2, 3}
"""Messages of which pieces may be under way at once, so that clouds go on beside a map."""

URGENT = 1.5
"""Share of the window that small messages may fill."""

REST_S = 0.5
"""Idle time before thinned clouds are sent again as a whole."""


class Message(Protocol):
    """The part of viser's messages that is used here."""

    def redundancy_key(self) -> str:
        """Return a newer message with the same key replaces this one."""
        ...


M = TypeVar("M", bound=Message)

CLOUD = "cloud"
"""Property of the messages that are parts of one thing: its name, its version, and the number of
parts in it. Pages show a version once they have all parts (`web/scene/whole.js`)."""


@dataclass(frozen=True)
class Progress:
    """Progress of a browser; those with equal progress need the same messages next.

    Args:
        cursor: number of the last message that was sent or put in the line.
        line: keys and numbers of the messages that wait.
        begun: those that are sent even if newer ones exist, by number: the other parts of a cloud
            of which it has some.
    """

    cursor: int
    line: tuple[tuple[object, int], ...]
    begun: Mapping[int, Any] = field(compare=False)


class Outbox:
    """Chooses the messages of the next websocket frame of a browser.

    A websocket delivers in order, so a frame that takes seconds delays all later ones. Hence each
    frame has all small messages, and large ones up to a limit. Large messages update existing
    nodes, so later messages may overtake them. They wait in a line, in which a newer version takes
    the place of the older one, so that a slow browser receives all of them in turn. A cloud of
    several parts that was begun is finished first, or a slow browser would never have a whole one.

    On a slow link clouds are thinned, and what is still too large for one frame is sent in pieces.
    They take turns with scans, which go on beside a map. A message in pieces is sent to its end
    even if there is a newer version, or none would ever be complete.

    Args:
        last: type of messages that must not overtake earlier ones.
        congestion: of the link.
    """

    def __init__(self, last: type, congestion: CongestionControl) -> None:
        self._last = last
        self._congestion = congestion
        self.cursor = -1
        """Number of the last message that was sent or put in the line."""
        self._line: dict[object, int] = {}
        self._begun: Mapping[int, Any] = MappingProxyType({})
        self._pieces: dict[object, _Begun] = {}
        self._turn = 0
        self._thinning = Thinning(congestion.clock)
        self._thin: dict[object, int] = {}
        """Clouds of which the browser has only some of the points."""
        self._whole: set[object] = set()
        """Messages that wait to be sent whole."""
        self._rested = 0.0

    @property
    def progress(self) -> Progress:
        """Return the progress of the browser."""
        return Progress(self.cursor, tuple(self._line.items()), self._begun)

    @progress.setter
    def progress(self, progress: Progress) -> None:
        self.cursor, self._line = progress.cursor, dict(progress.line)
        self._begun = progress.begun

    @property
    def is_common(self) -> bool:
        """Return whether it sends what other outboxes with the same progress send, and has room."""
        return self._congestion.rate is None and not (self._pieces or self._thin)

    def is_waiting(self) -> bool:
        """Return whether messages are in the line, or thinned clouds to be sent whole."""
        return bool(self._line or self._pieces or self._thin)

    def small(self, live: Mapping[int, M], newest: int, limit: int | None) -> list[M]:
        """Return the next small messages; large ones are put in the line.

        Args:
            live: the existing messages, in order of their numbers.
            newest: number of the last message to consider.
            limit: maximum count of messages to consider, or None.
        """
        if newest - self.cursor > len(live):
            numbers = [n for n in live if self.cursor < n <= newest]
        else:
            numbers = [n for n in range(self.cursor + 1, newest + 1) if n in live]
        if limit is not None and len(numbers) > limit:
            numbers = numbers[:limit]
            newest = numbers[-1]
        self.cursor = max(self.cursor, newest)
        rate = self._congestion.rate
        large = BULK_BYTES if rate is None else max(LEAST_BULK_BYTES, int(rate * BULK_S))
        large = min(large, BULK_BYTES)
        window = []
        for number in numbers:
            message = live[number]
            size = bulk(message)
            if size > large or message.redundancy_key() in self._pieces:
                self._put(message, number, size)
            elif isinstance(message, self._last):
                if getattr(message, "makes_whole", True):
                    self._make_whole(live)
                if self.is_waiting():
                    self._line[number] = number
                else:
                    window.append(message)
            else:
                window.append(message)
        return window

    def large(self, live: Mapping[int, M]) -> list[M | Piece]:
        """Return the next messages of the line that still exist: as many as there is room for."""
        if self._thin and not self._line and not self._pieces:
            if self._congestion.clock() - self._rested > REST_S:
                self._make_whole(live)
        else:
            self._rested = self._congestion.clock()
        window: list[M | Piece] = []
        room = self._congestion.room()
        room = WINDOW_BYTES if room > 0 and self.is_common else min(room, WINDOW_BYTES)
        if not (self._line or self._pieces) or room < 1:
            return window
        self._turn = (self._turn + 1) % TURNS
        if self._pieces and not self._turn:
            return self._piece(live)
        piece = self._congestion.piece()
        every = self._thinning.choose(self._congestion.rate)
        for key, number in self._order(live):
            if self._line.get(key) != number:
                continue  # its cloud was begun
            whole = live.get(number) or self._unfinished(key, number, live)
            if whole is None:
                self._leave(key)
                continue
            if isinstance(whole, self._last) and not self._is_next(key, number):
                continue
            is_thin = every > 1 and key not in self._whole and self._can_thin(whole)
            message = thinned(whole, every) if is_thin else whole
            size = bulk(message)
            if size > piece:
                if not self._cut(key, number, message):
                    continue
            else:
                room -= size
                if window and room < 0:
                    break
                window.append(message)
            self._leave(key)
            self._remember(key, number, is_thin)
            if number not in self._begun:
                self._begin(whole, live)
        if self._begun:
            self._begun = {n: self._begun[n] for n in self._line.values() if n in self._begun}
        self._congestion.every = every if self._thin else 1
        return window or self._piece(live)

    def _cut(self, key: object, number: int, message: Message) -> bool:
        """Begins to send a message in pieces, unless there are too many such messages."""
        free = SLOTS - {begun.pieces.slot for begun in self._pieces.values()}
        if key in self._pieces or not free:
            return False
        pieces = Pieces(message, min(free))  # pyright: ignore[reportArgumentType]
        is_whole = key in self._whole and key in self._thin
        self._pieces[key] = _Begun(number, is_whole, pieces)
        return True

    def _order(self, live: Mapping[int, Message]) -> list[tuple[object, int]]:
        """Return the line, mostly with scans first, but so that others have their turn."""
        line = list(self._line.items())
        if self._turn:
            line.sort(key=lambda each: not self._is_scan(live.get(each[1])))
        return line

    def _is_scan(self, message: Message | None) -> bool:
        is_large = message is None or bulk(message) > BULK_BYTES
        return not (is_large or isinstance(message, self._last))

    def _put(self, message: Message, number: int, size: int) -> None:
        key = message.redundancy_key()
        is_begun = self._line.get(key) in self._begun
        self._line[(key, "next") if is_begun else key] = number
        self._whole.discard(key)
        if self._can_thin(message):
            self._thinning.note(key, size)

    @staticmethod
    def _can_thin(message: Message) -> bool:
        return bulk(message) > BULK_BYTES and is_cloud(getattr(message, "updates", {}))

    def _is_next(self, key: object, number: int) -> bool:
        """Return whether nothing in the line is from before."""
        is_first = key == next(iter(self._line))
        return is_first and all(begun.number > number for begun in self._pieces.values())

    def _begin(self, first: Message, live: Mapping[int, M]) -> None:
        """Keep the other parts of a cloud of which one is sent."""
        cloud = _cloud(first)
        if cloud is None:
            return
        parts = {}
        for number in self._line.values():
            part = live.get(number)
            if part is not None and _cloud(part) == cloud:
                parts[number] = part
        self._begun = {**self._begun, **parts}
        self._line = {
            part.redundancy_key() if (part := parts.get(number)) else key: number
            for key, number in self._line.items()
        }

    def _unfinished(self, key: object, number: int, live: Mapping[int, M]) -> M | None:
        """Return a part of a cloud that was begun, unless the cloud is gone."""
        is_replaced = self._line.get((key, "next"), -1) in live
        return self._begun.get(number) if is_replaced else None

    def _leave(self, key: object) -> None:
        del self._line[key]
        self._whole.discard(key)

    def _remember(self, key: object, number: int, is_thin: bool) -> None:
        if is_thin:
            self._thin[key] = number
        else:
            self._thin.pop(key, None)

    def _make_whole(self, live: Mapping[int, Message]) -> None:
        """Put the clouds that were thinned in the line once more; thin none that waits there."""
        self._whole.update(self._line)
        thin = {key: number for key, number in self._thin.items() if number in live}
        clouds = {_cloud(live[number]) for number in thin.values()} - {None}
        if clouds:  # small parts as well, as pages wait for all of them
            thin |= {m.redundancy_key(): n for n, m in live.items() if _cloud(m) in clouds}
        for key, number in thin.items():
            if key not in self._line:
                self._line[key] = number
                self._whole.add(key)
        self._thin = {key: number for key, number in self._thin.items() if number in live}
        self._congestion.every = self._thinning.every if self._thin else 1

    def _piece(self, live: Mapping[int, Message]) -> list[Any]:
        """Return a piece of a message that was begun and whose node is not gone, each in turn."""
        while self._pieces:
            key, begun = next(iter(self._pieces.items()))
            del self._pieces[key]
            if begun.number not in live and (begun.is_whole or key not in self._line):
                continue
            piece = begun.pieces.take(min(self._congestion.piece(), WINDOW_BYTES))
            if not begun.pieces.is_over:
                self._pieces[key] = begun
            return [piece]
        return []


class _Begun(msgspec.Struct, frozen=True):
    """A message of which pieces are sent; `is_whole` if the browser has a thinned version."""

    number: int
    is_whole: bool
    pieces: Pieces


def _cloud(message: Message) -> tuple[Any, ...] | None:
    """Return the cloud and version that a message is part of, None if it is whole."""
    return getattr(message, "updates", {}).get(CLOUD)


def bulk(message: Message) -> int:
    """Approximate size in bytes of the properties that a message assigns."""
    updates: dict[str, Any] = getattr(message, "updates", {})
    return sum(
        value.nbytes if isinstance(value, np.ndarray) else len(value)
        for value in updates.values()
        if isinstance(value, np.ndarray | bytes)
    )
