"""The link of a scene to the browsers of a server."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, get_type_hints

import numpy as np
import viser
from numpy.typing import NDArray
from viser import _messages as wire
from viser._assignable_props_api import AssignablePropsBase
from viser.infra._messages import _prepare_for_serialization as prepared

from webviz.scene.adapter.acknowledging import AcknowledgementRequest, Acknowledgements, Probe
from webviz.scene.adapter.poses import (
    Move,
    OrientationMessage,
    Position,
    PositionMessage,
    Wxyz,
    queue_moves,
)
from webviz.scene.adapter.sender import SceneSender
from webviz.scene.deferred import DeferredMessages
from webviz.scene.label_budget import LabelBudget
from webviz.server.http.viser_server import Server
from webviz.server.images.pictures import Pictures
from webviz.server.sending.costs import Costs

_PLAIN = {str, bytes, float, int, bool, type(None)}
"""Types of values that msgpack takes as they are; what viser does to find out takes longer."""


class UpdateMessage(wire.SceneNodeUpdateMessage, include_in_scene_serialization=True):
    """Assigns properties of a node; most of its bytes are arrays, which need no preparation."""

    def as_serializable_dict(
        self, binary_buffers: list[memoryview] | None = None
    ) -> dict[str, Any]:
        """Return the message as viser packs it, under the name of viser's class."""
        updates = {name: _packed(value, binary_buffers) for name, value in self.updates.items()}
        type_ = "SceneNodeUpdateMessage"
        return {"name": self.name, "updates": updates, "owner": self.owner, "type": type_}


def _packed(value: Any, buffers: list[memoryview] | None) -> Any:
    if type(value) in _PLAIN:
        return value
    if buffers is None or not isinstance(value, np.ndarray):
        return prepared(value, Any, buffers)
    buffers.append(np.ascontiguousarray(value).data)
    return {"__binary_index": len(buffers) - 1, "dtype": value.dtype.str}


_hints = functools.cache(get_type_hints)


def evaluate_hints_once() -> None:
    """Make a new node cheaper: viser evaluates the annotations of its class anew for each."""

    def hints(handle: AssignablePropsBase[Any]) -> dict[str, Any]:
        return _hints(type(handle._impl.props))

    AssignablePropsBase._prop_hints = property(hints)  # pyright: ignore


MAX_TOMBSTONES = 10_000
"""Removal messages in the buffer, above which browsers that do not read are disconnected."""
_PRUNE_EVERY = 500


class Adapter:
    """Sends the messages of a scene to every browser of a server.

    Args:
        server: as from `open_server`.
    """

    def __init__(self, server: viser.ViserServer) -> None:
        assert isinstance(server, Server), "not opened by open_server"
        self.server = server
        self.channel = server.channel
        """Channel to the modules of the pages."""
        self.pictures = Pictures(server.channel)
        """Pictures in panes beside the scene."""
        self.deferred = DeferredMessages()
        """Messages that are slow to make, and are sent later."""
        # Without a browser nothing was drawn; its first browser does not wait for the next turn.
        server.on_client_connect(lambda client: self.deferred.wake())
        self.label_budget = LabelBudget()
        self._socket = server._websock_server
        self._buffer = self._socket.get_message_buffer()
        self._queue = self._socket.queue_message
        self._acknowledgements = Acknowledgements(server, self.deferred)
        self._removed = 0
        self._sender = SceneSender(
            self._buffer, self._socket._live_connections, last=AcknowledgementRequest
        )
        evaluate_hints_once()

    def set_position(self, name: str, position: Position) -> None:
        """Places a node relative to its parent."""
        self._queue(PositionMessage(name, position))

    def set_orientation(self, name: str, wxyz: Wxyz) -> None:
        """Turn a node relative to its parent."""
        self._queue(OrientationMessage(name, wxyz))

    def place(self, moves: Iterable[Move]) -> None:
        """Places and turns many nodes; to be called in an `atomic` block, or before `flush`."""
        queue_moves(self._buffer, moves)

    def update(self, name: str, props: dict[str, Any]) -> None:
        """Assign several properties in one message; arrays must not change afterwards.

        The message replaces an unsent one with the same property names. Hence always send the
        properties of a node in the same disjoint sets.
        """
        self._queue(UpdateMessage(name, props))

    @contextlib.contextmanager
    def atomic(self) -> Iterator[None]:
        """Send what is queued inside in one piece at its end, before viser's 16 ms are over."""
        buffer, sender = self._buffer, self._sender
        before = buffer.message_counter
        buffer.atomic_start()
        try:
            yield
        finally:
            with buffer.buffer_lock:
                buffer.atomic_counter -= 1
                is_due = sender.is_held or buffer.message_counter != before
                sender.is_held = False
            if is_due:
                self.flush()

    def flush(self) -> None:
        """Send what is queued now instead of at the end of viser's 16 ms window."""
        self.server.flush()

    def acknowledge(self, timeout: float = 10.0, client_id: int | None = None) -> int:
        """Wait until one browser, or all of them, have applied everything queued so far.

        Returns:
            Number of browsers that answered; those that are still loading are not waited for.

        Raises:
            TimeoutError: see `Acknowledgements.wait`.
        """
        return self._acknowledgements.wait(timeout, client_id)

    def probe(self, number: int) -> None:
        """Ask every page when it has painted everything queued so far; replace unsent probes."""
        self._queue(Probe(self.server.modules.probe(number)))
        self.flush()

    def count_bytes(self, is_wanted: bool) -> None:
        """Count the bytes of the scene and of pictures from now on, or no longer."""
        if not is_wanted:
            self._buffer.remove_from_buffer(lambda message: isinstance(message, Probe))
        self._sender.costs = self.pictures.costs = Costs() if is_wanted else None

    def bytes_sent(self) -> Mapping[int, Mapping[str, int]]:
        """Return the bytes since `count_bytes`, by id of the browser and of the display."""
        return self._sender.costs.by_browser() if self._sender.costs else {}

    def count_removals(self, count: int) -> None:
        """Count removed nodes, and sometimes drop removal messages that all browsers have."""
        self._removed += count
        if self._removed >= _PRUNE_EVERY:
            self._removed = 0
            self.server.get_event_loop().call_soon_threadsafe(self._prune)

    def camera(self, client: viser.ClientHandle) -> tuple[NDArray[np.float64], ...]:
        """Return a consistent snapshot of a browser's camera.

        Returns:
            float64 (3,) position, (4,) orientation as a quaternion with w first (z looks forward,
            y down), and (3,) pivot: in metres, in the coordinates of the scene.
        """
        state = client.camera._state
        return state.position, state.wxyz, state.look_at

    @property
    def watchers(self) -> int:
        """Number of connected browsers, including those that are loading."""
        return len(self._socket._live_connections)

    @property
    def queued_messages(self) -> int:
        """Number of shared messages queued so far."""
        return self._buffer.message_counter

    @property
    def live_messages(self) -> int:
        """Number of messages that a browser receives when it joins."""
        return len(self._buffer.message_from_id)

    def _prune(self) -> None:
        """Drop removal messages, and browsers that stopped reading (on the event loop).

        A sleeping browser has to receive the removal of every node, so each of these messages is
        kept. Once disconnected, the browser reconnects and receives the scene anew.
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
