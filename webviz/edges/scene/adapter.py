"""The one place that calls viser's private parts; everything here is held by contract tests.

Why not the public setters: a pose setter ignores moves that `numpy.allclose` calls equal (3 m at
UTM coordinates) and costs ten times as much as queueing its message; two property setters are two
messages between which a browser may draw.
"""

from __future__ import annotations

import asyncio
import contextlib
import threading
import time
import uuid
from collections.abc import AsyncGenerator, Iterable, Sequence
from typing import Any

import numpy as np
import viser
from numpy.typing import NDArray
from viser import _messages as wire
from viser.infra._async_message_buffer import AsyncMessageBuffer
from viser.infra._infra import ClientId, WebsockClientConnection
from viser.infra._messages import Message

from webviz.edges.page.channel import Channel
from webviz.edges.page.messages import Answer, Ask, Beat
from webviz.edges.page.modules import Modules
from webviz.edges.scene.late import Late
from webviz.edges.scene.outbox import Outbox
from webviz.edges.scene.quiet_server import Server

# Removal messages that may wait in the buffer before browsers that do not read are let go.
MAX_TOMBSTONES = 10_000
_PRUNE_EVERY = 500
BEAT_PERIOD = 1.0
"""Seconds between two signs of life."""

Position = tuple[float, float, float]
Wxyz = tuple[float, float, float, float]


class _Position(wire.SetPositionMessage, include_in_scene_serialization=True):
    """viser's, packed for each browser at a tenth of the cost."""

    def redundancy_key(self) -> str:
        return f"scene:{self.name}:update:SetPositionMessage"

    def entity_state_key(self) -> tuple[str, str]:
        return "scene", self.name

    def as_serializable_dict(self, binary_buffers: list[memoryview] | None = None) -> dict:
        whose = {"name": self.name, "owner": self.owner}
        return {"type": "SetPositionMessage", "position": self.position, **whose}


class _Orientation(wire.SetOrientationMessage, include_in_scene_serialization=True):
    """viser's, packed for each browser at a tenth of the cost."""

    def redundancy_key(self) -> str:
        return f"scene:{self.name}:update:SetOrientationMessage"

    def entity_state_key(self) -> tuple[str, str]:
        return "scene", self.name

    def as_serializable_dict(self, binary_buffers: list[memoryview] | None = None) -> dict:
        whose = {"name": self.name, "owner": self.owner}
        return {"type": "SetOrientationMessage", "wxyz": self.wxyz, **whose}


class _Marker(wire.RunJavascriptMessage, include_in_scene_serialization=True):
    """Makes pages answer when they have handled all that was queued before it."""

    def redundancy_key(self) -> str:
        return self.source

    def as_serializable_dict(self, binary_buffers: list[memoryview] | None = None) -> dict:
        return {"type": "RunJavascriptMessage", "source": self.source}


class Adapter:
    """Sends a scene's messages to every browser of one viser server.

    Args:
        server: as from `open_server`; its broadcast buffer is told to replay in the number of live
            messages.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        assert isinstance(server, Server), "not opened by open_server"
        self.server = server
        self.channel = server.channel
        """To the modules of the pages."""
        self._socket = server._websock_server
        self._buffer: AsyncMessageBuffer = self._socket.get_message_buffer()
        self._queue = self._socket.queue_message
        self._acknowledged: dict[str, set[int]] = {}
        self._answered = threading.Condition()
        self._removed = 0
        self.late = Late()
        """What is slow to make, and sent when it is made."""
        replay_live_messages_only(self._buffer)
        self.channel.on(Answer, self._hear)

    def set_position(self, name: str, position: Position) -> None:
        """Places a node relative to its parent, however small the move."""
        self._queue(_Position(name, position))

    def set_orientation(self, name: str, wxyz: Wxyz) -> None:
        """Turns a node relative to its parent, however little."""
        self._queue(_Orientation(name, wxyz))

    def place(self, moves: Iterable[tuple[str, Position | None, Wxyz | None]]) -> None:
        """Places and turns many nodes at once; None leaves one of the two as it is.

        That is `set_position` and `set_orientation` with one lock for all: `push` of viser, less
        what is nothing to poses, takes a third of the time.
        """
        buffer = self._buffer
        live, newest = buffer.message_from_id, buffer.id_from_redundancy_key
        states = buffer.ids_from_entity_state_key
        with self.atomic(), buffer.buffer_lock:
            for name, position, wxyz in moves:
                messages: list[_Position | _Orientation] = []
                if position is not None:
                    messages.append(_Position(name, position))
                if wxyz is not None:
                    messages.append(_Orientation(name, wxyz))
                ids = states.setdefault(("scene", name), set())
                for message in messages:
                    key, number = message.redundancy_key(), buffer.message_counter
                    buffer.message_counter += 1
                    old = newest.get(key)
                    if old is not None:
                        del live[old]
                        ids.discard(old)
                    live[number] = message
                    newest[key] = number
                    ids.add(number)
            buffer.message_event.set()

    def update(self, name: str, props: dict[str, Any]) -> None:
        """Assigns several properties in one message; arrays must not change afterwards.

        A message replaces an unsent one with the same property names, so a node's properties are
        always sent in the same disjoint sets.
        """
        self._queue(wire.SceneNodeUpdateMessage(name, props))

    def atomic(self) -> contextlib.AbstractContextManager[None]:
        """What is queued inside reaches every browser in one piece."""
        return self.server.atomic()

    def flush(self) -> None:
        """Sends what is queued now instead of at the end of viser's 16 ms window."""
        self.server.flush()

    def count_removals(self, count: int) -> None:
        """Notes removed nodes, and now and then forgets the ones every browser has heard of."""
        self._removed += count
        if self._removed >= _PRUNE_EVERY:
            self._removed = 0
            self.server.get_event_loop().call_soon_threadsafe(self._prune)

    def camera(self, client: viser.ClientHandle) -> tuple[NDArray[np.float64], ...]:
        """A browser's camera, all of one and the same moment.

        Returns:
            float64 (3,) where it is, (4,) how it is turned, as a quaternion with w first (z looks
            forward, y down), and (3,) what it turns about, or soon will: in metres, in the
            coordinates of the scene.
        """
        state = client.camera._state
        return state.position, state.wxyz, state.look_at

    @property
    def watchers(self) -> int:
        """Browsers that are connected, also while they still load."""
        return len(self._socket._live_connections)

    @property
    def queued_messages(self) -> int:
        """Messages ever queued for everybody."""
        return self._buffer.message_counter

    @property
    def live_messages(self) -> int:
        """Messages that a browser which joins now is sent."""
        return len(self._buffer.message_from_id)

    def acknowledge(self, timeout: float = 10.0, client_id: int | None = None) -> None:
        """Waits until one connected browser, or every one, has applied everything queued so far.

        That is what was queued for everybody, for that browser alone, and on the channel, which
        travel apart.
        Applied means handled in order; the pixels follow with the next frame. Not to be called on
        viser's event loop.

        Raises:
            TimeoutError: a browser that is still connected did not answer within `timeout` seconds,
                or there was still something to send it.
        """
        tokens = [uuid.uuid4().hex for _ in range(3)]
        shared, own = (_Marker(self.server.modules.answer(token)) for token in tokens[:2])
        answered = {token: set[int]() for token in tokens}
        self._acknowledged |= answered
        asked = self.server.get_clients()
        if client_id is not None:
            asked = {id_: client for id_, client in asked.items() if id_ == client_id}
        deadline = time.monotonic() + timeout
        try:
            if not self.late.wait(timeout):
                raise TimeoutError(f"Pictures were not encoded within {timeout:g} s.")
            self._queue(shared)
            self.flush()
            for client in asked.values():
                client._websock_connection.queue_message(own)
                client.flush()
                self.channel.send(Ask(tokens[2]), client.client_id)
            with self._answered:
                while (asked.keys() & self.server.get_clients().keys()) - set.intersection(
                    *answered.values()
                ):
                    if time.monotonic() > deadline:
                        raise TimeoutError(f"A browser did not answer within {timeout:g} s.")
                    self._answered.wait(0.05)
        finally:
            for token in tokens:
                del self._acknowledged[token]
            self._buffer.remove_from_buffer(lambda message: message is shared)

    def _hear(self, browser: int, answer: Answer) -> None:
        with self._answered:
            if answer.token in self._acknowledged:
                self._acknowledged[answer.token].add(browser)
                self._answered.notify_all()

    def _prune(self) -> None:
        """Drops removal messages, and browsers that stopped reading (on the event loop).

        A browser must be told of every node it has seen go, so one that is asleep would hold a
        removal message for each node ever removed. Let go, it reconnects and gets the scene anew.
        """
        self.server._run_garbage_collector()
        with self._buffer.buffer_lock:
            messages = self._buffer.message_from_id.values()
            tombstones = sum(message.lifecycle_phase == "remove" for message in messages)
            oldest_wanted = self._buffer.message_counter - MAX_TOMBSTONES
        if tombstones <= MAX_TOMBSTONES:
            return
        for client_id, cursor in tuple(self._buffer.generator_cursors.items()):
            if cursor < oldest_wanted and client_id in self._socket._live_connections:
                self._socket._live_connections[client_id].transport.abort()


def greet(server: viser.ViserServer, channel: Channel, modules: Modules) -> None:
    """Makes every page that connects open the channel, and gives it a sign of life now and then.

    Args:
        server: the server; to be called before it has browsers.
        channel: of the server.
        modules: of its pages.
    """
    socket = server._websock_server

    def join(client: WebsockClientConnection) -> None:
        key = channel.join(client.client_id)
        source = modules.connect(client.client_id, key)
        client.queue_message(wire.RunJavascriptMessage(source=source))

    def leave(client: WebsockClientConnection) -> None:
        channel.leave(client.client_id)

    def end(browser: int) -> None:
        if browser in socket._live_connections:
            socket._live_connections[ClientId(browser)].transport.abort()

    channel.on_lost = end
    loop = server.get_event_loop()

    def beat() -> None:
        channel.send(Beat(time.time()))
        loop.call_later(BEAT_PERIOD, beat)

    loop.call_soon_threadsafe(beat)
    socket.on_client_connect(join)
    socket.on_client_disconnect(leave)


def message_type(kind: str) -> type[Any]:
    """viser's dataclass of the messages of that name."""
    return getattr(wire, kind)


def has_form(server: viser.ViserServer, handle_uuid: str, shared: bool = False) -> bool:
    """Whether there is a form of that id, in the shared GUI or in any browser's own."""
    guis = [server.gui]
    if not shared:
        guis += [client.gui for client in server.get_clients().values()]
    found = (gui._container_handle_from_uuid.get(handle_uuid) for gui in guis)
    return any(isinstance(handle, viser.GuiFormHandle) for handle in found)


def gui_input(server: viser.ViserServer, handle_uuid: str) -> Any:
    """The input widget of that id in the shared or any browser's own GUI, or None."""
    for gui in (server.gui, *(client.gui for client in server.get_clients().values())):
        handle = gui._gui_input_handle_from_uuid.get(handle_uuid)
        if handle is not None and not handle._impl.removed:
            return handle
    return None


def gui_value(handle: Any) -> Any:
    """The value an input widget has now."""
    return handle._impl.value


def gui_props(handle: Any) -> Any:
    """The properties of an input widget: min, max, options, disabled."""
    return handle._impl.props


def replay_live_messages_only(buffer: AsyncMessageBuffer) -> None:
    """Makes a joining browser cost what the scene holds, not what was ever sent.

    viser's own loop walks every message number from 0 on its event loop (170 ms per million
    messages, for everybody). This one walks the messages that still exist, for a browser that
    joins and for one that was stalled. It also sends the small messages of a tick in one piece,
    which viser cuts after 128 messages, and large ones after them (see `Outbox`).
    """

    def window_loop(
        client_id: int, backlog_last_id: int, backlog_done_message: Message | None
    ) -> AsyncGenerator[Sequence[Message], None]:
        return _windows(buffer, client_id, backlog_last_id, backlog_done_message)

    buffer._window_loop = window_loop


async def _windows(
    buffer: AsyncMessageBuffer,
    client_id: int,
    backlog_last_id: int,
    backlog_done_message: Message | None,
) -> AsyncGenerator[Sequence[Message], None]:
    # What asks whether all has arrived comes last.
    outbox = Outbox(_Marker)
    end_of_backlog = backlog_done_message
    flushed = asyncio.ensure_future(buffer.flush_event.wait())
    buffer.generator_cursors[client_id] = outbox.cursor
    try:
        while not buffer.done:
            window: list[Message] = []
            with buffer.buffer_lock:
                live = buffer.message_from_id
                if buffer.atomic_counter == 0 and end_of_backlog is not None:
                    window = outbox.small(live, backlog_last_id, buffer.max_window_size)
                    if outbox.cursor >= backlog_last_id:
                        window.append(end_of_backlog)
                        end_of_backlog = None
                elif buffer.atomic_counter == 0:
                    window = outbox.small(live, buffer.message_counter - 1, None)
                    window += outbox.large(live)
            # viser's garbage collector may forget what every browser's cursor has passed.
            buffer.generator_cursors[client_id] = outbox.cursor
            window = [m for m in window if m.excluded_self_client != client_id]
            if window:
                yield window
            else:
                await buffer.message_event.wait()
                buffer.message_event.clear()
            is_done = outbox.cursor == buffer.message_counter - 1 and not outbox.is_waiting()
            if not window or is_done:
                done, _ = await asyncio.wait([flushed], timeout=buffer.window_duration_sec)
                if done and not buffer.done:
                    buffer.flush_event.clear()
                    flushed = asyncio.ensure_future(buffer.flush_event.wait())
    finally:
        buffer.generator_cursors.pop(client_id, None)
        flushed.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await flushed
