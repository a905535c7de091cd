"""One robot of a fleet: its bridge, with its topics in its namespace and its stamps corrected."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, TypeVar

import msgspec

from webviz.api.bridge import Bridge
from webviz.api.offer import Endpoint, Offer, Publisher
from webviz.api.robots import NamespacedRobot
from webviz.data.messages.stamps import shifted
from webviz.sources.bridge.address import Address
from webviz.sources.inbox import Inbox, Raw
from webviz.sources.source import Subscription
from webviz.sources.zenoh.address import ZenohAddress

if TYPE_CHECKING:
    from webviz.sources.bridge.source import BridgeSource
    from webviz.sources.zenoh.source import ZenohSource

E = TypeVar("E", Publisher, Endpoint)
RobotAddress = Address | ZenohAddress
"""Address of a bridge, or of a Zenoh router."""


class MemberInbox(Inbox):
    """Passes the messages of one robot on to the inbox of all.

    Args:
        shared: the inbox of all.
        outer: returns the name of a topic there.
        moved: corrects a message, of a topic there.
    """

    def __init__(
        self,
        shared: Inbox,
        outer: Callable[[str], str],
        moved: Callable[[str, Raw], Raw],
    ) -> None:
        super().__init__()
        self._shared = shared
        self._outer = outer
        self._moved = moved
        self._open: dict[str, int] = {}
        """Limits by topic of the inbox of all."""
        self._is_left = False
        self.arrived = shared.arrived

    def open(self, topic: str, limit: int) -> None:
        """See `Inbox.open`."""
        if not self._is_left:
            name = self._outer(topic)
            self._open[name] = limit
            self._shared.open(name, limit)

    def close(self, topic: str) -> None:
        """See `Inbox.close`."""
        if self._open.pop(self._outer(topic), None) is not None:
            self._shared.close(self._outer(topic))

    def put(self, topic: str, raw: Raw) -> None:
        """See `Inbox.put`."""
        name = self._outer(topic)
        limit = self._open.get(name)
        if limit is not None:
            # Who had the topic before this robot was connected may have closed it only now.
            self._shared.open(name, limit)
            self._shared.put(name, self._moved(name, raw))

    def leave(self) -> None:
        """Close all topics, and pass nothing on any more."""
        self._is_left = True
        opened, self._open = self._open, {}
        for name in opened:
            self._shared.close(name)


class FleetMember:
    """A robot behind its bridge, or over Zenoh.

    Topics, nodes and services of the bridge appear in the namespace of the robot. Those that are in
    it already, since the robot itself has a namespace, keep their names.

    Args:
        robot: with its namespace.
        address: of its bridge or router.
        inbox: of the fleet.
        now_ns: ROS time of the fleet.
    """

    def __init__(
        self, robot: NamespacedRobot, address: RobotAddress, inbox: Inbox, now_ns: Callable[[], int]
    ) -> None:
        self.robot = robot
        self._now_ns = now_ns
        self._types: dict[str, str] = {}
        self._offers: tuple[Mapping[str, Offer], Mapping[str, Offer]] = {}, {}
        self._bridge: tuple[Bridge | None, int, Bridge | None] = None, 0, None
        self._inbox = MemberInbox(inbox, self.outer, self._moved)
        self.source = _source(address, self._inbox)

    @property
    def bridge(self) -> Bridge:
        """The link to its bridge."""
        (link,) = self.source.bridges
        former, ahead_ns, named = self._bridge
        if named is None or former is not link or ahead_ns != self.ahead_ns:
            ahead_ns = self.ahead_ns
            nodes = tuple(self.outer(node) for node in link.parameters.nodes)
            named = replace(
                link,
                robot=self.robot.name,
                clock_s=ahead_ns / 1e9,
                parameters=replace(link.parameters, nodes=nodes),
            )
            self._bridge = link, ahead_ns, named
        return named

    @property
    def ahead_ns(self) -> int:
        """Nanoseconds to subtract from its stamps; 0 with a simulated clock."""
        return 0 if self.source.clock_messages() is not None else self.source.clock.ahead_ns

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, by names of the fleet."""
        self._types = {topic: subscription.type for topic, subscription in subscriptions.items()}
        self.source.want({self.inner(topic): self._inner(w) for topic, w in subscriptions.items()})

    def offers(self) -> Mapping[str, Offer]:
        """All topics, by names of the fleet; another object only after a change."""
        former, named = self._offers
        source_offers = self.source.offers()
        if source_offers is not former:
            named = {
                self.outer(topic): self._outer(offer) for topic, offer in source_offers.items()
            }
            self._offers = source_offers, named
        return named

    def nodes(self) -> Sequence[str]:
        """Full names of its nodes, in its namespace."""
        return [self.outer(name) for name in self.source.graph.nodes()]

    def leave(self) -> None:
        """Close its topics at once, and its connection soon."""
        self._inbox.leave()
        self.source.stop()

    def outer(self, name: str) -> str:
        """Return the name in the fleet of a topic, node or service of the bridge."""
        root = self.robot.root
        return name if name.startswith(root) else root + name.removeprefix("/")

    def inner(self, name: str) -> str:
        """Return the name at the bridge of a topic, node or service of the fleet."""
        offers = self.source.offers()
        bare = "/" + name.removeprefix(self.robot.root)
        if name in offers:
            return name
        is_namespaced = any(topic.startswith(self.robot.root) for topic in offers)
        return name if is_namespaced and bare not in offers else bare

    def sent(self, type: str, cdr: bytes) -> bytes:
        """Return a message with its stamps by the clock of the robot."""
        return shifted(type, cdr, self.ahead_ns)

    def _moved(self, topic: str, raw: Raw) -> Raw:
        """Return a message with its stamps by the clock of this machine."""
        ahead_ns = self.ahead_ns
        type = self._types.get(topic, "")
        cdr = shifted(type, raw.cdr, -ahead_ns, raw.types) if ahead_ns and type else raw.cdr
        return replace(raw, cdr=cdr, received_ns=self._now_ns())

    def _inner(self, subscription: Subscription) -> Subscription:
        name = self.inner(subscription.topic.name)
        return replace(subscription, topic=msgspec.structs.replace(subscription.topic, name=name))

    def _outer(self, offer: Offer) -> Offer:
        publishers = tuple(self._named(each) for each in offer.publishers)
        readers = tuple(self._named(each) for each in offer.readers)
        return replace(offer, publishers=publishers, readers=readers)

    def _named(self, endpoint: E) -> E:
        return replace(endpoint, node=self.outer(endpoint.node)) if endpoint.node else endpoint


def _source(address: RobotAddress, inbox: Inbox) -> BridgeSource | ZenohSource:
    """Return the source of a robot; viewers without such robots load neither kind."""
    if isinstance(address, ZenohAddress):
        from webviz.sources.zenoh.source import ZenohSource

        return ZenohSource(address, inbox=inbox)
    from webviz.sources.bridge.source import BridgeSource

    return BridgeSource(address, inbox=inbox)
