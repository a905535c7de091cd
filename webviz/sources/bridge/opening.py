"""Opening of connections to a bridge."""

from __future__ import annotations

import ssl
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from typing import TypeVar

from websockets.asyncio.client import connect

from webviz.sources.bridge.address import Address
from webviz.sources.bridge.connection import BridgeConnection
from webviz.sources.bridge.protocols import OFFERED
from webviz.sources.bridge.refusals import OPEN_TIMEOUT_S
from webviz.sources.inbox import MAX_TOTAL

CLOSE_S = 1.0
C = TypeVar("C", bound=BridgeConnection)


class _Connect(connect):
    def process_redirect(self, exc: Exception) -> Exception:
        """Follow no redirection: headers with tokens are for the address that somebody gave."""
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
