"""The node, subscriptions and publishers that this viewer declares in the graph."""

from __future__ import annotations

import itertools
from typing import Any

from webviz.sources.names import NODE
from webviz.sources.zenoh.attachment import gid_of
from webviz.sources.zenoh.tokens import GraphEntity, write_token

OWN = f"/{NODE}"
"""Full name of the viewer's node."""


class DeclaredEndpoint:
    """A token of this viewer.

    Args:
        token: its key.
        declared: by the engine.
    """

    def __init__(self, token: str, declared: Any) -> None:
        self.gid = gid_of(token)
        """Its identity, 16 bytes."""
        self._declared = declared

    def undeclare(self) -> None:
        """Remove it from the graph."""
        self._declared.undeclare()


class OwnNode:
    """The node of this viewer in one session.

    Args:
        session: that is open.
        domain: number of the ROS domain.
    """

    def __init__(self, session: Any, domain: int) -> None:
        self._session = session
        self._domain = domain
        self._zid = str(session.zid())
        self._ids = itertools.count()
        self._token = self.declare(GraphEntity("node", OWN))

    def declare(self, entity: GraphEntity, qos: str = "") -> DeclaredEndpoint:
        """Add the node or one of its endpoints to the graph; see `write_token`."""
        ids = 0, next(self._ids)
        token = write_token(self._domain, self._zid, ids, OWN, entity, qos)
        return DeclaredEndpoint(token, self._session.liveliness().declare_token(token))
