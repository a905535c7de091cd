"""Who may talk to the server, and what browsers may say to it.

viser serves whoever reaches its port, any page open in the user's browser included, and lets a
browser overwrite the inside of its widgets or open a public tunnel. Here every connection is
checked before viser sees it, and every message before viser handles it.
"""

from __future__ import annotations

import http
import ipaddress
import socket
from collections.abc import Callable, Iterable
from typing import Any
from urllib.parse import urlsplit

import msgspec
import websockets.asyncio.server as websocket
from websockets.http11 import Request, Response
from websockets.typing import Data

from webviz.scene import uploads

# A full-screen capture comes back as one message; everything else is small.
MAX_MESSAGE_BYTES = 32 * 2**20

# What viser's page sends of its own accord or in answer to us. Not here: ShareUrlRequest, which
# opens a public tunnel.
ALLOWED_MESSAGES = frozenset(
    {
        "CommandTriggerMessage",
        uploads.PART,
        uploads.START,
        "GetRenderResponseMessage",
        "GuiButtonHoldMessage",
        "GuiFormDirtyMessage",
        "GuiFormSubmitMessage",
        "GuiUpdateMessage",
        "LocalStorageGetItemResponseMessage",
        "SceneNodeClickMessage",
        "SceneNodeDragMessage",
        "ScenePointerMessage",
        "TransformControlsDragEndMessage",
        "TransformControlsDragStartMessage",
        "TransformControlsUpdateMessage",
        "ViewerCameraMessage",
    }
)

# Of these the content is checked as well.
CHECKED_MESSAGES = frozenset({"GuiUpdateMessage", uploads.START})

Accepts = Callable[[dict[str, Any]], bool]


def guarded_serve(
    serve: Callable[..., Any], listener: socket.socket, hosts: HostList, accepts: Accepts
) -> Callable[..., Any]:
    """Wraps `websockets.asyncio.server.serve` as viser calls it.

    Args:
        serve: the original.
        listener: the bound socket to serve instead of the host and port that viser asks for, so
            that viser neither moves to another port nor obeys its environment variable.
        hosts: names under which the server may be addressed.
        accepts: whether a decoded message that sets a value or announces a file may pass.
    """

    class Connection(websocket.ServerConnection):
        def __init__(self, *arguments: Any, **options: Any) -> None:
            super().__init__(*arguments, **options)
            self._uploads = uploads.Uploads()

        async def recv(self, decode: bool | None = None) -> Any:
            while True:
                data = await super().recv(decode)
                if _may_pass(data, accepts, self._uploads):
                    return data

    def guarded(handler: Any, host: str, port: int, **options: Any) -> Any:
        if not handler.__module__.startswith("viser."):
            return serve(handler, host, port, **options)
        serve_file = options.pop("process_request")

        def process_request(
            connection: websocket.ServerConnection, request: Request
        ) -> Response | None:
            reason = hosts.refusal(request)
            if reason is not None:
                return connection.respond(http.HTTPStatus.FORBIDDEN, reason + "\n")
            return serve_file(connection, request)

        options["max_size"] = MAX_MESSAGE_BYTES
        return serve(
            handler,
            sock=listener,
            process_request=process_request,
            create_connection=Connection,
            **options,
        )

    return guarded


class HostList:
    """The host names under which a server may be addressed.

    A page of another site cannot choose the Host header, yet can make its own name resolve to this
    machine (DNS rebinding): hence the list. The port is not compared, so that a tunnel from another
    local port works. A numeric address cannot be rebound, so a server that listens on every
    interface may be addressed by any.

    Args:
        bound: the address the server is bound to.
        names: further names, without port.
    """

    def __init__(self, bound: str, names: Iterable[str] = ()) -> None:
        self._names = {"127.0.0.1", "localhost", "::1"}
        self._names |= {name.strip("[]").lower() for name in (bound, *names)}
        self._any_address = bound in ("", "0.0.0.0", "::")

    def refusal(self, request: Request) -> str | None:
        """Why a request is refused, in one sentence, or None if it may pass."""
        hosts = request.headers.get_all("Host")
        host = hosts[0].lower() if len(hosts) == 1 else ""
        name = _hostname(host)
        if name is None or not (name in self._names or (self._any_address and _is_address(name))):
            return (
                f"This server does not answer to the name {name!r}; allow it when starting webviz."
            )
        origins = request.headers.get_all("Origin")
        if any(urlsplit(origin.lower()).netloc != host for origin in origins):
            return "A page of another site may not use this server."
        return None


def _hostname(host: str) -> str | None:
    try:
        return urlsplit("//" + host).hostname
    except ValueError:
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _may_pass(data: Data, accepts: Accepts, sent: uploads.Uploads) -> bool:
    if not isinstance(data, bytes):
        return False
    try:
        message = msgspec.msgpack.decode(data)
    except (msgspec.DecodeError, RecursionError, UnicodeDecodeError):
        return False
    kind = message.get("type") if isinstance(message, dict) else None
    if not isinstance(kind, str) or kind not in ALLOWED_MESSAGES:
        return False
    if kind in CHECKED_MESSAGES and not accepts(message):
        return False
    return kind not in (uploads.START, uploads.PART) or sent.accepts(message)
