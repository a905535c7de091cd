"""The handshake of the channel with every page that connects."""

from __future__ import annotations

import asyncio
import contextlib
import time

import viser
from viser import _messages as wire
from viser.infra._infra import ClientId, WebsockClientConnection
from websockets.asyncio.server import ServerConnection

from webviz.server.channel.channel import CLOSE_TIMEOUT_S, Channel
from webviz.server.channel.links import Links
from webviz.server.channel.messages import Heartbeat
from webviz.server.channel.modules import Modules
from webviz.server.http.connections import Connection
from webviz.server.sending.congestion import CongestionControl

BEAT_PERIOD = 1.0
"""Seconds between two heartbeats."""


def pace_of(connection: ServerConnection) -> CongestionControl:
    """Return the pace of a browser, by its connection for viser."""
    assert isinstance(connection, Connection)
    return connection.window.congestion


def greet(server: viser.ViserServer, channel: Channel, modules: Modules) -> None:
    """Make every page that connects open the channel, and send heartbeats.

    Pages that came before, such as those of a server that ran here, are sent away: they come again
    by themselves.

    Args:
        server: of the pages.
        channel: to the pages.
        modules: of the pages.
    """
    socket = server._websock_server

    def join(client: WebsockClientConnection) -> None:
        congestion = pace_of(socket._live_connections[client.client_id])
        key = channel.join(client.client_id, congestion)
        source = modules.connect(client.client_id, key)
        client.queue_message(wire.RunJavascriptMessage(source=source))

    def end(browser: int) -> None:
        if browser in socket._live_connections:
            socket._live_connections[ClientId(browser)].transport.abort()

    async def end_for_good(browser: int) -> None:
        if (connection := socket._live_connections.get(ClientId(browser))) is None:
            return
        with contextlib.suppress(TimeoutError):
            await asyncio.wait_for(connection.close(1002, "Ended by the owner"), CLOSE_TIMEOUT_S)
        connection.transport.abort()

    channel.on_lost = end
    channel.end_scene = end_for_good
    loop = server.get_event_loop()

    links = Links(channel)

    def beat() -> None:
        channel.send(Heartbeat(time.time()))
        links.tell()
        loop.call_later(BEAT_PERIOD, beat)

    def send_away() -> None:
        for browser in socket._live_connections.keys() - channel.browsers():
            end(browser)

    loop.call_soon_threadsafe(beat)
    socket.on_client_connect(join)
    socket.on_client_disconnect(lambda client: channel.leave(client.client_id))
    loop.call_soon_threadsafe(send_away)
