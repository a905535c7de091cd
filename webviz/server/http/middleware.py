"""The middleware of the server: checks every connection and every message from browsers.

viser accepts any connection to its port, even from other sites open in the user's browser, and lets
browsers overwrite the internals of widgets or open a public tunnel. Here connections are checked
before viser sees them, and messages before viser handles them.
"""

from __future__ import annotations

import asyncio
import functools
import http
import logging
import ssl
from collections.abc import Awaitable, Callable, Sequence
from typing import Any

import msgspec
import viser
import websockets.asyncio.server as websocket
from websockets.http11 import Request, Response

from webviz.server.channel.channel import Channel, objection
from webviz.server.http.connections import Connection, ConnectionLimits
from webviz.server.http.listener import Listener
from webviz.server.http.requests import add_policy
from webviz.server.http.steps import Reply, RequestContext, Step, answer_of
from webviz.server.http.tunnels import BackListener, hand_over
from webviz.server.http.viser_messages import MAX_BYTES

INTERVAL = 60.0
"""Seconds in which further lines of the same kind are only counted."""


def rate_limited_log(name: str) -> logging.Logger:
    """Return a child of webviz's logger that is not shared by name."""
    log = logging.Logger(name)
    log.parent = logging.getLogger("webviz")
    log.addFilter(_RateLimitFilter())
    return log


class _RateLimitFilter(logging.Filter):
    """Passes one line of each kind per interval; tracebacks are shortened to one line."""

    def __init__(self) -> None:
        super().__init__()
        self._kinds: dict[str, tuple[float, int]] = {}

    def filter(self, record: logging.LogRecord) -> bool:
        if record.levelno < logging.WARNING:
            return False
        kind = str(record.msg)
        since, left_out = self._kinds.get(kind, (-INTERVAL, 0))
        if record.created - since < INTERVAL:
            self._kinds[kind] = since, left_out + 1
            return False
        self._kinds[kind] = record.created, 0
        text = record.getMessage()
        if record.exc_info and record.exc_info[1] is not None:
            text += f": {_one_line(record.exc_info[1])}"
        if left_out:
            text += f" ({left_out} similar lines omitted)"
        record.msg, record.args = text, ()
        record.exc_info = record.exc_text = None
        return True


def _one_line(error: BaseException) -> str:
    while error.__cause__ is not None:
        error = error.__cause__
    return " ".join(f"{type(error).__name__}: {error}".split())[:200]


MAX_WAITING_FRAMES = 4
"""Frames per connection that are received but not handled; further ones wait in the browser."""

Handler = Callable[[websocket.ServerConnection], Awaitable[None]]
ServeFile = Callable[[Connection, Request], Response | None]


class Middleware(msgspec.Struct):
    """Checks in front of viser's server.

    Args:
        listener: socket to use instead of viser's host and port, so that viser neither moves to
            another port nor follows its environment variable.
        steps: of each request, see `webviz.server.http.steps`.
        limits: of the connections.
        tls: certificate and key; None for plain HTTP.
        channel: to the modules of the page.
        begin: called on the event loop before the first connection.
        rate: bytes a second that links to browsers are known to take; None to measure it.
        embedders: origins of pages that may embed the page.
    """

    listener: Listener | BackListener
    steps: Sequence[Step]
    limits: ConnectionLimits
    tls: ssl.SSLContext | None
    channel: Channel
    begin: Callable[[asyncio.AbstractEventLoop], object]
    rate: float | None
    embedders: Sequence[str] = ()

    def serve(
        self, serve: Callable[..., Any], handler: Any, host: str, port: int, **options: Any
    ) -> Any:
        """Open viser's server behind these checks, and any other as it is.

        Args:
            serve: `websockets.asyncio.server.serve`; the other arguments are those of it.
            handler: of websockets.
            host: not used for viser's server.
            port: likewise.
            options: of the server.
        """
        if not handler.__module__.startswith("viser."):
            return serve(handler, host, port, **options)
        log = self.listener.log = rate_limited_log("webviz.server")
        loop = asyncio.get_running_loop()
        loop.set_exception_handler(
            lambda _, context: log.error(
                str(context["message"]).partition(":")[0], exc_info=context.get("exception")
            )
        )
        self.begin(loop)
        options |= {
            "process_request": functools.partial(self._answer, options["process_request"]),
            "process_response": self._finish,
            "create_connection": functools.partial(Connection, self.limits, self.rate),
            "max_size": MAX_BYTES,
            "max_queue": MAX_WAITING_FRAMES,
            "logger": log,
            "server_header": None,
        }
        if self.tls is not None:
            options["ssl"] = self.tls
        return serve(functools.partial(self._attend, handler), sock=self.listener, **options)

    def _answer(
        self, serve_file: ServeFile, connection: Connection, request: Request
    ) -> Response | None:
        """Answer a request, or let it open a websocket with what is known of its browser."""
        peer = (connection.remote_address or ("",))[0]
        fetch = functools.partial(serve_file, connection)
        context = RequestContext(request, fetch, peer, is_secure=self.tls is not None)
        reply = answer_of(self.steps, context)
        connection.host, connection.is_secure = context.host, context.is_secure
        connection.admit(context.address, context.grant)
        if reply is not None:
            return _response(connection, reply)
        if context.socket:
            return hand_over(connection, context)
        if context.is_channel:
            connection.is_channel = True
            connection.objection = objection
        return None

    def _finish(self, connection: Connection, _: Request, response: Response) -> None:
        if response.status_code != http.HTTPStatus.SWITCHING_PROTOCOLS:
            is_tls = self.tls is not None
            add_policy(response.headers, connection.host, is_tls=is_tls, embedders=self.embedders)
        if connection.wants_head:
            response.body = b""

    async def _attend(self, handler: Handler, connection: Connection) -> None:
        """Talk to a browser by the websocket that it has opened."""
        if connection.is_channel:
            await self.channel.serve(connection, lambda: self.limits.opened(connection))
        elif connection.subprotocol != f"viser-v{viser.__version__}":
            # With this code the page shows the reason and does not reconnect.
            await connection.close(1002, "This page is from another version of webviz: reload it")
        else:
            with self.limits.opened(connection):
                await handler(connection)


def _response(connection: Connection, reply: Reply) -> Response:
    response = connection.respond(reply.status, "")
    response.body = reply.body
    for name, value in {**reply.headers, "Content-Length": str(len(reply.body))}.items():
        if name in response.headers:
            del response.headers[name]
        response.headers[name] = value
    return response
