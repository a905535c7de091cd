"""The connections of browsers: how many there may be, and how much each may send."""

from __future__ import annotations

import asyncio
import contextlib
import functools
import math
import select
from collections.abc import AsyncIterator, Callable, Iterator
from typing import Any, Protocol

import websockets.asyncio.server as websocket
from websockets.exceptions import ConnectionClosed
from websockets.frames import CloseCode, Frame, Opcode
from websockets.protocol import State

from webviz.api.roles import Role
from webviz.server.access.access import EVERYBODY, Grant
from webviz.server.access.roles import LIMITS
from webviz.server.channel.channel import CLOSE_TIMEOUT_S
from webviz.server.http.eviction import network_of, oldest_of_most_crowded
from webviz.server.http.listener import Handshakes
from webviz.server.http.rate_limits import BackOff, RateLimit, SpentRates
from webviz.server.http.requests import add_policy, as_get, is_complete, is_head, refusal
from webviz.server.http.viser_messages import objection
from webviz.server.sending.congestion import CongestionControl, InFlightWindow, SentMarker
from webviz.server.sending.frame_header import header

MAX_BROWSERS = 128

BURST_S = 2.0
"""Seconds of the allowed rate that may come at once."""
MAX_WAIT = 1.0
"""Seconds by which a connection may exceed the rate with frames that cannot wait, such as pings."""
FLOOD_S = 30.0
"""Seconds for which a connection may exceed the rate before it is ended; a page whose network was
stalled catches up sooner."""
FLOODED = "This page sent too many messages."
CLOSE_ONE = "Close another page of webviz."
READ_BYTES = 1 << 12
"""Read from a connection in one turn of the event loop: the smallest frames have 6 bytes, and each
costs some 10 µs, in which others wait, such as browsers that drive."""
WHOLE = (Opcode.BINARY, Opcode.TEXT)
"""Frames that carry a whole message if they are final."""
ANSWER_S = 0.05
"""Pause in seconds after which to look again whether a request is answered; most are at once."""


class ConnectingClient(Protocol):
    """A browser that connects."""

    address: str

    @property
    def grant(self) -> Grant:
        """Return what it may do."""
        ...


def sender_of(browser: ConnectingClient) -> tuple[str, str]:
    """Return by what the connections of one browser are known: its network and its cookie."""
    return network_of(browser.address), browser.grant.cookie


def _descriptors() -> int:
    """Return the number of files that this program may open; 512 on Windows."""
    try:
        import resource
    except ImportError:
        return 512
    return resource.getrlimit(resource.RLIMIT_NOFILE)[0]


class ConnectionLimits:
    """Limits the connections of a server: opening ones, those of browsers, and their channels.

    Args:
        handshakes: with TLS, those that are not complete.
    """

    def __init__(self, handshakes: Handshakes | None = None) -> None:
        self._handshakes = handshakes
        self.limit = max(4, min(MAX_BROWSERS, _descriptors() // 4))
        """Opening connections and browsers, each."""
        self._opening: dict[Connection, str] = {}
        """Connections that are being opened, with the network of each."""
        self._open: set[Connection] = set()
        self.spent = SpentRates()
        """Rates that lost connections have spent, by their network and cookie."""
        self.back_off = BackOff()
        """Pauses of browsers whose connections were ended for what they sent, likewise."""

    def absence(self, client: ConnectingClient) -> str:
        """Return why a browser has to stay away for a while: a sentence, "" if it may connect."""
        wait_s = self.back_off.wait_s(sender_of(client), asyncio.get_running_loop().time())
        return f"{FLOODED} Try again in {math.ceil(wait_s)} s." if wait_s > 0.0 else ""

    def refusal(self, client: ConnectingClient) -> str:
        """Return why one more browser may not connect: a sentence, "" if it may."""
        role = client.grant.role
        limits = LIMITS[role]
        browsers = [connection for connection in self._open if not connection.is_channel]
        limit = int(self.limit * limits.share)
        if sum(connection.grant.role <= role for connection in browsers) >= limit:
            reserved = "" if limit == self.limit else f" for {role.label}s"
            return f"{limit} browsers are connected, which is the limit{reserved}. {CLOSE_ONE}"
        if len(browsers) >= self.limit:
            return f"{self.limit} browsers are connected, which is the limit. {CLOSE_ONE}"
        network = network_of(client.address)
        near = sum(network_of(connection.address) == network for connection in browsers)
        if near >= limits.per_address:
            return f"{near} browsers of your address are connected, which is the limit. {CLOSE_ONE}"
        return ""

    def enter(self, connection: Connection) -> None:
        """Add an opening connection; of too many, one of the most crowded network is aborted."""
        if self._handshakes is not None:
            self._handshakes.end(connection.transport.get_extra_info("socket").fileno())
        self._opening[connection] = network_of((connection.remote_address or ("",))[0])
        if len(self._opening) > self.limit:
            crowding = oldest_of_most_crowded(self._opening)
            del self._opening[crowding]
            crowding.transport.abort()

    def leave(self, connection: Connection) -> None:
        """Remove a connection that is open or lost."""
        self._opening.pop(connection, None)

    @contextlib.contextmanager
    def opened(self, connection: Connection) -> Iterator[None]:
        """Count a connection as open during the block."""
        self.leave(connection)
        self._open.add(connection)
        try:
            yield
        finally:
            self._open.discard(connection)

    def disconnect(self, is_over: Callable[[Connection], bool]) -> None:
        """End open connections at once, and ignore what they have sent."""
        for connection in filter(is_over, tuple(self._open)):
            connection.is_disconnecting = True
            connection.transport.abort()

    def close(self) -> None:
        """Close all connections, within a second also those that do not respond."""
        if self._handshakes is not None:
            self._handshakes.close()
        for connection in (*self._opening, *self._open):
            patience = 0.0 if connection in self._opening else CLOSE_TIMEOUT_S
            connection.loop.call_later(patience, connection.transport.abort)


class Connection(websocket.ServerConnection, asyncio.BufferedProtocol):
    """A connection that checks its request before websockets, and its messages before viser.

    Args:
        connections: limits of the server's connections.
        rate: bytes a second that links to browsers are known to take; None to measure it.
    """

    def __init__(
        self, connections: ConnectionLimits, rate: float | None, *arguments: Any, **options: Any
    ) -> None:
        super().__init__(*arguments, **options)
        self.window = InFlightWindow(CongestionControl(rate))
        """Bytes sent that may not have arrived."""
        self._asking: asyncio.Task[None] | None = None
        # websockets fails, and logs it, if a browser is gone before it is answered.
        send_eof = self.protocol.send_eof
        self.protocol.send_eof = lambda: None if self.protocol.eof_sent else send_eof()
        self.wants_head = False
        """True if the request is for the headers only."""
        self.host = ""
        """Name by which the browser addresses this server, if it is allowed."""
        self.address = ""
        """IP address of the browser, as far as it is known."""
        self.is_secure = False
        """True if the browser uses https."""
        self.is_channel = False
        """True if this is the channel of a page, instead of viser's own connection."""
        self._connections = connections
        self.objection: Callable[[str | bytes, Role], str | None] = objection
        """The reason to ignore a message, or None."""
        self.is_disconnecting = False
        """True if nothing that it sends counts any more."""
        self.grant = EVERYBODY
        self._head: bytearray | None = bytearray()
        self._read = memoryview(bytearray(READ_BYTES))
        self._is_refused = False

    @property
    def grant(self) -> Grant:
        """Return its grant."""
        return self._grant

    @grant.setter
    def grant(self, grant: Grant) -> None:
        self._grant = grant
        limits = LIMITS[grant.role]
        rate = limits.messages_per_second
        self._rate_limit = RateLimit(rate, BURST_S * rate)
        self._bytes_per_message = limits.bytes_per_message

    def admit(self, address: str, grant: Grant) -> None:
        """Identify the browser of a connection and restore its rate budget.

        Args:
            address: IP address of the browser.
            grant: what it may do.
        """
        self.address, self.grant = address, grant
        self._connections.spent.resume(sender_of(self), self._rate_limit, self.loop.time())

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Add the connection to those of the server."""
        super().connection_made(transport)
        self._connections.enter(self)

    def connection_lost(self, exc: Exception | None) -> None:
        """Remove the connection from those of the server."""
        self._connections.leave(self)
        self._connections.spent.note(sender_of(self), self._rate_limit)
        self.window.drop()
        super().connection_lost(exc)

    def get_buffer(self, sizehint: int) -> memoryview:
        """Return where the event loop puts what it reads in one turn."""
        return self._read

    def buffer_updated(self, nbytes: int) -> None:
        """Handle what was read."""
        self.data_received(bytes(self._read[:nbytes]))

    def data_received(self, data: bytes) -> None:
        """Collect and check the request; websockets handles the rest."""
        if self._is_refused:
            return  # keep reading, or closing the connection would discard the response
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
            if self.transport.can_write_eof():
                self.transport.write_eof()
            else:  # with TLS: closing at once would discard the response
                self.loop.call_later(CLOSE_TIMEOUT_S, self.transport.close)
            return
        self.wants_head = is_head(head)
        super().data_received(as_get(head))

    def eof_received(self) -> Any:  # True keeps the connection open
        """Handle the end of a request after its answer, in between which websockets fails."""
        is_asking = self._head is None and not self._is_refused and self.state is State.CONNECTING
        if not is_asking or self.is_secure:  # with TLS, there is no way to wait
            return super().eof_received()
        self.loop.call_later(ANSWER_S, self._end)
        return True

    def _end(self) -> None:
        if not self.transport.is_closing() and not self.eof_received():
            self.transport.close()

    def process_event(self, event: Any) -> None:
        """Handle the request, or a frame on arrival."""
        # Whole messages wait in `recv`; other frames take effect, or memory, at once.
        is_whole = isinstance(event, Frame) and event.opcode in WHOLE and event.fin
        is_request = not isinstance(event, Frame)
        is_pong = isinstance(event, Frame) and event.opcode is Opcode.PONG
        is_answer = is_pong and bytes(event.data) in self.pending_pings
        is_instant = not (is_whole or is_request or is_answer)
        if is_instant and self._rate_limit.spend(1.0, self.loop.time()) > MAX_WAIT:
            self._disconnect_for_flood()
            self.transport.abort()
        super().process_event(event)

    async def send(self, message: Any, text: bool | None = None) -> None:
        """Send a message, or fragments of one as they come, and measure when it arrives."""
        if isinstance(message, str | bytes):
            self.window.send(len(message))
        await super().send(message, text=text)
        await self._ping()

    def write(self, frame: bytes) -> None:
        """Send a whole frame without waiting, unless the connection is being closed."""
        if self.state is not State.OPEN:
            return
        self.transport.write(frame)
        self.window.send(len(frame))
        if self.window.is_due and self._asking is None:
            self._asking = self.loop.create_task(self._ask())

    async def _ask(self) -> None:
        with contextlib.suppress(ConnectionClosed):
            await self._ping()
        self._asking = None

    async def send_in_time(self, message: bytes) -> None:
        """Send a message in fragments, each when there is room for it on the link."""
        piece = self.window.congestion.piece()
        if len(message) <= piece and self.window.congestion.room() > 0:
            # A third of what `send` takes, which copies the message twice.
            self.write(b"".join((header(len(message)), message)))
            with contextlib.suppress(OSError):  # it is gone
                await self.drain()
        else:
            await self.send(self._fragments(message, piece))

    async def _fragments(self, message: bytes, size: int) -> AsyncIterator[bytes]:
        for start in range(0, len(message), size):
            while self.window.congestion.room() < 1:
                await self.window.congestion.wait()
            fragment = message[start : start + size]
            self.window.send(len(fragment))
            yield fragment
            await self._ping()

    async def _ping(self) -> None:
        """Asks the browser to say when it has got here, if that is worth asking."""
        if (marker := self.window.end()) is None:
            return
        acknowledged = functools.partial(self._acknowledged, self.window.congestion, marker)
        try:
            pong = await self.ping()
        except ConnectionClosed:
            self.window.congestion.lose(marker)
            raise
        asyncio.ensure_future(pong).add_done_callback(acknowledged)

    @staticmethod
    def _acknowledged(
        congestion: CongestionControl, marker: SentMarker, pong: asyncio.Future[float]
    ) -> None:
        if pong.cancelled() or pong.exception() is not None:
            congestion.lose(marker)
        else:
            congestion.acknowledge(marker)

    async def recv(self, decode: bool | None = None) -> Any:
        """Return the next valid message, at the allowed rate."""
        while True:
            data = await super().recv(decode)
            cost = 1.0 + len(data) / self._bytes_per_message
            wait = 0.0 if self.is_disconnecting else self._rate_limit.spend(cost, self.loop.time())
            if wait > 0.0:
                # A server that stops does not wait for this, either.
                await asyncio.wait([self.connection_lost_waiter], timeout=wait)
                await self._end_flood()
            else:
                await asyncio.sleep(0.0)  # received messages must not keep other tasks waiting
            if self.is_disconnecting:
                continue
            objection = self.objection(data, self.grant.role)
            if objection is None:
                return data
            self.logger.warning("Ignored a message of a browser: %s.", objection)

    async def _end_flood(self) -> None:
        """End the connection if it sends too much for long, or has closed its end."""
        if self._is_gone:
            self.is_disconnecting = True
            self.transport.abort()
        elif self._rate_limit.exhausted_s(self.loop.time()) > FLOOD_S:
            self._disconnect_for_flood()
            self.logger.warning("Ended a connection that sent too many messages.")
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(
                    self.close(CloseCode.POLICY_VIOLATION, FLOODED), CLOSE_TIMEOUT_S
                )
            self.transport.abort()

    def _disconnect_for_flood(self) -> None:
        self.is_disconnecting = True
        if self.grant.role < Role.OWNER:  # whose robot it is; a page of theirs may go wrong
            self._connections.back_off.send_away(sender_of(self), self.loop.time())

    @property
    def _is_gone(self) -> bool:
        """Return whether the browser has closed its end, also if some of what it sent is unread."""
        if self.transport.is_closing():
            return True
        end = select.poll()
        end.register(self.transport.get_extra_info("socket").fileno(), select.POLLRDHUP)
        return bool(end.poll(0))
