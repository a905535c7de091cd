"""People who are connected."""

from __future__ import annotations

import msgspec

from webviz.api.roles import Role


class Visitor(msgspec.Struct, frozen=True):
    """A person with a page of the viewer.

    Args:
        name: of their token, "" if none is asked for.
        role: what they may do.
        address: of their browser in the network, or of the proxy or tunnel that it uses.
        since_s: when they connected, in seconds since 1970.
        latency_s: to the page and back in seconds, None before it was measured.
    """

    name: str
    role: Role
    address: str
    since_s: float
    latency_s: float | None = None
