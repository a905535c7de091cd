"""Connections to a bridge: opening them, and reading and writing until they break."""

from __future__ import annotations

import asyncio
import ssl
from collections.abc import AsyncGenerator, Callable, Coroutine
from contextlib import asynccontextmanager
from typing import Any, TypeVar

from websockets.asyncio.client import connect

from webviz.sources.bridge.address import Address
from webviz.sources.bridge.connection import BridgeConnection
from webviz.sources.bridge.foxglove import FoxgloveSession
from webviz.sources.bridge.foxglove_wire import SUBPROTOCOLS
from webviz.sources.bridge.refusals import OPEN_TIMEOUT_S
from webviz.sources.bridge.rosbridge import RosbridgeSession
from webviz.sources.bridge.session import BridgeSession, Host, WireError
from webviz.sources.inbox import MAX_TOTAL

CLOSE_S = 1.0
C = TypeVar("C", bound=BridgeConnection)
OFFERED = SUBPROTOCOLS
"""Names that are offered to a server."""


def open_session(chosen: str | None, host: Host) -> BridgeSession:
    """Return the session of a new connection.

    Args:
        chosen: by the server, among those offered. rosbridge chooses none, Foxglove's servers
            always one.
        host: of the connection.
    """
    return RosbridgeSession(host) if chosen is None else FoxgloveSession(host)


class _Connect(connect):
    def process_redirect(self, exc: Exception) -> Exception:
        """Follow no redirection: headers with tokens are for the given address."""
        return exc


@asynccontextmanager
async def opened(address: Address, kind: type[C]) -> AsyncGenerator[C]:
    """Open a connection.

    Args:
        address: of the bridge.
        kind: class of the connection.

    Raises:
        OSError, WebSocketException: it cannot be opened, or breaks.
    """
    async with _Connect(
        address.url,
        subprotocols=OFFERED,  # pyright: ignore[reportArgumentType]
        additional_headers=address.headers,
        create_connection=kind,
        open_timeout=OPEN_TIMEOUT_S,
        close_timeout=CLOSE_S,
        ping_interval=None,  # the source pings: an answer may wait behind a large message
        max_size=MAX_TOTAL + (1 << 20),
        compression=None,
        ssl=ssl.create_default_context() if address.url.startswith("wss") else None,
    ) as socket:
        assert isinstance(socket, kind)
        yield socket


async def first_of(*work: Coroutine[Any, Any, None]) -> None:
    """Do all until the first ends, and end the others; raises its error."""
    tasks = [asyncio.ensure_future(each) for each in work]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:
        for task in tasks:
            task.cancel()
        outcomes = await asyncio.gather(*tasks, return_exceptions=True)
    for outcome in outcomes:
        if isinstance(outcome, Exception):
            raise outcome


async def read(
    socket: BridgeConnection, session: BridgeSession, malformed: Callable[[str], object]
) -> None:
    """Pass frames to a session, and report those that are not of the protocol."""
    while True:
        frame = await socket.recv()
        try:
            session.receive(frame)
        except WireError as error:
            malformed(str(error))


async def write(socket: BridgeConnection, outbox: asyncio.Queue[str | bytes]) -> None:
    """Send what is in the outbox."""
    while True:
        await socket.send(await outbox.get())
