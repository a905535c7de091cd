"""The sender of shared messages to all browsers, in place of viser's own loops."""

from __future__ import annotations

import asyncio
import struct
import threading
import time
from collections.abc import AsyncGenerator, Callable, Mapping, Sequence

import msgspec
import websockets.asyncio.server as websocket
import zstandard
from viser.infra._async_message_buffer import AsyncMessageBuffer
from viser.infra._messages import Message

from webviz.scene.names import ROOT, display_of
from webviz.server.http.connections import Connection
from webviz.server.sending.congestion import CongestionControl
from webviz.server.sending.costs import Costs
from webviz.server.sending.frame_header import header
from webviz.server.sending.outbox import URGENT, Outbox, Progress, bulk
from webviz.server.sending.pieces import Piece

ALIGNMENT = 8
"""Bytes; typed arrays of JavaScript begin at multiples of their items' size."""
_packer = msgspec.msgpack.Encoder()


class Packer:
    """Packs messages; one thread may use it at a time."""

    def __init__(self) -> None:
        self._zstd = zstandard.ZstdCompressor(level=1)

    def frame(self, messages: Sequence[Message | Piece]) -> bytes:
        """Return a websocket frame without mask, which is the same for all browsers.

        It contains the size of the msgpack before and after compression, the msgpack, and the
        arrays, each at a multiple of `ALIGNMENT`.
        """
        arrays: list[memoryview] = []
        packed = _packer.encode(
            {
                "messages": [message.as_serializable_dict(arrays) for message in messages],
                "timestampSec": time.perf_counter(),
                "binaryBufferLengths": [array.nbytes for array in arrays],
            }
        )
        compressed = self._zstd.compress(packed)
        sizes = struct.pack("<QQ", len(packed), len(compressed))
        parts: list[bytes | memoryview] = [b"", sizes, compressed]
        size = len(sizes) + len(compressed)
        for array in arrays:
            padding = -size % ALIGNMENT
            parts += [bytes(padding), array]
            size += padding + array.nbytes
        parts[0] = header(size)
        return b"".join(parts)


class SceneSender:
    """Sends each browser what it lacks, packed once for all that lack the same.

    viser has a task for each browser, which packs every message anew, and which walks all message
    numbers from 0 when a browser joins: 170 ms per million messages, in which no browser is served.
    This one walks the messages that still exist. It sends the small messages of a tick in one
    piece, which viser cuts after 128 messages, and large ones after them (see `Outbox`).

    It runs on the event loop of the server.

    Args:
        buffer: of the server.
        connections: of the browsers, by id.
        last: type of the messages that are sent after all messages queued before them.
    """

    def __init__(
        self,
        buffer: AsyncMessageBuffer,
        connections: Mapping[int, websocket.ServerConnection],
        last: type[Message],
    ) -> None:
        self._buffer = buffer
        self._connections = connections
        self._last = last
        self._packer = Packer()
        self._browsers: dict[int, _Browser] = {}
        self.is_held = False
        """True if messages wait for the end of an atomic block."""
        self._thread: int | None = None
        self._due: asyncio.Handle | None = None
        self.costs: Costs | None = None
        """Counts what is sent while it is there."""
        buffer._window_loop = self._windows
        _follow(buffer.message_event, self._send_soon)
        _follow(buffer.flush_event, self._send)

    async def _windows(
        self, client_id: int, backlog_last_id: int, backlog_done_message: Message | None
    ) -> AsyncGenerator[Sequence[Message], None]:
        """Serve a browser until it is gone, and leave nothing for viser to send."""
        self._thread = threading.get_ident()
        connection = self._connections[client_id]
        assert isinstance(connection, Connection)
        outbox = Outbox(self._last, connection.window.congestion)
        browser = _Browser(client_id, connection, outbox, backlog_last_id, backlog_done_message)
        self._browsers[client_id] = browser
        self._buffer.generator_cursors[client_id] = outbox.cursor
        self._send()
        try:
            await connection.wait_closed()
        finally:
            del self._browsers[client_id]
            self._buffer.generator_cursors.pop(client_id, None)
            if browser.draining is not None:
                browser.draining.cancel()
            if browser.resting is not None:
                browser.resting.cancel()
        return
        yield ()  # makes it a generator

    def _send_soon(self) -> None:
        # viser also calls this in the thread that queues a message.
        if self._due is None and threading.get_ident() == self._thread:
            loop = self._buffer.event_loop
            self._due = loop.call_later(self._buffer.window_duration_sec, self._send)

    def _send(self) -> None:
        """Send a frame to each browser that can take it."""
        if self._due is not None:
            self._due.cancel()
            self._due = None
        if self._buffer.done:
            return
        shared: dict[tuple[Progress, bool], _Step] = {}
        is_more = False
        for browser in self._browsers.values():
            if browser.draining is None:
                is_more |= self._serve(browser, shared)
        if is_more:
            self._due = self._buffer.event_loop.call_soon(self._send)

    def _serve(self, browser: _Browser, shared: dict[tuple[Progress, bool], _Step]) -> bool:
        """Send a frame to a browser; return whether there is another one that it can take now."""
        if browser.congestion.room(URGENT) < 1:
            self._rest(browser)
            return False
        outbox, before = browser.outbox, browser.outbox.progress
        is_live = browser.end_of_backlog is None
        is_shared = is_live and outbox.is_common
        key = before, browser.congestion.room() > 0
        step = shared.get(key) if is_shared else None
        if step is None:
            step = _Step(self._window(browser), outbox.progress)
            if is_shared:
                shared[key] = step
        outbox.progress = step.after
        # viser's garbage collector removes messages that all cursors have passed.
        self._buffer.generator_cursors[browser.id] = outbox.cursor
        if (frame := step.frame(self._packer, browser.id)) is not None:
            browser.connection.write(frame)
            if self.costs is not None:
                self.costs.add(browser.id, step.sizes(len(frame)))
        if browser.connection.paused:
            browser.draining = asyncio.ensure_future(self._drain(browser))
            return False
        is_held = not step.window and step.after == before  # until an atomic block ends
        if is_held and outbox.is_waiting():
            self._rest(browser)
        return not is_held and (not is_live or outbox.is_waiting())

    def _rest(self, browser: _Browser) -> None:
        """Serve a browser again when there may be room on its link."""
        if browser.resting is None:
            browser.resting = asyncio.ensure_future(self._resume(browser))

    async def _resume(self, browser: _Browser) -> None:
        await browser.congestion.wait()
        browser.resting = None
        self._go_on()

    def _go_on(self) -> None:
        if self._due is None:
            self._due = self._buffer.event_loop.call_soon(self._send)

    def _window(self, browser: _Browser) -> list[Message | Piece]:
        """Return the next messages for a browser."""
        buffer, outbox = self._buffer, browser.outbox
        with buffer.buffer_lock:
            live = buffer.message_from_id
            if buffer.atomic_counter:
                self.is_held = True
                return []
            if browser.end_of_backlog is None:
                return [
                    *outbox.small(live, buffer.message_counter - 1, None),
                    *outbox.large(live),
                ]
            window: list[Message | Piece] = []
            window += outbox.small(live, browser.backlog, buffer.max_window_size)
            if outbox.cursor >= browser.backlog:
                window.append(browser.end_of_backlog)
                browser.end_of_backlog = None
            return window

    async def _drain(self, browser: _Browser) -> None:
        try:
            await browser.connection.drain()
        except OSError:
            return  # it is gone
        browser.draining = None
        self._go_on()


class _Browser(msgspec.Struct):
    """A browser that is served.

    Args:
        id: viser's.
        connection: to it.
        outbox: chooses its messages.
        backlog: number of the last message from before it joined.
        end_of_backlog: to be sent after that one; None once it was.
        draining: while it has more to take than the system's buffers hold.
        resting: while something waits for room on its link.
    """

    id: int
    connection: Connection
    outbox: Outbox
    backlog: int
    end_of_backlog: Message | None
    draining: asyncio.Future[None] | None = None
    resting: asyncio.Future[None] | None = None

    @property
    def congestion(self) -> CongestionControl:
        """Return the congestion control of its link."""
        return self.connection.window.congestion


class _Step:
    """The frame that takes browsers from one progress to the next.

    Args:
        window: its messages.
        after: the progress with it.
    """

    def __init__(self, window: Sequence[Message | Piece], after: Progress) -> None:
        self.after = after
        self.window = window
        self._excluded = {message.excluded_self_client for message in window} - {None}
        self._frame: bytes | None = None
        self._sizes: Mapping[str, int] | None = None

    def sizes(self, whole: int) -> Mapping[str, int]:
        """Return the bytes of its frame by display, those of small messages in equal shares.

        Args:
            whole: size of the frame.
        """
        if self._sizes is None:
            sizes: dict[str, int] = {}
            named = [(display_of(name), each) for each in self.window if (name := _name(each))]
            bulky = [(display, _bulk(each)) for display, each in named]
            rest = max(0, whole - sum(size for _, size in bulky)) // max(1, len(self.window))
            for display, size in bulky:
                sizes[display] = sizes.get(display, 0) + size + rest
            self._sizes = sizes
        return self._sizes

    def frame(self, packer: Packer, browser_id: int) -> bytes | None:
        """Return the frame for a browser, None if it lacks nothing."""
        if browser_id in self._excluded:
            window = [m for m in self.window if m.excluded_self_client != browser_id]
            return packer.frame(window) if window else None
        if self._frame is None and self.window:
            self._frame = packer.frame(self.window)
        return self._frame


def _bulk(message: Message | Piece) -> int:
    return len(message.data) if isinstance(message, Piece) else bulk(message)


def _name(message: Message | Piece) -> str:
    """Return the name of the node that a message changes, "" if it changes none of a display."""
    name = getattr(message, "name", "")
    return name if isinstance(name, str) and name.startswith(f"{ROOT}/") else ""


def _follow(event: asyncio.Event, then: Callable[[], None]) -> None:
    """Call `then` whenever an event of viser is set."""
    original = event.set

    def set_and_then() -> None:
        original()
        then()

    event.set = set_and_then
