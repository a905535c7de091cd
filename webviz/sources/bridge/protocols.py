"""The protocols of bridges: a server chooses one in the handshake."""

from __future__ import annotations

from webviz.sources.bridge.foxglove import FoxgloveSession
from webviz.sources.bridge.foxglove_wire import SUBPROTOCOLS
from webviz.sources.bridge.rosbridge import RosbridgeSession
from webviz.sources.bridge.session import BridgeSession, Host

OFFERED = SUBPROTOCOLS
"""Names that are offered to a server."""


def open_session(chosen: str | None, host: Host) -> BridgeSession:
    """Return the session of a new connection.

    Args:
        chosen: by the server, among those offered. rosbridge chooses none, Foxglove's servers
            always one.
        host: of the connection.
    """
    return RosbridgeSession(host) if chosen is None else FoxgloveSession(host)
