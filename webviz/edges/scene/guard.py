"""Who may talk to the server, and what browsers may say to it.

viser serves whoever reaches its port, any page open in the user's browser included, and lets a
browser overwrite the inside of its widgets or open a public tunnel. Here every connection is
checked before viser sees it, and every message before viser handles it.
"""

from __future__ import annotations

import asyncio
import functools
import gzip
import http
from collections.abc import Awaitable, Callable
from typing import Any

import viser
import websockets.asyncio.server as websocket
from websockets.http11 import Request, Response

from webviz.edges.page.channel import Channel, objection
from webviz.edges.page.modules import CHANNEL, Modules
from webviz.edges.scene.connections import Connection, Gate
from webviz.edges.scene.hosts import HostList
from webviz.edges.scene.http_requests import NOT_FOUND, PAGES, add_policy, is_upgrade
from webviz.edges.scene.listener import Listener
from webviz.edges.scene.messages import MAX_BYTES, Accepts
from webviz.edges.scene.sparing_log import sparing_log

MAX_WAITING_FRAMES = 4
"""Of a connection, received and not yet handled; the rest waits in the browser."""

Handler = Callable[[websocket.ServerConnection], Awaitable[None]]


def guarded_serve(
    serve: Callable[..., Any],
    listener: Listener,
    gate: Gate,
    hosts: HostList,
    accepts: Accepts,
    channel: Channel,
    modules: Modules,
) -> Callable[..., Any]:
    """Wraps `websockets.asyncio.server.serve` as viser calls it.

    Args:
        serve: the original.
        listener: the bound socket to serve instead of the host and port that viser asks for, so
            that viser neither moves to another port nor obeys its environment variable.
        gate: for the connections.
        hosts: names under which the server may be addressed.
        accepts: whether a decoded message that sets a value, changes a form or announces a file
            may pass.
        channel: to the modules of the page.
        modules: of the page.
    """
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
        reason = hosts.refusal(request.headers)
        if reason is not None:
            return connection.respond(http.HTTPStatus.FORBIDDEN, reason + "\n")
        connection.host = request.headers["Host"].lower()
        path = request.path.partition("?")[0]
        if (file := modules.get(path)) is not None:
            response = connection.respond(http.HTTPStatus.OK, "")
            fill(response, *file)
            response.headers["Cache-Control"] = "no-cache"
            return response
        if is_upgrade(request) and path == CHANNEL:
            connection.is_channel = True
            connection.objection = objection
            return None
        if gate.is_full:
            return connection.respond(
                http.HTTPStatus.SERVICE_UNAVAILABLE,
                f"{gate.limit} browsers are connected, and webviz serves no more at a time. Close "
                "one of its pages.\n",
            )
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

    def process_response(connection: Connection, _: Request, response: Response) -> None:
        if response.status_code != http.HTTPStatus.SWITCHING_PROTOCOLS:
            add_policy(response.headers, connection.host)
        if connection.wants_head:
            response.body = b""

    async def welcome(handler: Handler, connection: Connection) -> None:
        if connection.is_channel:
            await channel.serve(connection, lambda: gate.beside(connection))
            return
        if connection.subprotocol != f"viser-v{viser.__version__}":
            # The code upon which the page says why, and stops.
            await connection.close(1002, "This page is of another version of webviz: reload it")
            return
        with gate.inside(connection):
            await handler(connection)

    def guarded(handler: Any, host: str, port: int, **options: Any) -> Any:
        if not handler.__module__.startswith("viser."):
            return serve(handler, host, port, **options)
        asyncio.get_running_loop().set_exception_handler(
            lambda _, context: log.error(
                str(context["message"]).partition(":")[0], exc_info=context.get("exception")
            )
        )
        options |= {
            "process_request": functools.partial(process_request, options["process_request"]),
            "process_response": process_response,
            "create_connection": functools.partial(Connection, gate, accepts),
            "max_size": MAX_BYTES,
            "max_queue": MAX_WAITING_FRAMES,
            "logger": log,
            "server_header": None,
        }
        return serve(functools.partial(welcome, handler), sock=listener, **options)

    return guarded


def fill(response: Response, body: bytes, content_type: str) -> None:
    """Gives an answer another body."""
    response.body = body
    for name, value in (("Content-Type", content_type), ("Content-Length", str(len(body)))):
        del response.headers[name]
        response.headers[name] = value
