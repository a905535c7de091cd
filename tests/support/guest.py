"""A program that talks to a server as a page does, over both of its websockets."""

from __future__ import annotations

import socket
import time
from dataclasses import dataclass
from typing import Any

import msgspec
import websockets.sync.client

from tests.scene.conftest import HasPort, Peer

PATIENCE_S = 60.0


@dataclass
class Served:
    """The port of a viewer, for those that join it."""

    port: int

    def get_port(self) -> int:
        """Return it."""
        return self.port


class Connections:
    """Joins a server as a page does, and keeps both of its connections.

    Args:
        server: of the pages.
        below: path of the page.
        headers: of its requests, such as a cookie.
    """

    def __init__(self, server: HasPort, below: str = "/", **headers: str) -> None:
        self.viser = Peer(server, below, **headers)
        self.viser.look()
        for message in self.viser.replay():
            if message["type"] == "RunJavascriptMessage":
                source = message["source"].partition("(")[2].removesuffix(");")
                self.page = msgspec.json.decode(source)
        self.websocket = websockets.sync.client.connect(
            f"ws://127.0.0.1:{server.get_port()}{below}webviz/channel",
            compression=None,
            close_timeout=0.1,
            additional_headers=headers,
            max_size=None,
            ping_interval=None,
        )
        self.send("Hello", key=self.page["key"])

    def send(self, type_: str, **fields: Any) -> None:
        """Send a message."""
        self.say(msgspec.json.encode({"type": type_, **fields}).decode())

    def say(self, text: str) -> None:
        """Send any text."""
        self.websocket.send(text)


class Guest(Connections):
    """A page that reads what it asks for."""

    def receive(self, type_: str) -> dict[str, Any]:
        """The next message of a type."""
        deadline = time.monotonic() + PATIENCE_S
        while True:
            # Without a deadline of all, a connection that should end would keep a test for ever.
            text = self.websocket.recv(max(0.0, deadline - time.monotonic()))
            if (message := msgspec.json.decode(text))["type"] == type_:
                return message

    def do(self, command: str, **arguments: Any) -> str:
        """The answer to a command."""
        self.send("CommandRequest", number=1, command=command, arguments=arguments)
        return self.receive("CommandResult")["text"]

    def drop(self) -> None:
        """End what is sent on the channel without a word, as a browser that is killed."""
        self.websocket.socket.shutdown(socket.SHUT_WR)

    def close(self) -> None:
        """End the connections, as `Peer.close`."""
        self.websocket.close_socket()
        self.viser.close()
