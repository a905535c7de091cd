"""Reasons why a bridge cannot be reached, as sentences with a remedy."""

from __future__ import annotations

import socket
import ssl

from websockets.exceptions import (
    ConnectionClosed,
    InvalidHandshake,
    InvalidMessage,
    InvalidStatus,
    NegotiationError,
)

from webviz.data.words import Problem, plain
from webviz.sources.bridge.address import Address
from webviz.sources.bridge.connection import TOO_MANY_PARTS
from webviz.sources.inbox import MAX_TOTAL

REMEDY = "Start the bridge on the robot, or check host and port."
OPEN_TIMEOUT_S = 10.0
"""Time in seconds for the connection, TLS and the handshake."""


def explain(error: BaseException, address: Address) -> Problem:
    """Explain why a connection was not opened, or has ended."""
    place = address.place
    match error:
        case InvalidStatus():
            return _status(error, place)
        case NegotiationError():
            return Problem(
                f"The server at {place} answers with a protocol that webviz does not speak.",
                "Use a bridge with foxglove.sdk.v1 or foxglove.websocket.v1, or rosbridge.",
            )
        case ConnectionClosed():
            return Problem(_closed(error), "Check the log of the bridge.")
        case InvalidMessage() | InvalidHandshake():
            return Problem(
                f"The program at {place} is not a websocket server.",
                "Check the port; a bridge with TLS needs wss://.",
            )
        case TimeoutError():
            return Problem(
                f"{place} does not answer within {OPEN_TIMEOUT_S:g} s.",
                "Check the address, the network and the robot's firewall.",
            )
        case ssl.SSLCertVerificationError():
            return Problem(
                f"The certificate of {place} is not trusted: {error.verify_message}.",
                "Name the file of its authority in the variable SSL_CERT_FILE.",
            )
        case ssl.SSLError():
            return Problem(f"{place} does not speak TLS.", "Use ws:// instead of wss://.")
        case socket.gaierror():
            return Problem(
                f"The host name of {place} is unknown.", "Check it, or use an IP address."
            )
        case OSError():
            return _network(error, place)
    return Problem(f"The link to {place} has failed: {_line(error)}.", REMEDY)


def _network(error: OSError, place: str) -> Problem:
    # With several addresses of one host, asyncio has only the text of each error.
    if isinstance(error, ConnectionRefusedError) or "Connect call failed" in str(error):
        return Problem(f"Nothing listens on {place}.", REMEDY)
    reason = (error.strerror or _line(error)).rstrip(".")
    return Problem(f"{place} cannot be reached: {reason}.", REMEDY)


def _status(error: InvalidStatus, place: str) -> Problem:
    status = error.response.status_code
    body = plain(bytes(error.response.body or b"").decode("utf-8", "replace"), 200)
    if status in (401, 403):
        return Problem(
            f"{place} asks for credentials (HTTP {status}).",
            "Give its token with --connect-headers, such as `Authorization: Bearer TOKEN`.",
        )
    if status == 400:
        return Problem(
            f"{place} refuses the protocols foxglove.sdk.v1 and foxglove.websocket.v1 (HTTP 400"
            + (f": {body.rstrip('.')})." if body else ")."),
            "Update foxglove_bridge on the robot, or check that this port is of a bridge.",
        )
    return Problem(f"{place} answers with HTTP {status} instead of a websocket.", REMEDY)


def _closed(error: ConnectionClosed) -> str:
    closing, ours = error.rcvd, error.sent
    if ours is not None and ours.reason == TOO_MANY_PARTS:
        return f"The bridge sent {TOO_MANY_PARTS}."
    if ours is not None and ours.code == 1009 and not error.rcvd_then_sent:
        return f"The bridge sent a frame above the limit of {MAX_TOTAL >> 20} MB."
    if closing is None:
        return "The link to the bridge broke."
    reason = plain(closing.reason, 200).rstrip(".")
    return f"The bridge closed the link (code {closing.code}{': ' + reason if reason else ''})."


def _line(error: BaseException) -> str:
    return plain(str(error), 200).rstrip(".") or error.__class__.__name__
