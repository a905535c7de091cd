"""The parts of viser that tests reach into, as it has no public names for them."""

from __future__ import annotations

import inspect
import threading
from collections.abc import Collection, Mapping
from typing import Any

import viser
from viser import ViserServer
from viser.infra._async_message_buffer import AsyncMessageBuffer
from viser.infra._messages import Message


def live_connections(server: ViserServer) -> Mapping[int, Any]:
    """Return the connections of all pages by the number of their browser."""
    return server._websock_server._live_connections


def cut_connections(server: ViserServer) -> None:
    """End the connections of all pages as a broken network does, without a farewell."""
    for connection in tuple(live_connections(server).values()):
        server.get_event_loop().call_soon_threadsafe(connection.transport.abort)


def server_thread(server: ViserServer) -> threading.Thread | None:
    """Return the thread of the event loop."""
    return server._websock_server._server_thread


def is_shared(server: ViserServer) -> bool:
    """Return whether a tunnel leads to the server from elsewhere."""
    return server._share_tunnel is not None


def message_buffer(server: ViserServer) -> AsyncMessageBuffer:
    """Return the messages that each browser is sent."""
    return server._websock_server.get_message_buffer()


def queue_message(server: ViserServer, message: Message) -> None:
    """Send a message to all browsers."""
    server._websock_server.queue_message(message)


def window_loop() -> str:
    """Return the source text of the loop that webviz replaces."""
    return inspect.getsource(AsyncMessageBuffer._window_loop)


def scene_handles(server: ViserServer) -> Collection[Any]:
    """Return the handles of all nodes of the scene."""
    return server.scene._handle_from_node_name.values()


def property_types(handle: viser.SceneNodeHandle) -> Mapping[str, Any]:
    """Return the types of the properties of a node."""
    return handle._prop_hints


def state_of(handle: Any) -> Any:
    """Return the state behind the handle of a node or of a control."""
    return handle._impl
