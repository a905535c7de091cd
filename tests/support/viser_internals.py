"""The parts of viser's server that tests reach into, as it has no names for them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from viser import ViserServer


def live_connections(server: ViserServer) -> Mapping[int, Any]:
    """Return the connections of all pages by the number of their browser."""
    return server._websock_server._live_connections  # pyright: ignore[reportPrivateUsage]


def cut_connections(server: ViserServer) -> None:
    """End the connections of all pages as a broken network does, without a farewell."""
    for connection in tuple(live_connections(server).values()):
        server.get_event_loop().call_soon_threadsafe(connection.transport.abort)
