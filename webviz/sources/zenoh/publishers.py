"""Publishers of one session."""

from __future__ import annotations

import contextlib
import time
from collections.abc import Collection
from typing import Any, NamedTuple

from webviz.data.messages import MessageError, type_hash
from webviz.sources.graph import Advertisement, NotConnected
from webviz.sources.zenoh.attachment import Attachment, write_attachment
from webviz.sources.zenoh.discovered import GraphSnapshot
from webviz.sources.zenoh.endpoints import DeclaredEndpoint, OwnNode
from webviz.sources.zenoh.engine import engine
from webviz.sources.zenoh.qos import write_qos
from webviz.sources.zenoh.tokens import GraphEntity, data_key

MAX_PUBLISHERS = 100
DRIVING = frozenset(("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped"))
"""Types that go before all others, and are not collected into larger packets."""


class ZenohPublisher(NamedTuple):
    """A publisher for one version of a type, or for a bridge.

    Attributes:
        declared: by the engine.
        token: in the graph.
    """

    declared: Any
    token: DeclaredEndpoint | None

    def undeclare(self) -> None:
        """Remove it."""
        with contextlib.suppress(engine().ZError):  # the session is closing
            self.declared.undeclare()
            if self.token is not None:
                self.token.undeclare()


class ZenohPublishers:
    """Publishes messages, each with number, time and identity of its publisher.

    Args:
        session: that is open.
        node: of this viewer.
        domain: number of the ROS domain.
    """

    def __init__(self, session: Any, node: OwnNode, domain: int) -> None:
        self._session = session
        self._node = node
        self._domain = domain
        self._publishers: dict[tuple[Advertisement, str], ZenohPublisher] = {}
        self._sequence = 0

    def advertise(self, advertisements: Collection[Advertisement], graph: GraphSnapshot) -> None:
        """Make the advertised publishers exactly these."""
        for key in [k for k in self._publishers if k[0] not in advertisements]:
            self._publishers.pop(key).undeclare()
        for each in advertisements:
            with contextlib.suppress(NotConnected):  # reported by `publish`
                self._find(each, graph)

    def publish(self, advertisement: Advertisement, cdr: bytes, graph: GraphSnapshot) -> int:
        """Publish a message; the number of matched subscriptions.

        Raises:
            NotConnected: no definition of its type is known.
        """
        publishers = self._find(advertisement, graph)
        self._sequence += 1
        for each in publishers:
            gid = each.token.gid if each.token else bytes(16)
            sender = Attachment(self._sequence, time.time_ns(), gid)
            each.declared.put(cdr, attachment=write_attachment(sender))
        return len(_readers(advertisement, graph))

    def _find(self, advertisement: Advertisement, graph: GraphSnapshot) -> list[ZenohPublisher]:
        """Return the publishers for all versions of the type that have a reader."""
        readers = _readers(advertisement, graph)
        hashes = {each.hash for each in readers if not each.is_bridged}
        bridged = {each.key for each in readers if each.is_bridged}
        if not hashes and not bridged:
            hashes.add(self._hash(advertisement, graph))
        # As a robot may start later than its bridge, of which it is then known.
        publishers = [self._publisher(advertisement, "", key) for key in sorted(bridged)]
        return publishers + [self._publisher(advertisement, hash) for hash in sorted(hashes)]

    def _hash(self, advertisement: Advertisement, graph: GraphSnapshot) -> str:
        """Return the version of a type without a reader yet."""
        published = graph.publishers.get(advertisement.topic, ())
        for each in published:
            if each.type == advertisement.type and each.hash:
                return each.hash
        try:
            return type_hash(advertisement.type)
        except MessageError as error:
            raise NotConnected(
                f"{advertisement.type} is unknown here. Source the workspace that has its package."
            ) from error

    def _publisher(self, advertisement: Advertisement, hash: str, key: str = "") -> ZenohPublisher:
        former = self._publishers.get((advertisement, key or hash))
        if former is not None:
            return former
        while len(self._publishers) >= MAX_PUBLISHERS:
            self._publishers.pop(next(iter(self._publishers))).undeclare()
        zenoh, topic, type = engine(), advertisement.topic, advertisement.type
        is_driving = type in DRIVING
        is_latched = advertisement.durability == "transient_local"
        declared = zenoh.ext.declare_advanced_publisher(
            self._session,
            key or data_key(self._domain, topic, type, hash),
            congestion_control=zenoh.CongestionControl.DROP,
            priority=zenoh.Priority.REAL_TIME if is_driving else zenoh.Priority.DATA,
            express=is_driving,
            cache=zenoh.ext.CacheConfig(advertisement.depth) if is_latched else None,
            publisher_detection=is_latched,
        )
        token = None
        if not key:
            qos = write_qos(
                advertisement.reliability, advertisement.durability, advertisement.depth
            )
            token = self._node.declare(GraphEntity("publisher", "", topic, type, hash=hash), qos)
        publisher = self._publishers[advertisement, key or hash] = ZenohPublisher(declared, token)
        return publisher


def _readers(advertisement: Advertisement, graph: GraphSnapshot) -> list[GraphEntity]:
    """Return the subscriptions of a topic that read its type."""
    readers = graph.readers.get(advertisement.topic, ())
    return [each for each in readers if each.type == advertisement.type]
