"""Reasons why a Zenoh session cannot be opened, as sentences with a remedy."""

from __future__ import annotations

import socket
import time
from collections.abc import Sequence

from webviz.data.words import Problem, plain
from webviz.sources.zenoh.address import ZenohAddress, host_and_port

KNOCK_S = 2.0
"""Time for the answer of one host."""
MAX_KNOCKS = 3
"""Endpoints that are tried to find the reason."""
AUTHORITY = (
    "the certificate of its authority in a session config, such as --connect zenoh.json5 "
    "(transport/link/tls/root_ca_certificate)"
)
START = "Start one there with `ros2 run rmw_zenoh_cpp rmw_zenohd`, or check host and port."


def explain_refusal(address: ZenohAddress, error: str) -> Problem:
    """Explain why no session could be opened; takes some seconds.

    Args:
        address: that was tried.
        error: of the engine, which names the endpoints but hardly ever the cause.
    """
    endpoints = address.endpoints[:MAX_KNOCKS]
    if not endpoints:
        return Problem(f"No Zenoh session with {address.name}: {_line(error)}.", "Check the file.")
    problems = [_knocked(endpoint) for endpoint in endpoints]
    return next((problem for problem in problems if problem is not None), _silent(endpoints, error))


def _knocked(endpoint: str) -> Problem | None:
    """Return what is wrong at an endpoint; None if something listens there, or it is unknown."""
    host, port = host_and_port(endpoint)
    if not host or not endpoint.startswith(("tcp/", "tls/", "ws/")):
        return None
    place = endpoint.partition("/")[2].partition("?")[0].partition("#")[0]
    try:
        with socket.create_connection((host, port), timeout=KNOCK_S):
            return None
    except ConnectionRefusedError:
        return Problem(f"Nothing listens on {place}, so there is no Zenoh router.", START)
    except TimeoutError:
        return Problem(
            f"{place} does not answer within {KNOCK_S:g} s.",
            "Check the address, the network and the robot's firewall.",
        )
    except socket.gaierror:
        return Problem(f"The host name of {place} is unknown.", "Check it, or use an IP address.")
    except OSError as error:
        reason = (error.strerror or _line(str(error))).rstrip(".")
        return Problem(f"{place} cannot be reached: {reason}.", START)


def _silent(endpoints: Sequence[str], error: str) -> Problem:
    """Return what is wrong if hosts answer but no router does."""
    place = endpoints[0].partition("/")[2]
    if endpoints[0].startswith("tls/"):
        return Problem(
            f"{place} listens, but no session over TLS was opened: {_line(error)}.",
            f"Name {AUTHORITY}.",
        )
    if endpoints[0].startswith("quic/"):  # over UDP, a listener cannot be told
        return Problem(
            f"No session over QUIC was opened with {place}: {_line(error)}.",
            f"Check that a router listens for QUIC on this UDP port, and name {AUTHORITY}.",
        )
    return Problem(
        f"The program at {place} is not a Zenoh router, refuses webviz, or hangs.",
        "Check the port, which is 7447 by default; a router with TLS needs tls/…, one that asks "
        "for a user WEBVIZ_ZENOH_USER and WEBVIZ_ZENOH_PASSWORD.",
    )


def gone(address: ZenohAddress, since_s: float) -> Problem:
    """Return the problem of a session that lost its router.

    Args:
        address: of the router.
        since_s: monotonic time at which it was lost.
    """
    seconds = time.monotonic() - since_s
    text = f"The connection to the Zenoh router at {address.name} was lost {seconds:.0f} s ago."
    return Problem(text, "Start it again, or check the network; webviz reconnects automatically.")


def _line(text: str) -> str:
    return plain(text.partition(" at /")[0], 200).strip().rstrip(".!")
