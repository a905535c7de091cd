"""Validation of the Host and Origin headers of requests."""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Iterable, Sequence

# A name, an IPv4 address, or an IPv6 address in brackets; optionally a port. No user, no path.
_HOST = re.compile(r"(?:(?P<name>[a-z0-9._-]+)|\[(?P<ipv6>[0-9a-f:.]+)\])(?::[0-9]{1,5})?")

LOOPBACK = ("127.0.0.1", "localhost", "::1")


def is_loopback(host: str) -> bool:
    """Return whether a valid Host header names the machine of the browser."""
    match = _HOST.fullmatch(host)
    return match is not None and (match["name"] or match["ipv6"]) in LOOPBACK


class HostList:
    """The host names by which a server may be addressed.

    The list prevents DNS rebinding: a page of another site cannot set the Host header, but can make
    its own name resolve to this machine. Ports are not compared, so that tunnels from other local
    ports work. A numeric address cannot be rebound, so a server that listens on every interface
    accepts any.

    Args:
        bound: address that the server is bound to.
        names: further names, without port.
    """

    def __init__(self, bound: str, names: Iterable[str] = ()) -> None:
        self._names = set(LOOPBACK)
        self._names |= {name.strip("[]").lower() for name in (bound, *names)}
        self._any_address = bound in ("", "0.0.0.0", "::")

    def refusal(self, hosts: Sequence[str]) -> str | None:
        """Return the reason to refuse a request, as a sentence, or None.

        Args:
            hosts: values of its Host header, of which there should be one.
        """
        host = hosts[0].lower() if len(hosts) == 1 else ""
        match = _HOST.fullmatch(host)
        if match is None:
            return "The Host header of the request is missing or invalid."
        name = match["name"] or match["ipv6"]
        if name not in self._names and not (self._any_address and _is_address(name)):
            return f"The host name {name!r} is not allowed. Start webviz with --allow-host {name}."
        return None


def origin_refusal(host: str, origins: Iterable[str]) -> str | None:
    """Return the reason to refuse a request of a page of another site, as a sentence, or None.

    Args:
        host: of the request, in lower case.
        origins: values of its Origin header.
    """
    own = (f"http://{host}", f"https://{host}")
    if any(origin.lower() not in own for origin in origins):
        return "Requests from pages of other sites are not allowed."
    return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
