"""The channel between the server and the pages of webviz, beside viser's own connection."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import secrets
import threading
import time
from collections.abc import Awaitable, Callable, Iterable, Mapping
from functools import partial, reduce
from operator import or_
from typing import Annotated, Any, Protocol, TypeVar

import msgspec
from websockets.exceptions import ConnectionClosed

from webviz.api.roles import Role
from webviz.server.access import rules
from webviz.server.access.access import Grant
from webviz.server.access.roles import LIMITS, Limits
from webviz.server.access.visitors import Visitor
from webviz.server.channel.messages import (
    CommandRequest,
    CommandResult,
    FromPage,
    Hello,
    Identity,
    Number,
    Ping,
    Pong,
    ToPage,
    Unwatch,
    Watch,
)
from webviz.server.channel.outgoing import PageQueue
from webviz.server.channel.refusals import answer, answer_to_halves
from webviz.server.channel.stores import Stores
from webviz.server.sending.congestion import CongestionControl, InFlightWindow

MAX_QUOTED = 200
"""Characters of a message that the log quotes."""
CLOSE_TIMEOUT_S = 1.0
"""Time in seconds for a browser to close its connection, after which it is cut."""
HELLO_S = 10.0
"""Time in seconds for a page to say who it is."""

M = TypeVar("M", bound=FromPage)
_OWN: Any = Hello | Watch | Unwatch


class Websocket(Protocol):
    """Protocol of a websocket."""

    logger: Any
    transport: Any
    is_disconnecting: bool
    """True if nothing that it sends counts any more."""
    window: InFlightWindow
    """Bytes sent that may not have arrived."""
    latency: float
    """Delay of the last ping in seconds, 0 before the first."""

    @property
    def grant(self) -> Grant:
        """Return its grant."""
        ...

    @property
    def address(self) -> str:
        """The network address of the browser."""
        ...

    async def recv(self) -> Any:
        """Return the next message."""
        ...

    async def send(self, message: str | bytes, /) -> None:
        """Send a message, and wait while the page does not read."""
        ...

    async def send_in_time(self, message: bytes, /) -> None:
        """Send a message when there is room for it on the link."""
        ...

    async def close(self, code: int = 1000, reason: str = "") -> None:
        """End the connection."""
        ...


class Channel:
    """Sends messages to pages, and receives theirs.

    Each page that joins viser's server is given a key by viser's connection, and names it when it
    opens the channel: hence the channel knows which of viser's clients it talks to. Both
    connections live and end together, so that nothing is lost between two of them: what is sent
    before a page has opened its channel waits for it.
    """

    def __init__(self) -> None:
        self.on_lost: Callable[[int], None] = lambda browser: None
        """Called on the event loop with a browser whose channel has ended."""
        self.end_scene: Callable[[int], Awaitable[None]] = _nothing
        """Ends viser's connection of a browser."""
        self._lock = threading.Lock()
        self._loop: asyncio.AbstractEventLoop | None = None
        self._thread: int | None = None
        self._outboxes: dict[int, PageQueue] = {}
        self._visitors: dict[int, tuple[Visitor, Websocket]] = {}
        self._last_messages: dict[type[ToPage], ToPage] = {}
        self._stores = Stores()
        self.may_watch: Callable[[int, str], bool] = lambda browser, store: True
        """Called on the event loop: whether a browser may watch a store."""
        self.on_watch: Callable[[int], object] = lambda browser: None
        """Called on the event loop with a browser that watches another store."""
        self._listeners: dict[type[FromPage], list[Callable[[int, Any], object]]] = {}
        self._decoder = msgspec.json.Decoder[FromPage](_OWN)
        # Pages that join before the viewer is ready, or without panels, measure their way, too.
        self.on(Ping, lambda browser, _: self.send(Pong(), browser))

    def send(self, message: ToPage, browser: int | None = None) -> None:
        """Send to one page, or to all; from any thread, without waiting.

        Without `browser`, pages that join later receive the newest of each kind that is `kept`.
        """
        with self._lock:
            if browser is None and message.is_latched:
                self._last_messages[type(message)] = message
            data = msgspec.json.encode(message)
            filled = [each for id_, each in self._outboxes.items() if browser in (None, id_)]
            for outbox in filled:
                outbox.put(message, data)
        self._wake_soon(filled)

    def send_bytes(self, data: bytes, key: str, browser: int) -> None:
        """Send bytes to one page after its messages; they replace those of the same key that wait.

        From any thread, without waiting. The sender limits the number of keys.
        """
        with self._lock:
            if (outbox := self._outboxes.get(browser)) is None:
                return
            outbox.bulk[key] = data
        self._wake_soon([outbox])

    def call_soon(self, call: Callable[[], object]) -> None:
        """Call something on the event loop, once a page has joined; from any thread."""
        if (loop := self._loop) is not None:
            with contextlib.suppress(RuntimeError):  # the server has stopped
                loop.call_soon_threadsafe(call)

    def congestion(self, browser: int) -> CongestionControl | None:
        """Return the congestion control of a browser; None if it is gone. From any thread."""
        with self._lock:
            outbox = self._outboxes.get(browser)
        return None if outbox is None else outbox.congestion

    def browsers(self) -> set[int]:
        """Return the ids of all pages."""
        with self._lock:
            return set(self._outboxes)

    def show(self, store: str, values: Mapping[str, Any]) -> None:
        """Make these the values of a store, and send pages that watch it what is new.

        Args:
            store: its name, one of `watched`.
            values: what JSON can hold.
        """
        with self._lock:
            changed = self._stores.replace(store, values)
            filled = [each for each in self._outboxes.values() if each.watched.mark(store, changed)]
        self._wake_soon(filled)

    def watched(self) -> set[str]:
        """Return the names of all stores that pages watch; the values of others are forgotten."""
        with self._lock:
            watched = {store for outbox in self._outboxes.values() for store in outbox.watched}
            self._stores.forget(watched)
        return watched

    def visitors(self) -> dict[int, Visitor]:
        """Return who is connected, by viser's id of the browser; from any thread."""
        with self._lock:
            entries = list(self._visitors.items())
        return {
            browser: msgspec.structs.replace(visitor, latency_s=connection.latency or None)
            for browser, (visitor, connection) in entries
        }

    def grant_of(self, browser: int) -> Grant | None:
        """Return the grant of a browser, None if it is gone; from any thread."""
        with self._lock:
            entry = self._visitors.get(browser)
        return None if entry is None else entry[1].grant

    async def disconnect(self, browser: int) -> None:
        """End the visit of a browser; what it has sent counts no more. On the event loop."""
        with self._lock:
            entry = self._visitors.get(browser)
        if entry is not None:
            entry[1].is_disconnecting = True
            await self.end_scene(browser)
            with contextlib.suppress(TimeoutError):
                await asyncio.wait_for(entry[1].close(), CLOSE_TIMEOUT_S)
            entry[1].transport.abort()

    def on(self, kind: type[M], listener: Callable[[int, M], object]) -> None:
        """Call `listener` with a browser, by viser's id of it, and each message of a kind.

        It runs on the event loop of the server, so it must do no more than note what it heard.
        """
        with self._lock:
            self._listeners.setdefault(kind, []).append(listener)
            message_types = reduce(or_, self._listeners, _OWN)
            self._decoder = msgspec.json.Decoder[FromPage](message_types)

    # Called on the event loop

    def join(self, browser: int, congestion: CongestionControl) -> str:
        """Expect the page of a browser, and return the key that it has to name.

        Args:
            browser: viser's id of it.
            congestion: control of its link.
        """
        key = secrets.token_urlsafe(32)
        with self._lock:
            self._loop, self._thread = asyncio.get_running_loop(), threading.get_ident()
            outbox = self._outboxes[browser] = PageQueue(key, congestion)
            for message in self._last_messages.values():
                outbox.put(message, msgspec.json.encode(message))
        return key

    def leave(self, browser: int) -> None:
        """Forgets a browser that is gone, and ends what is left of its channel."""
        with self._lock:
            outbox = self._outboxes.pop(browser, None)
            self._visitors.pop(browser, None)
        if outbox is not None:
            outbox.abort()

    async def serve(
        self, connection: Websocket, inside: Callable[[], contextlib.AbstractContextManager[None]]
    ) -> None:
        """Talks to a page until one of both ends.

        Args:
            connection: of the page.
            inside: entered once the page has named its key.
        """
        try:
            browser, outbox = await asyncio.wait_for(self._introduce(connection), HELLO_S)
        except (ConnectionClosed, TimeoutError, msgspec.MsgspecError, KeyError):
            await connection.close(1008, "Not a webviz page")
            return
        outbox.abort = connection.transport.abort
        connection.window.join(outbox.congestion)
        grant = connection.grant
        visitor = Visitor(grant.name, grant.role, connection.address, time.time())
        with self._lock:
            self._visitors[browser] = visitor, connection
            outbox.put_first(Identity(grant.role.label, grant.name))
        writer = asyncio.create_task(self._write(connection, outbox))
        self._wake([outbox])
        try:
            with inside(), contextlib.suppress(ConnectionClosed):
                while True:
                    self._hear(browser, await connection.recv(), connection)
        finally:
            writer.cancel()
            with self._lock:
                self._visitors.pop(browser, None)
            self.on_lost(browser)

    async def _introduce(self, connection: Websocket) -> tuple[int, PageQueue]:
        hello = msgspec.json.decode(await connection.recv(), type=Hello)
        with self._lock:
            keys = {outbox.key: browser for browser, outbox in self._outboxes.items()}
            browser = keys[hello.key]
            outbox = self._outboxes[browser]
            outbox.key = None  # it serves once
        return browser, outbox

    async def _write(self, connection: Websocket, outbox: PageQueue) -> None:
        with contextlib.suppress(ConnectionClosed):
            while True:
                outbox.filled.clear()
                while (message := self._next(outbox)) is not None:
                    if isinstance(message, bytes):
                        await connection.send_in_time(message)
                    else:
                        await connection.send(message)
                await outbox.filled.wait()

    def _next(self, outbox: PageQueue) -> str | bytes | None:
        with self._lock:
            if (values := outbox.watched.next(self._stores)) is not None:
                return msgspec.json.encode(values).decode()
            if outbox.waiting:
                return outbox.waiting.pop(next(iter(outbox.waiting))).decode()
            return outbox.bulk.pop(next(iter(outbox.bulk))) if outbox.bulk else None

    def _hear(self, browser: int, text: str, connection: Websocket) -> None:
        log = connection.logger
        if excess := _excess(text, LIMITS[connection.grant.role]):
            log.warning("A message of a page was ignored: %s.", excess)
            self._refuse_excess(browser, text, excess)
            return
        try:
            message = self._decoder.decode(text)
        except (msgspec.MsgspecError, RecursionError) as error:
            # It may quote what the page sent, control characters included.
            log.warning("A message of a page was ignored: %s.", ascii(str(error))[1:MAX_QUOTED])
            if (refused := answer_to_halves(self._decoder, text)) is not None:
                self.send(refused, browser)
            return
        if refusal := self._refusal(connection.grant.role, message):
            log.warning("Refused a message of %s.", connection.grant.role.phrase)
            if (refused := answer(message, refusal)) is not None:
                self.send(refused, browser)
            return
        if isinstance(message, Watch | Unwatch):
            self._watch(browser, message, log)
        for listener in self._listeners.get(type(message), ()):
            listener(browser, message)

    def _refuse_excess(self, browser: int, text: str, excess: str) -> None:
        """Answer a command that is too long, without reading all of it."""
        with contextlib.suppress(msgspec.MsgspecError, RecursionError):
            long = msgspec.json.decode(text, type=_Long)
            reason = f"Failed: {excess}."
            self.send(CommandResult(long.number, long.command, "error", reason, {}), browser)

    @staticmethod
    def _refusal(role: Role, message: FromPage) -> str:
        return rules.refusal(
            role,
            type(message).__name__,
            command=message.command if isinstance(message, CommandRequest) else "",
            store=message.store if isinstance(message, Watch) else "",
        )

    def _watch(self, browser: int, message: Watch | Unwatch, log: logging.Logger) -> None:
        with self._lock:
            if (outbox := self._outboxes.get(browser)) is None:
                return
            if isinstance(message, Unwatch):
                outbox.watched.discard(message.store)
                return
            is_allowed = self.may_watch(browser, message.store)
            is_allowed = is_allowed and outbox.watched.add(message.store)
        if is_allowed:
            self.on_watch(browser)
            self._wake([outbox])
        else:
            log.warning("A page asked to watch a store that it may not, or too many.")

    def _wake_soon(self, outboxes: list[PageQueue]) -> None:
        """Have these sent; from any thread, each of which costs a wake-up of the event loop."""
        if threading.get_ident() == self._thread:
            self._wake(outboxes)
        elif outboxes:
            self.call_soon(partial(self._wake, outboxes))

    @staticmethod
    def _wake(outboxes: Iterable[PageQueue]) -> None:
        for outbox in outboxes:
            if outbox.is_full:
                outbox.abort()
            else:
                outbox.filled.set()


async def _nothing(browser: int) -> None:
    pass


class _Long(msgspec.Struct, tag="CommandRequest"):
    """Readable part of a command that is too long."""

    number: Number
    command: Annotated[str, msgspec.Meta(max_length=100)]


def _excess(text: str, limits: Limits) -> str:
    """Return a clause on what a message has too much of, "" if it is within the limits."""
    if len(text) > (limit := limits.max_characters):
        return f"{len(text)} characters in one message; the limit is {limit}"
    if (values := sum(map(text.count, ",[{"))) > (limit := limits.max_values):
        return f"{values} values in one message; the limit is {limit}"
    return ""


def objection(data: str | bytes, role: Role) -> str | None:
    """Return the objection to a message before it is read, or None."""
    return None if isinstance(data, str) else "bytes instead of text"
