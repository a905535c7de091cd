"""Servers of bridges: the real one of Foxglove, and others that break the protocols."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from typing import Any

import pytest
from bridges import BridgeReader, FoxgloveServer, foxglove_server, reading
from serving import serving
from websockets.exceptions import ConnectionClosed
from websockets.sync.server import ServerConnection, serve

INFO = {"op": "serverInfo", "name": "liar", "capabilities": ["services", "assets"]}
SDK = "foxglove.sdk.v1"
Script = Callable[[ServerConnection], None]


@pytest.fixture(scope="module")
def server() -> Iterator[FoxgloveServer]:
    """The real server of foxglove-sdk."""
    with foxglove_server() as server:
        yield server


@pytest.fixture
def liar() -> Iterator[Callable[..., BridgeReader]]:
    """Run a script for each connection, and read from it; without a protocol as rosbridge does."""

    def liar(script: Script, protocol: str = SDK, **options: Any) -> BridgeReader:
        def talk(connection: ServerConnection) -> None:
            try:
                if protocol:
                    connection.send(json.dumps(INFO))
                script(connection)
                for _ in connection:
                    pass
            except ConnectionClosed:
                return

        options = {"subprotocols": [protocol] if protocol else None, "max_size": None, **options}
        server = serve(talk, "127.0.0.1", 0, compression=None, **options)
        port = stack.enter_context(serving(server)).socket.getsockname()[1]
        return stack.enter_context(reading(f"ws://127.0.0.1:{port}"))

    with ExitStack() as stack:
        yield liar
