"""Servers behind this one: their pages are below a path of it, and have no port of their own."""

from __future__ import annotations

import asyncio
import http
import logging
import socket
from typing import cast

import msgspec
from websockets.http11 import Request, Response

from webviz.api.roles import Role
from webviz.server.http.connections import Connection
from webviz.server.http.steps import HTML, Reply, RequestContext

FOLDER = "/past/"
"""Path below which they are, each in a folder of its own."""
MOVED = (
    b"<!doctype html><meta charset=utf-8><title>webviz</title><p>This look back has ended. "
    b"<a href=../../>Back to live</a></p>\n"
)
NOT_YOURS = b"Not allowed: this look back is that of another page.\n"
BUFFER_BYTES = 1 << 16
"""Bytes on the way through: more would wait here, where newer messages cannot overtake."""
FORWARDED = ("X-Forwarded-For", "X-Forwarded-Host", "X-Forwarded-Proto", "Forwarded")


class _Target(msgspec.Struct, frozen=True):
    """A server behind this one.

    Args:
        path: of its socket.
        cookie: of the browser whose it is, "" if none is asked for.
    """

    path: str
    cookie: str


class Tunnels:
    """The servers behind one, by names that cannot be guessed; for any thread."""

    def __init__(self) -> None:
        self._targets: dict[str, _Target] = {}

    def add(self, name: str, path: str, cookie: str) -> None:
        """Hand requests below a name to the server that listens on a socket.

        Args:
            name: of a folder.
            path: of the socket.
            cookie: of the browser that may come, "" if none is asked for.
        """
        self._targets[name] = _Target(path, cookie)

    def remove(self, name: str) -> None:
        """Hand over no more requests."""
        self._targets.pop(name, None)

    def address(self, name: str) -> str:
        """Return the path of the page behind a name."""
        return f"{FOLDER}{name}/"

    def step(self, context: RequestContext) -> Reply | None:
        """Note where a request goes, see `webviz.server.http.steps`."""
        if not context.path.startswith(FOLDER):
            return None
        name, slash, below = context.path.removeprefix(FOLDER).partition("/")
        target = self._targets.get(name)
        if target is None or not slash:
            headers = {"Content-Type": HTML, "Cache-Control": "no-store"}
            return Reply(http.HTTPStatus.NOT_FOUND, MOVED, headers)
        if context.grant.role < Role.OPERATOR or context.grant.cookie != target.cookie:
            return Reply(http.HTTPStatus.FORBIDDEN, NOT_YOURS)
        context.socket, context.below = target.path, f"/{below}"
        return None


def hand_over(connection: Connection, context: RequestContext) -> Response:
    """Let a server behind this one answer a request, and all that comes on its connection.

    Args:
        connection: that has received the request and answered nothing.
        context: with the socket of the server.

    Returns:
        A response that is discarded, for websockets.
    """
    transport, connection.transport = connection.transport, _NoTransport()
    connection.loop.call_soon(connection.connection_lost, None)
    transport.pause_reading()
    front, back = _End(), _End()
    front.other, back.other = back, front
    transport.set_protocol(front)
    front.connection_made(transport)
    head = _head(context, is_head=connection.wants_head)
    connection.loop.create_task(_connect(context.socket, front, back, head))
    return connection.respond(http.HTTPStatus.OK, "")


async def _connect(path: str, front: _End, back: _End, head: bytes) -> None:
    try:
        await asyncio.get_running_loop().create_unix_connection(lambda: back, path)
    except OSError:  # it has ended in between
        front.close()
        return
    if front.transport is None or front.transport.is_closing():
        back.close()
        return
    back.data_received_from_other(head)
    front.transport.resume_reading()


def _head(context: RequestContext, *, is_head: bool) -> bytes:
    """Return the request as the server behind gets it, which trusts this one alone."""
    request = Request(context.below, context.request.headers.copy())
    for name in ("Host", *FORWARDED):
        if name in request.headers:
            del request.headers[name]
    request.headers["Host"] = context.host
    data = request.serialize()
    return b"HEAD" + data.removeprefix(b"GET") if is_head else data


class _NoTransport(asyncio.Transport):
    """Placeholder for a transport that was given to another protocol."""

    def is_closing(self) -> bool:
        """Return True."""
        return True

    def can_write_eof(self) -> bool:
        """Return True."""
        return True

    def write(self, data: object) -> None:
        """Ignore it; so do the others."""

    def write_eof(self) -> None:
        """Do nothing."""

    def close(self) -> None:
        """Do nothing."""

    def abort(self) -> None:
        """Do nothing."""


class _End(asyncio.Protocol):
    """One end of a tunnel; what it receives goes to the other as fast as that takes it."""

    def __init__(self) -> None:
        self.other: _End | None = None
        self.transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Bound what waits here."""
        self.transport = cast("asyncio.Transport", transport)
        self.transport.set_write_buffer_limits(high=BUFFER_BYTES)

    def data_received(self, data: bytes) -> None:
        """Pass on."""
        if self.other is not None:
            self.other.data_received_from_other(data)

    def data_received_from_other(self, data: bytes) -> None:
        """Send what the other end has received."""
        if self.transport is not None and not self.transport.is_closing():
            self.transport.write(data)

    def pause_writing(self) -> None:
        """Let the other end wait."""
        if self.other is not None and self.other.transport is not None:
            self.other.transport.pause_reading()

    def resume_writing(self) -> None:
        """Let the other end go on."""
        if self.other is not None and self.other.transport is not None:
            self.other.transport.resume_reading()

    def connection_lost(self, exc: Exception | None) -> None:
        """Close the other end, once what is on its way has been sent."""
        other, self.other, self.transport = self.other, None, None
        if other is not None:
            other.close()

    def close(self) -> None:
        """Close this end."""
        if self.transport is not None:
            self.transport.close()


class BackListener(socket.socket):
    """A listening socket in a folder that other users cannot read."""

    log: logging.Logger | None = None


def listen_behind(path: str) -> BackListener:
    """Listen at a path.

    Raises:
        OSError: it cannot be made.
    """
    listener = BackListener(socket.AF_UNIX, socket.SOCK_STREAM)
    listener.bind(path)
    listener.listen(8)
    return listener
