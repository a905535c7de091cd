"""A second connection to a bridge, for large messages, read at a limited rate."""

from __future__ import annotations

import asyncio
import contextlib
import socket
import time
from collections.abc import Callable, Mapping
from contextlib import AbstractAsyncContextManager
from typing import Protocol

from websockets.exceptions import WebSocketException

from webviz.sources.bridge.connection import BridgeConnection
from webviz.sources.bridge.pacing import MAX_RATE, RateController
from webviz.sources.bridge.session import BridgeSession, Host
from webviz.sources.bridge.talking import first_of, read, write
from webviz.sources.source import Subscription

TICK_S = 0.05
"""Pause in seconds between two decisions."""
BURST_S = 0.1
"""Time in seconds whose bytes may be read at once after a rest."""
QUEUE_S = 0.05
"""Delay in seconds by which what is on its way may delay small messages."""
MIN_BUFFER, MAX_BUFFER = 4 << 10, 4 << 20
SEGMENTS = 4
"""Number of TCP segments that the receive buffer holds at least: with less, TCP sends a part at
each of its timeouts, five a second. Those of loopback have 65 kB."""
RETRY_S = 2.0


class BulkConnection(BridgeConnection):
    """A connection that is read at a limited rate, and has little on its way.

    What may be on its way is bounded by the receive buffer, whose room TCP announces to the bridge.
    """

    rate_controller = RateController()
    """Pacer that decides on the rate."""
    _allowed = 0.0
    _allowed_s = 0.0
    _buffer = 0

    def limit(self) -> None:
        """Bound what is on its way to what the link takes in a round trip, and a little more."""
        sock = self.transport.get_extra_info("socket")
        if sock is None:
            return
        with contextlib.suppress(OSError):  # it is being closed
            least = max(MIN_BUFFER, SEGMENTS * _segment(sock))
            size = self.rate_controller.rate * (self.rate_controller.trip_s + QUEUE_S)
            size = round(min(max(size, least), MAX_BUFFER))
            if size != self._buffer:
                self._buffer = size
                sock.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, size)

    def data_received(self, data: bytes) -> None:
        """Count the bytes, and pause if they exceed the rate."""
        now_s = time.monotonic()
        self.rate_controller.note_bytes(len(data), now_s)
        super().data_received(data)
        rate = self.rate_controller.rate
        if rate >= MAX_RATE:
            return
        rested = (now_s - self._allowed_s) * rate
        self._allowed = min(self._allowed + rested, rate * BURST_S) - len(data)
        self._allowed_s = now_s
        if self._allowed < 0:
            self.transport.pause_reading()
            self.loop.call_later(-self._allowed / rate, self._go_on)

    def _go_on(self) -> None:
        if not self.transport.is_closing():
            self.transport.resume_reading()


def _segment(sock: socket.socket) -> int:
    """Return the size of the segments of a connection in bytes, 0 where systems do not tell it."""
    option = getattr(socket, "TCP_MAXSEG", None)
    return 0 if option is None else sock.getsockopt(socket.IPPROTO_TCP, option)


class BulkHost(Protocol):
    """The part of the source that uses a second connection."""

    def open_bulk(self) -> AbstractAsyncContextManager[BulkConnection]:
        """Open the connection."""
        ...

    def arrive_large(self, topic: str, cdr: bytes, stamp_ns: int) -> None:
        """Take a message; see `Host.arrive`."""
        ...

    def learn(self, topic: str, type: str, definition: str) -> str:
        """See `Host.learn`."""
        ...

    def sort_topics(self) -> None:
        """Subscribe anew, as other topics have large messages, or the connection is lost."""
        ...


class BulkTopics:
    """The large topics of a bridge, over a connection of their own; the host of its session.

    Args:
        rate_controller: decides when each is subscribed to, and how fast the connection is read.
        source: takes the messages.
        begin: makes the session.
    """

    def __init__(
        self,
        rate_controller: RateController,
        source: BulkHost,
        begin: Callable[[Host], BridgeSession],
    ) -> None:
        self._rate_controller = rate_controller
        self._source = source
        self._begin = begin
        self._subscriptions: Mapping[str, Subscription] = {}
        self._outbox: asyncio.Queue[str | bytes] = asyncio.Queue()
        self._session: BridgeSession | None = None
        self.is_refused = False
        """True if the bridge takes no second connection, so that the first has all topics."""

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the large topics exactly these."""
        self._subscriptions = subscriptions
        self.subscribe()

    async def run(self) -> None:
        """Have a connection while there are large topics."""
        while True:
            if self._subscriptions or self.is_refused:
                await self._talk()
                await asyncio.sleep(RETRY_S)
            else:
                await asyncio.sleep(TICK_S)

    async def _talk(self) -> None:
        try:
            async with self._source.open_bulk() as socket:
                socket.rate_controller = self._rate_controller
                self._outbox = asyncio.Queue()
                self._session = session = self._begin(self)
                self._refuse(False)
                session.start()
                self.subscribe()
                try:
                    await first_of(
                        read(socket, session, lambda problem: None),
                        write(socket, self._outbox),
                        self._pace(socket),
                    )
                finally:
                    socket.transport.abort()  # what is on its way would come before the farewell
        except (OSError, WebSocketException):  # the first connection says what is wrong
            self._refuse(True)
        finally:
            self._session = None

    def _refuse(self, is_refused: bool) -> None:
        if is_refused != self.is_refused:
            self.is_refused = is_refused
            self._source.sort_topics()

    async def _pace(self, socket: BulkConnection) -> None:
        while True:
            socket.limit()
            self._step()
            await asyncio.sleep(TICK_S)

    def _step(self) -> None:
        if self._rate_controller.step(time.monotonic()):
            self._source.sort_topics()

    def subscribe(self) -> None:
        """Subscribe to what is offered now, of which some topics rest."""
        if self._session is not None:
            self._session.want(
                self._subscriptions, self._subscriptions.keys() - self._rate_controller.subscribed()
            )

    # The interface of webviz.sources.bridge.session.Host

    def send(self, frame: str | bytes) -> None:
        """Send a frame soon."""
        self._outbox.put_nowait(frame)

    def arrive(self, topic: str, cdr: bytes, stamp_ns: int) -> None:
        """Take a message, after which another topic may have its turn."""
        self._source.arrive_large(topic, cdr, stamp_ns)
        self._step()

    def set_time(self, stamp_ns: int) -> None:
        """Do nothing: the first connection has it."""

    def learn(self, topic: str, type: str, definition: str) -> str:
        """See `Host.learn`."""
        return self._source.learn(topic, type, definition)

    def learn_service(self, type: str, request: str, response: str) -> None:
        """Do nothing: the first connection calls services."""

    def look(self) -> None:
        """Do nothing: the first connection has the same."""
