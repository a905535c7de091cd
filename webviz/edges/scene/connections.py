"""One connection of a browser, how much it may send, and how many there may be."""

from __future__ import annotations

import asyncio
import contextlib
import resource
from collections.abc import Iterator
from typing import Any

import websockets.asyncio.server as websocket
from websockets.frames import Frame, Opcode

from webviz.edges.scene.http_requests import add_policy, as_get, is_complete, is_head, refusal
from webviz.edges.scene.messages import Accepts, Judge

MAX_BROWSERS = 64

MESSAGES_PER_SECOND = 200.0
"""What a page sends while somebody drags something is a quarter of it."""
BURST = 400.0
BYTES_PER_MESSAGE = 32 << 10
"""For as many bytes more, a message counts once more."""
MAX_WAIT = 5.0
"""Seconds that a connection may owe for what cannot be kept waiting, such as pings."""


WHOLE = (Opcode.BINARY, Opcode.TEXT)
"""What carries a message, if it is all of it."""

FAREWELL = 1.0
"""Seconds for a browser to close its connection when the server stops."""


class Gate:
    """The connections of a server: those that open, the browsers inside, and their channels."""

    def __init__(self) -> None:
        descriptors, _ = resource.getrlimit(resource.RLIMIT_NOFILE)
        self.limit = max(4, min(MAX_BROWSERS, descriptors // 4))
        """Of either kind."""
        self._opening: dict[Connection, None] = {}
        self._inside: set[Connection] = set()
        self._beside: set[Connection] = set()

    @property
    def is_full(self) -> bool:
        """Whether there is no room for another browser."""
        return len(self._inside) >= self.limit

    def enter(self, connection: Connection) -> None:
        """Notes a connection that opens; the oldest of too many goes, since it may be idle."""
        self._opening[connection] = None
        if len(self._opening) > self.limit:
            oldest = next(iter(self._opening))
            del self._opening[oldest]
            oldest.transport.abort()

    def leave(self, connection: Connection) -> None:
        """Forgets a connection that opened or is gone."""
        self._opening.pop(connection, None)

    @contextlib.contextmanager
    def inside(self, connection: Connection) -> Iterator[None]:
        """Notes the browser of a connection while it is inside."""
        self.leave(connection)
        self._inside.add(connection)
        try:
            yield
        finally:
            self._inside.discard(connection)

    @contextlib.contextmanager
    def beside(self, connection: Connection) -> Iterator[None]:
        """Notes the channel of a browser that is inside."""
        self.leave(connection)
        self._beside.add(connection)
        try:
            yield
        finally:
            self._beside.discard(connection)

    def close(self) -> None:
        """Sends everybody away, within a second also those who do not listen."""
        for connection in (*self._opening, *self._inside, *self._beside):
            patience = 0.0 if connection in self._opening else FAREWELL
            connection.loop.call_later(patience, connection.transport.abort)


class Allowance:
    """A steady rate with bursts: what is spent beyond it has to be waited for.

    Args:
        rate: messages per second.
        burst: messages that may come at once.
    """

    def __init__(self, rate: float = MESSAGES_PER_SECOND, burst: float = BURST) -> None:
        self._rate = rate
        self._credit = burst / rate
        self._paid_until = -float("inf")

    def spend(self, messages: float, now: float) -> float:
        """Spends as many messages at a time in seconds, and returns the seconds to wait."""
        self._paid_until = max(self._paid_until, now - self._credit) + messages / self._rate
        return max(0.0, self._paid_until - now)


class Connection(websocket.ServerConnection):
    """A connection whose request is judged before websockets reads it, its messages before viser.

    Args:
        gate: of the server.
        accepts: as for `Judge`.
    """

    def __init__(self, gate: Gate, accepts: Accepts, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        self.wants_head = False
        """Whether the request wants the headers only."""
        self.host = ""
        """As the browser addressed the server, if that is a name of it."""
        self.is_channel = False
        """Whether it is the channel of a page, instead of viser's own connection."""
        self._gate = gate
        self.objection = Judge(accepts).objection
        """What is wrong with a message, or None if it may pass."""
        self._allowance = Allowance()
        self._head: bytearray | None = bytearray()
        self._is_refused = False

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Enters."""
        super().connection_made(transport)
        self._gate.enter(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """Leaves."""
        self._gate.leave(self)
        super().connection_lost(exc)

    def data_received(self, data: bytes) -> None:
        """Collects the request; what comes after it is websockets' own."""
        if self._is_refused:
            return  # read all the same, else the answer is lost with the connection
        if self._head is None:
            super().data_received(data)
            return
        self._head += data
        if not is_complete(bytes(self._head)):
            return
        head, self._head = bytes(self._head), None
        if (refused := refusal(head)) is not None:
            self._is_refused = True
            response = self.respond(refused[0], refused[1] + "\n")
            add_policy(response.headers, "")
            self.wants_head = is_head(head)
            if self.wants_head:
                response.body = b""
            if refused[0] == 405:
                response.headers["Allow"] = "GET, HEAD"
            self.transport.write(response.serialize())
            self.transport.write_eof()
            return
        self.wants_head = is_head(head)
        super().data_received(as_get(head))

    def process_event(self, event: Any) -> None:
        """Handles the request, or a frame as it comes."""
        # Whole messages wait in `recv`; others take effect, or memory, at once.
        is_whole = isinstance(event, Frame) and event.opcode in WHOLE and event.fin
        is_request = not isinstance(event, Frame)
        is_instant = not (is_whole or is_request)
        if is_instant and self._allowance.spend(1.0, self.loop.time()) > MAX_WAIT:
            self.transport.abort()
        super().process_event(event)

    async def recv(self, decode: bool | None = None) -> Any:
        """The next message that may pass, at the rate that is allowed."""
        while True:
            data = await super().recv(decode)
            cost = 1.0 + len(data) / BYTES_PER_MESSAGE
            # At least the others' turn: received messages are there without waiting.
            await asyncio.sleep(self._allowance.spend(cost, self.loop.time()))
            objection = self.objection(data)
            if objection is None:
                return data
            self.logger.warning("A message of a browser was ignored: %s.", objection)
