"""Headers that proxies add to the requests they forward."""

from __future__ import annotations

import ipaddress
from collections.abc import Iterable

import msgspec
from websockets.datastructures import Headers

from webviz.api.errors import Error

Address = ipaddress.IPv4Address | ipaddress.IPv6Address


class Caller(msgspec.Struct, frozen=True):
    """Origin of a request, and the address by which the browser reached the server."""

    address: str
    """IP address of the browser, or of the last proxy that is not trusted."""
    hosts: tuple[str, ...]
    """The values of its Host header, of which there should be one."""
    is_secure: bool
    """True if the browser uses https."""


class Proxies:
    """The proxies whose headers `X-Forwarded-For`, `-Host` and `-Proto` are used.

    Everyone can send these headers, so they are ignored in requests from other addresses.

    Args:
        addresses: IP addresses, or networks such as 10.0.0.0/8.

    Raises:
        Error: an address is invalid.
    """

    def __init__(self, addresses: Iterable[str] = ()) -> None:
        self._networks = [_network(address) for address in addresses]

    def caller(self, peer: str, headers: Headers, *, is_secure: bool) -> Caller:
        """Return the caller of a request.

        Args:
            peer: IP address of the other end of the connection.
            headers: of the request.
            is_secure: whether the connection uses TLS.
        """
        address = _address(peer)
        hosts = tuple(headers.get_all("Host"))
        if address is None or not self._trusts(address):
            return Caller(str(address or peer), hosts, is_secure)
        for value in reversed(_listed(headers, "X-Forwarded-For")):
            before = _address(value)
            if before is None or not self._trusts(address):
                break
            address = before
        hosts = tuple(headers.get_all("X-Forwarded-Host")) or hosts
        if schemes := _listed(headers, "X-Forwarded-Proto"):
            is_secure = schemes == ["https"]
        return Caller(str(address), hosts, is_secure)

    def _trusts(self, address: Address) -> bool:
        return any(address in network for network in self._networks)


def _network(text: str) -> ipaddress.IPv4Network | ipaddress.IPv6Network:
    try:
        return ipaddress.ip_network(text.strip("[]"), strict=False)
    except ValueError:
        raise Error(
            f"--trust-proxy {text} is not an IP address or network, such as 127.0.0.1 or "
            "10.0.0.0/8."
        ) from None


def _address(text: str) -> Address | None:
    """Return an IP address, which some proxies send with a port."""
    name, _, port = text.rpartition(":")
    if text.startswith("["):
        text = text.partition("]")[0][1:]
    elif port.isdecimal() and "." in name and ":" not in name:
        text = name
    try:
        address = ipaddress.ip_address(text.partition("%")[0])
    except ValueError:
        return None
    return getattr(address, "ipv4_mapped", None) or address


def _listed(headers: Headers, name: str) -> list[str]:
    values = ",".join(headers.get_all(name)).split(",")
    return [value.strip().lower() for value in values if value.strip()]
