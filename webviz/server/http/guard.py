"""Checks every connection to the server, and every message from browsers.

viser accepts any connection to its port, even from other sites open in the user's browser, and lets
browsers overwrite the internals of widgets or open a public tunnel. Here connections are checked
before viser sees them, and messages before viser handles them.
"""

from __future__ import annotations

import asyncio
import contextlib
import functools
import gzip
import http
import ssl
from collections.abc import Awaitable, Callable
from typing import Any

import viser
import websockets.asyncio.server as websocket
from websockets.http11 import Request, Response

from webviz.server.access import login
from webviz.server.access.access import CHECK_S, Access
from webviz.server.access.proxies import Proxies
from webviz.server.channel.channel import Channel, objection
from webviz.server.channel.modules import CHANNEL, Modules
from webviz.server.http.connections import Connection, ConnectionLimits
from webviz.server.http.hosts import HostList
from webviz.server.http.listener import Listener
from webviz.server.http.requests import NOT_FOUND, PAGES, add_policy, is_upgrade
from webviz.server.http.sparing_log import sparing_log
from webviz.server.http.viser_messages import MAX_BYTES

MAX_WAITING_FRAMES = 4
"""Frames per connection that are received but not handled; further ones wait in the browser."""

Handler = Callable[[websocket.ServerConnection], Awaitable[None]]


def guarded_serve(
    serve: Callable[..., Any],
    listener: Listener,
    gate: ConnectionLimits,
    hosts: HostList,
    proxies: Proxies,
    tls: ssl.SSLContext | None,
    channel: Channel,
    modules: Modules,
    access: Access,
    rate: float | None,
) -> Callable[..., Any]:
    """Wraps `websockets.asyncio.server.serve` as viser calls it.

    Args:
        serve: the original.
        listener: socket to use instead of viser's host and port, so that viser neither moves to
            another port nor follows its environment variable.
        gate: limits the connections.
        hosts: names by which the server may be addressed.
        proxies: those whose headers are used.
        tls: certificate and key; None for plain HTTP.
        channel: to the modules of the page.
        modules: of the page.
        access: knows who may connect.
        rate: bytes a second that links to browsers are known to take; None to measure it.
    """
    port = listener.getsockname()[1]
    log = listener.log = sparing_log("webviz.server")

    @functools.lru_cache(maxsize=2)
    def page(body: bytes, is_packed: bool) -> bytes:
        whole = modules.added_to(body)
        return gzip.compress(whole) if is_packed else whole

    def process_request(
        serve_file: Callable[[Connection, Request], Response | None],
        connection: Connection,
        request: Request,
    ) -> Response | None:
        caller = proxies.caller(
            (connection.remote_address or ("",))[0], request.headers, is_secure=tls is not None
        )
        connection.address, connection.is_secure = caller.address, caller.is_secure
        reason = hosts.refusal(caller.hosts, request.headers.get_all("Origin"))
        if reason is not None:
            return connection.respond(http.HTTPStatus.FORBIDDEN, reason + "\n")
        connection.host = caller.hosts[0].lower()
        path = request.path.partition("?")[0]
        grant = login.grant_of(access, request.headers, port)
        if path in PAGES and login.token_in(request.path) and access.asks:
            return welcomed(connection, request)
        if grant is None:
            return turned_away(connection, login.NO_LINK)
        connection.grant = grant
        if is_upgrade(request) and path == CHANNEL:
            connection.is_channel = True
            connection.objection = objection
            return None
        if full := gate.refusal(connection):
            return connection.respond(http.HTTPStatus.SERVICE_UNAVAILABLE, full + "\n")
        if is_upgrade(request):
            return None
        if path not in PAGES:
            status, text = NOT_FOUND
            return connection.respond(status, text + "\n")
        encodings = ", ".join(request.headers.get_all("Accept-Encoding"))
        if encodings:
            del request.headers["Accept-Encoding"]
        response = serve_file(connection, request)
        if response is not None:
            is_packed = "gzip" in encodings
            fill(response, page(bytes(response.body), is_packed), "text/html; charset=utf-8")
            del response.headers["Content-Encoding"]
            if is_packed:
                response.headers["Content-Encoding"] = "gzip"
        return response

    def welcomed(connection: Connection, request: Request) -> Response:
        secure = connection.is_secure
        try:
            welcome = login.welcome(access, request.path, request.headers, port, secure)
        except login.NoCookies:
            return turned_away(connection, login.NO_COOKIES)
        if welcome is None:
            return turned_away(connection, login.INVALID_LINK)
        response = connection.respond(welcome.status, "")
        for name, value in welcome.headers.items():
            response.headers[name] = value
        return response

    def turned_away(connection: Connection, reason: str) -> Response:
        response = connection.respond(http.HTTPStatus.FORBIDDEN, "")
        fill(response, login.page(reason), "text/html; charset=utf-8")
        response.headers["Cache-Control"] = "no-store"
        return response

    def watch_tokens(loop: asyncio.AbstractEventLoop) -> None:
        """Ends connections whose token was revoked or has expired, again and again."""

        def look() -> None:
            loop.call_later(CHECK_S, look)  # first, as nothing may end this
            expel()  # tokens expire also while the disk does not respond
            access.begin_refresh(then)

        def expel() -> None:
            gate.expel(lambda connection: not access.holds(connection.grant))

        def then() -> None:
            with contextlib.suppress(RuntimeError):  # the server has stopped
                loop.call_soon_threadsafe(expel)

        look()

    def process_response(connection: Connection, _: Request, response: Response) -> None:
        if response.status_code != http.HTTPStatus.SWITCHING_PROTOCOLS:
            add_policy(response.headers, connection.host, is_tls=tls is not None)
        if connection.wants_head:
            response.body = b""

    async def welcome(handler: Handler, connection: Connection) -> None:
        if connection.is_channel:
            await channel.serve(connection, lambda: gate.opened(connection))
            return
        if connection.subprotocol != f"viser-v{viser.__version__}":
            # With this code the page shows the reason and does not reconnect.
            await connection.close(1002, "This page is from another version of webviz: reload it")
            return
        with gate.opened(connection):
            await handler(connection)

    def guarded(handler: Any, host: str, port: int, **options: Any) -> Any:
        if not handler.__module__.startswith("viser."):
            return serve(handler, host, port, **options)
        asyncio.get_running_loop().set_exception_handler(
            lambda _, context: log.error(
                str(context["message"]).partition(":")[0], exc_info=context.get("exception")
            )
        )
        if access.asks:
            watch_tokens(asyncio.get_running_loop())
        options |= {
            "process_request": functools.partial(process_request, options["process_request"]),
            "process_response": process_response,
            "create_connection": functools.partial(Connection, gate, rate),
            "max_size": MAX_BYTES,
            "max_queue": MAX_WAITING_FRAMES,
            "logger": log,
            "server_header": None,
        }
        if tls is not None:
            options["ssl"] = tls
        return serve(functools.partial(welcome, handler), sock=listener, **options)

    return guarded


def fill(response: Response, body: bytes, content_type: str) -> None:
    """Replaces the body of a response."""
    response.body = body
    for name, value in (("Content-Type", content_type), ("Content-Length", str(len(body)))):
        del response.headers[name]
        response.headers[name] = value
