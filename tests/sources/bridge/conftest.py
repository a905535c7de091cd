"""Servers of bridges: the real one of Foxglove, and others that break the protocols."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from bridges import FoxgloveServer, Reader, foxglove_server, reading
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
def liar() -> Iterator[Callable[..., Reader]]:
    """Run a script for each connection, and read from it; without a protocol as rosbridge does."""
    opened: list[Any] = []

    def liar(script: Script, protocol: str = SDK, **options: Any) -> Reader:
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
        threading.Thread(target=server.serve_forever, daemon=True).start()
        port = server.socket.getsockname()[1]
        reader = reading(f"ws://127.0.0.1:{port}")
        opened.append((reader, server))
        return reader.__enter__()

    yield liar
    for reader, server in opened:
        reader.__exit__(None, None, None)
        server.shutdown()
