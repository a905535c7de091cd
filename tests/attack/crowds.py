"""Connections that never ask, while another client sends a request slowly."""

from __future__ import annotations

import contextlib
import socket
from random import Random

import msgspec

from tests.attack.attack import Attack, Case, Outcome, Violation
from tests.attack.target import ANSWER_S, Target
from webviz.api.roles import Role

ELSEWHERE = "127.0.0.2"
"""Another address of this machine than that of the owner."""
MAX_CONNECTIONS = 200
"""More than may be opening at once."""


class Crowd(msgspec.Struct):
    """A case.

    Args:
        connections: of the untrusted client.
        sent: by each of them.
        sent_before: bytes of the owner's request that arrive before them.
    """

    connections: int
    sent: str
    sent_before: int


class Crowds(Attack):
    """Opens connections of one address between two halves of a request of another.

    Args:
        target: the viewer.
    """

    kind = "crowds"

    def __init__(self, target: Target) -> None:
        self._target = target

    def draw(self, random: Random) -> Case:
        request = random.choice(
            ("", "G", "GET / HTTP/1.1\r\n", "GET / HTTP/1.1\r\nHost: a\r\n", "\x16")
        )
        crowd = Crowd(random.randrange(1, MAX_CONNECTIONS), request, random.randrange(40))
        return Case("crowd.json", msgspec.json.encode(crowd))

    def strike(self, case: Case) -> Outcome:
        crowd = msgspec.json.decode(case.data, type=Crowd)
        cookie = self._target.headers(Role.OWNER)["Cookie"]
        request = f"HEAD / HTTP/1.1\r\nHost: localhost\r\nCookie: {cookie}\r\n\r\n".encode()
        address = ("127.0.0.1", self._target.port)
        with contextlib.ExitStack() as stack:
            owner = stack.enter_context(socket.create_connection(address, ANSWER_S))
            owner.sendall(request[: crowd.sent_before])
            for _ in range(crowd.connections):
                client = socket.create_connection(address, ANSWER_S, (ELSEWHERE, 0))
                stack.enter_context(client)
                with contextlib.suppress(ConnectionError):  # it may be ended at once
                    client.sendall(crowd.sent.encode())
            try:
                owner.sendall(request[crowd.sent_before :])
                answer = owner.recv(12)
            except OSError as error:
                raise Violation(f"clients end the request of the owner: {error!r}") from error
        if answer != b"HTTP/1.1 200":
            raise Violation(f"clients end the request of the owner: {answer!r}")
        return Outcome.SURVIVED
