"""Checks the Host and Origin headers of requests."""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Iterable

from websockets.datastructures import Headers

# A name, an IPv4 address, or an IPv6 address in brackets; optionally a port. No user, no path.
_HOST = re.compile(r"(?:(?P<name>[a-z0-9._-]+)|\[(?P<ipv6>[0-9a-f:.]+)\])(?::[0-9]{1,5})?")


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
        self._names = {"127.0.0.1", "localhost", "::1"}
        self._names |= {name.strip("[]").lower() for name in (bound, *names)}
        self._any_address = bound in ("", "0.0.0.0", "::")

    def refusal(self, headers: Headers) -> str | None:
        """The reason to refuse a request with these headers, as a sentence, or None."""
        hosts = headers.get_all("Host")
        host = hosts[0].lower() if len(hosts) == 1 else ""
        match = _HOST.fullmatch(host)
        if match is None:
            return "The Host header of the request is missing or invalid."
        name = match["name"] or match["ipv6"]
        if name not in self._names and not (self._any_address and _is_address(name)):
            return f"The host name {name!r} is not allowed. Start webviz with --allow-host {name}."
        own = (f"http://{host}", f"https://{host}")
        if any(origin.lower() not in own for origin in headers.get_all("Origin")):
            return "Requests from pages of other sites are not allowed."
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
