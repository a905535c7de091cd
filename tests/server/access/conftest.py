"""A server that asks for tokens, with programs that join it as pages do."""

from __future__ import annotations

import http.client
from collections.abc import Iterator
from concurrent.futures import Future
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from bench import Bench

from tests.support.guest import Guest
from webviz.api.roles import Role
from webviz.api.vehicle import Velocity
from webviz.engine.commands import Command, Sender
from webviz.engine.driving import DrivingAnswer
from webviz.features.driving import DrivingFeature
from webviz.page.pages import Pages
from webviz.scene import open_server
from webviz.server.access import token_file
from webviz.server.access.access import Access
from webviz.server.access.tokens import Token, make
from webviz.server.http.viser_server import Server

PATIENCE_S = 30.0


@dataclass
class TokenServer:
    """A server that asks for tokens, and what reaches the viewer behind it.

    Args:
        server: of the pages.
        tokens: one of each role.
        path: of the file with them.
        access: reads it.
    """

    server: Server
    tokens: dict[Role, Token]
    path: Path
    access: Access

    def __post_init__(self) -> None:
        self.reached: list[str] = []
        self.priorities: list[int] = []
        self.guests: list[Guest] = []
        self.bench = Bench()
        driving: Any = self.bench.viewer.get(DrivingFeature)
        driving.steer = self._steer
        parts = self.bench.viewer.parts
        Pages(self.server.channel, self._enqueue, self.access, parts=parts)
        self.reached.clear()

    def cookie(self, role: Role) -> str:
        return f"webviz_{self.server.get_port()}={self.tokens[role].cookie}"

    def enter(self, role: Role) -> Guest:
        self.guests.append(Guest(self.server, Cookie=self.cookie(role)))
        return self.guests[-1]

    def ask(self, path: str = "/", method: str = "GET", **headers: str) -> http.client.HTTPResponse:
        port = self.server.get_port()
        connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)
        connection.request(
            method, path, headers={k.replace("_", "-"): v for k, v in headers.items()}
        )
        response = connection.getresponse()
        self.body = response.read()
        connection.close()
        return response

    def revoke(self, role: Role) -> None:
        name = self.tokens[role].name
        token_file.modify(self.path, lambda tokens: [t for t in tokens if t.name != name])

    def _enqueue(self, command: Command, sender: Sender) -> Future[str]:
        if type(command).__name__ != "Refresh":
            self.reached.append(type(command).__name__)
            self.priorities.append(sender.priority)
        done: Future[str] = Future()
        done.set_result("")
        return done

    def _steer(self, tool: str, browser: int, share: Velocity, beat: float | None) -> DrivingAnswer:
        self.reached.append("Drive")
        return DrivingAnswer()


@pytest.fixture
def token_server(tmp_path: Path) -> Iterator[TokenServer]:
    path = tmp_path / "tokens.json"
    now = datetime.now(UTC)
    tokens = {role: make(f"some {role.label}", role, now) for role in Role}
    token_file.modify(path, lambda _: list(tokens.values()))
    access = Access(True, path)
    server = open_server(port=0, access=access)
    token_server = TokenServer(server, tokens, path, access)
    yield token_server
    for guest in token_server.guests:
        guest.close()
    token_server.bench.viewer.close()
    server.stop()
