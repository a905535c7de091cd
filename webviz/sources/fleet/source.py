"""The robots of a config that have connections of their own, and all other live topics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from webviz.api.bridge import Bridge
from webviz.api.offer import Offer
from webviz.api.robots import NamespacedRobot, robot_of
from webviz.sources.bridge.address import Address
from webviz.sources.fleet.graph import FleetGraph
from webviz.sources.fleet.member import FleetMember
from webviz.sources.graph import ReadOnly
from webviz.sources.inbox import Inbox
from webviz.sources.names import resolved
from webviz.sources.source import Source, Subscription

ALONE = (
    "Only the robots of the config are connected, and the name is in the namespace of none. "
    "Choose a name such as /{robot}/cmd_vel."
)


class FleetSource:
    """Robots behind bridges, each in its namespace, beside other live topics.

    Each has a connection that opens again by itself, and a clock of its own: stamps of its messages
    are moved to the clock of this machine. If any source has a simulated clock, ROS time is that of
    the first.

    Args:
        robots: with the addresses of their bridges.
        base: source of all other topics, closed with the fleet; None for the robots alone.
    """

    def __init__(
        self, robots: Sequence[tuple[NamespacedRobot, Address]], base: Source | None
    ) -> None:
        self._base = base
        self.inbox = Inbox() if base is None else base.inbox
        self._members = [
            FleetMember(robot, address, self.inbox, self.now_ns) for robot, address in robots
        ]
        others = ReadOnly(ALONE) if base is None else base.graph
        self.graph = FleetGraph(self._members, others)
        self._offers: tuple[list[Mapping[str, Offer]], dict[str, Offer]] = [], {}

    @property
    def bridges(self) -> Sequence[Bridge]:
        """The links to all robots."""
        others = () if self._base is None else self._base.bridges
        return [*others, *(member.bridge for member in self._members)]

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, each over its connection."""
        rest: dict[str, Subscription] = {}
        by_robot: dict[str, dict[str, Subscription]] = {m.robot.root: {} for m in self._members}
        robots = [member.robot for member in self._members]
        for topic, wish in subscriptions.items():
            robot = robot_of([topic], robots)
            (rest if robot is None else by_robot[robot.root])[topic] = wish
        for member in self._members:
            member.want(by_robot[member.robot.root])
        if self._base is not None:
            self._base.want(rest)

    def offers(self) -> Mapping[str, Offer]:
        """All topics; those in the namespace of a connected robot come over its connection."""
        known, merged = self._offers
        found = [member.offers() for member in self._members]
        found = [*([] if self._base is None else [self._base.offers()]), *found]
        if len(known) != len(found) or any(a is not b for a, b in zip(known, found, strict=True)):
            merged = {topic: offer for offers in found for topic, offer in offers.items()}
            self._offers = found, merged
        return merged

    def now_ns(self) -> int:
        """ROS time."""
        return self._clock.now_ns()

    def clock_messages(self) -> int | None:
        """Return the number of messages that set ROS time; None while it is wall time."""
        return self._clock.clock_messages()

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic; raises ValueError."""
        return resolved(topic, {}) if self._base is None else self._base.resolve(topic)

    def close(self) -> None:
        """Close all connections and the other source."""
        for member in self._members:
            member.source.stop()
        for member in self._members:
            member.source.close()
        if self._base is not None:
            self._base.close()

    @property
    def _clock(self) -> Source:
        """The source whose time counts."""
        members: list[Source] = [member.source for member in self._members]
        sources = members if self._base is None else [self._base, *members]
        return next((s for s in sources if s.clock_messages() is not None), sources[0])
