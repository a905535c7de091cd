"""Choice of the connection that makes room for another: of the network that has the most."""

from __future__ import annotations

import functools
import ipaddress
from collections import Counter
from collections.abc import Mapping
from typing import TypeVar

IPV6_PREFIX = 64
"""Bits of an IPv6 address that one subscriber has at least, who may use any address with them."""

T = TypeVar("T")


@functools.lru_cache(maxsize=1024)
def network_of(address: str) -> str:
    """Return the network by which connections are counted: an IPv4 address, or an IPv6 prefix.

    Args:
        address: of a browser; what is no IP address is returned as it is.
    """
    try:
        parsed = ipaddress.ip_address(address.partition("%")[0])
    except ValueError:
        return address
    if isinstance(parsed, ipaddress.IPv4Address):
        return str(parsed)
    if parsed.ipv4_mapped is not None:
        return str(parsed.ipv4_mapped)
    return str(ipaddress.ip_network((parsed, IPV6_PREFIX), strict=False))


def oldest_of_most_crowded(networks: Mapping[T, str]) -> T:
    """Return the first connection of the network that has the most of them.

    Args:
        networks: of each connection, at least one, the oldest first.
    """
    count = Counter(networks.values())
    return max(networks, key=lambda connection: count[networks[connection]])
