"""Validation of HTTP requests, and the security headers of responses.

websockets supports GET only and closes the connection on other requests without a response; viser
looks up any path on the disk. Hence the head of a request is checked before either sees it.
"""

from __future__ import annotations

import http
from collections.abc import Sequence

from websockets.datastructures import Headers
from websockets.exceptions import SecurityError
from websockets.http11 import Request
from websockets.streams import StreamReader

from webviz.server.http.hosts import is_loopback

MAX_HEAD_BYTES = 16 << 10
MAX_PATH_BYTES = 2 << 10
PAGES = ("/", "/index.html")
"""All paths served by viser, whose page is one file."""

UNUSED_FEATURES = (
    "accelerometer",
    "camera",
    "display-capture",
    "geolocation",
    "gyroscope",
    "hid",
    "magnetometer",
    "microphone",
    "midi",
    "payment",
    "serial",
    "usb",
)
"""Features of browsers that the page does without; it needs gamepads, full screen and the
clipboard."""
HTTPS_ONLY_S = 30 * 86400
"""Duration of HSTS. It holds for all ports of a host, so it should pass one day."""

NOBODY = "'none'"

Refusal = tuple[http.HTTPStatus, str]

NOT_FOUND: Refusal = http.HTTPStatus.NOT_FOUND, "Not found. The page of webviz is at /."


def is_complete(head: bytes) -> bool:
    """Return whether the bytes received so far are enough to check a request."""
    is_text = head[:1].isalpha()  # unlike a TLS handshake, which may have no end of line
    return not is_text or b"\n\r\n" in head or b"\n\n" in head or len(head) > MAX_HEAD_BYTES


def refusal(head: bytes) -> Refusal | None:
    """Return the reason to refuse a request, or None.

    Args:
        head: request line and headers, possibly followed by a body.
    """
    line = head.split(b"\n", 1)[0]
    words = line.rstrip(b"\r").split(b" ")
    if len(words) > 1 and len(words[1]) > MAX_PATH_BYTES:
        return http.HTTPStatus.REQUEST_URI_TOO_LONG, "The address is too long."
    if len(head) > MAX_HEAD_BYTES:
        too_large = http.HTTPStatus.REQUEST_HEADER_FIELDS_TOO_LARGE
        return too_large, "The headers of the request are too long."
    if len(words) != 3 or not words[0].isalpha() or not words[2].startswith(b"HTTP/"):
        return (
            http.HTTPStatus.BAD_REQUEST,
            "This is not an HTTP request. Use http://, not https://.",
        )
    if words[2] != b"HTTP/1.1":
        return http.HTTPStatus.HTTP_VERSION_NOT_SUPPORTED, "Only HTTP/1.1 is supported."
    if words[0] not in (b"GET", b"HEAD"):
        return http.HTTPStatus.METHOD_NOT_ALLOWED, "Only GET and HEAD are supported."
    if not _is_readable(as_get(head)):
        return http.HTTPStatus.BAD_REQUEST, "The request has invalid headers or a body."
    return None


def is_head(head: bytes) -> bool:
    """Return whether the request is for the headers only."""
    return head.startswith(b"HEAD ")


def as_get(head: bytes) -> bytes:
    """Return the same request with the method GET."""
    return b"GET" + head[4:] if is_head(head) else head


def is_upgrade(request: Request) -> bool:
    """Return whether a request opens a websocket."""
    return "websocket" in (value.lower() for value in request.headers.get_all("Upgrade"))


def add_policy(
    headers: Headers, host: str, *, is_tls: bool = False, embedders: Sequence[str] = ()
) -> None:
    """Restricts the page to this server, and forbids to embed it in other pages.

    There are three exceptions, since viser's page is one file of inline scripts and styles, decodes
    in workers made from blobs, and runs the scripts that webviz sends.

    Args:
        headers: of the response.
        host: Host header of the request if it is valid, else "".
        is_tls: whether the server itself uses TLS.
        embedders: origins of pages that may embed it after all.
    """
    websockets = f"ws://{host} wss://{host}" if host else ""
    headers["Content-Security-Policy"] = "; ".join(
        (
            "default-src 'none'",
            "script-src 'self' 'unsafe-inline' 'unsafe-eval' blob: data:",
            "worker-src blob:",
            "style-src 'self' 'unsafe-inline'",
            "img-src data: blob:",
            "font-src data:",
            f"connect-src 'self' {websockets} data: blob:",
            "base-uri 'none'",
            "form-action 'none'",
            f"frame-ancestors {' '.join(embedders) or NOBODY}",
        )
    )
    if not embedders:  # which this older header cannot name
        headers["X-Frame-Options"] = "DENY"
    headers["X-Content-Type-Options"] = "nosniff"
    headers["Referrer-Policy"] = "no-referrer"
    headers["Permissions-Policy"] = ", ".join(f"{feature}=()" for feature in UNUSED_FEATURES)
    headers["Cross-Origin-Opener-Policy"] = "same-origin"
    headers["Cross-Origin-Resource-Policy"] = "same-origin"
    if is_tls and host and not is_loopback(host):
        headers["Strict-Transport-Security"] = f"max-age={HTTPS_ONLY_S}"


def _is_readable(head: bytes) -> bool:
    """Return whether websockets can parse a request, which it would otherwise not answer."""
    reader = StreamReader()
    reader.feed_data(head)
    try:
        next(Request.parse(reader.read_line))
    except StopIteration:
        return True
    except (ValueError, EOFError, SecurityError, NotImplementedError):
        return False
    return False
