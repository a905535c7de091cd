"""The names under which a server may be addressed, and from which pages."""

from __future__ import annotations

import ipaddress
import re
from collections.abc import Iterable

from websockets.datastructures import Headers

# A name, an IPv4 address, or an IPv6 address in brackets; then perhaps a port. No user, no path.
_HOST = re.compile(r"(?:(?P<name>[a-z0-9._-]+)|\[(?P<ipv6>[0-9a-f:.]+)\])(?::[0-9]{1,5})?")


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

    def refusal(self, headers: Headers) -> str | None:
        """Why a request with these headers is refused, in one sentence, or None if it may pass."""
        hosts = headers.get_all("Host")
        host = hosts[0].lower() if len(hosts) == 1 else ""
        match = _HOST.fullmatch(host)
        if match is None:
            return "The Host header of the request is missing or invalid."
        name = match["name"] or match["ipv6"]
        if name not in self._names and not (self._any_address and _is_address(name)):
            return (
                f"This server does not answer to the name {name!r}; allow it when starting webviz."
            )
        own = (f"http://{host}", f"https://{host}")
        if any(origin.lower() not in own for origin in headers.get_all("Origin")):
            return "A page of another site may not use this server."
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True
