"""The robots of a config that have connections of their own, and all other live topics."""

from __future__ import annotations

import contextlib
import dataclasses
import os
import time
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import Future, InvalidStateError

from msgspec.structs import replace

from webviz.api.bridge import Bridge
from webviz.api.errors import Error
from webviz.api.offer import Offer
from webviz.api.robots import NamespacedRobot, robot_of
from webviz.sources.bridge.address import address, headers_of
from webviz.sources.fleet.member import FleetMember, RobotAddress
from webviz.sources.graph import Advertisement, Goal, Graph, ReadOnly
from webviz.sources.inbox import Inbox
from webviz.sources.names import is_own, resolved
from webviz.sources.source import Source, Subscription
from webviz.sources.zenoh.address import DOMAIN, PASSWORD, USER, is_zenoh, zenoh_address


class FleetGraph:
    """Publishes and calls services by namespace; see `webviz.sources.Graph`.

    Args:
        base: returns the graph of all other names, which may change.
    """

    def __init__(self, base: Callable[[], Graph]) -> None:
        self._members: Sequence[FleetMember] = ()
        self._newest_base = base
        self._advertised: Collection[Advertisement] = ()

    def follow(self, members: Sequence[FleetMember]) -> None:
        """Make the robots with connections exactly these, and advertise to new ones."""
        self._members = members
        if self._advertised:
            self.advertise(self._advertised)

    def advertise(self, advertisements: Collection[Advertisement]) -> Future[None]:
        """Make the advertised publishers exactly these; fails if one connection refuses."""
        self._advertised, members = advertisements, self._members
        by_robot: dict[FleetMember | None, list[Advertisement]] = {m: [] for m in members}
        rest: list[Advertisement] = []
        for each in advertisements:
            member = _member(each.topic, members)
            if member is None:
                rest.append(each)
            else:
                by_robot[member].append(_renamed(each, member))
        pending = [m.source.graph.advertise(by_robot[m]) for m in members]
        if rest or not isinstance(self._base, ReadOnly):
            pending.append(self._base.advertise(rest))
        return _all(pending)

    def publish(self, advertisement: Advertisement, cdr: bytes) -> Future[int]:
        """Publish a message to the robot whose topic it is, with stamps by its clock."""
        member = self._member(advertisement.topic)
        if member is None:
            return self._base.publish(advertisement, cdr)
        sent_cdr = member.sent(advertisement.type, cdr)
        return member.source.graph.publish(_renamed(advertisement, member), sent_cdr)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service of the robot that offers it."""
        member = self._member(service)
        if member is None:
            return self._base.call(service, type, request, timeout_s)
        return member.source.graph.call(member.inner(service), type, request, timeout_s)

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Send a goal to the robot that offers the action; bridges refuse it."""
        member = self._member(action)
        if member is None:
            return self._base.send_goal(action, type, goal, feedback)
        return member.source.graph.send_goal(member.inner(action), type, goal, feedback)

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of all graphs, sorted."""
        names = [*self._base.nodes()]
        for member in self._members:
            names += member.nodes()
        return tuple(sorted(names))

    def services(self) -> Mapping[str, str]:
        """Types of the services by name; bridges are only asked for what is called."""
        services = dict(self._base.services())
        for member in self._members:
            for name, type in member.source.graph.services().items():
                services[member.outer(name)] = type
        return services

    @property
    def _base(self) -> Graph:
        return self._newest_base()

    def _member(self, name: str) -> FleetMember | None:
        return _member(name, self._members)


def _member(name: str, members: Sequence[FleetMember]) -> FleetMember | None:
    robot = robot_of([name], [m.robot for m in members])
    return next((m for m in members if m.robot is robot), None)


def _renamed(advertisement: Advertisement, member: FleetMember) -> Advertisement:
    return replace(advertisement, topic=member.inner(advertisement.topic))


def _all(futures: Sequence[Future[None]]) -> Future[None]:
    """Return a future that is done when all are; it has the first error."""
    result: Future[None] = Future()

    def look(future: Future[None]) -> None:
        # Connections have threads of their own: the last two may see at once that all are done.
        with contextlib.suppress(InvalidStateError):
            if error := future.exception():
                result.set_exception(error)
            elif all(each.done() for each in futures):
                result.set_result(None)

    for future in futures:
        future.add_done_callback(look)
    return result


ALONE = (
    "The name is in the namespace of no robot of the config. "
    "Choose a name such as /{robot}/cmd_vel."
)


class FleetSource:
    """Robots behind bridges, each in its namespace, beside other live topics.

    Each has a connection that reopens automatically, and a clock of its own: stamps of its messages
    are moved to the clock of this machine. If any source has a simulated clock, ROS time is that of
    the first.

    Args:
        robots: those with connections are connected.
        base: source of all other topics, closed with the fleet; None for the robots alone.

    Raises:
        Error: the address of a connection is invalid, or a header for it.
    """

    def __init__(self, robots: Sequence[NamespacedRobot], base: Source | None) -> None:
        self._first = {(robot.name, robot.connection) for robot in _connected(robots)}
        """The robots of the start with their connections: headers of the environment go only there,
        since who opens a config later may not have written it."""
        for robot in _connected(robots):
            self._address(robot)  # before any thread is started
        self._base = base
        self.inbox = Inbox() if base is None else base.inbox
        self._members: Sequence[FleetMember] = ()
        self._refused: Sequence[Bridge] = ()
        """Robots of the config that cannot be connected."""
        self._subscriptions: Mapping[str, Subscription] = {}
        alone = ReadOnly(ALONE)
        self._graph = FleetGraph(lambda: alone if base is None else base.graph)
        self._offers: tuple[list[Mapping[str, Offer]], Mapping[str, Offer]] = [], {}
        self._doubled: Mapping[str, tuple[str, ...]] = {}
        """Topics that the base has, too, by the root of their robot."""
        self.follow(robots)

    def follow(self, robots: Sequence[NamespacedRobot]) -> None:
        """Make the connections exactly those of these robots; existing ones stay open."""
        former = {_link(m.robot): m for m in self._members}
        members: list[FleetMember] = []
        refused: list[Bridge] = []
        for robot in _connected(robots):
            member = former.pop(_link(robot), None)
            try:
                member = member or self._member(robot)
            except Error as error:
                refused.append(Bridge(robot.name, problem=str(error), robot=robot.name))
                continue
            member.robot = robot
            members.append(member)
        for member in former.values():
            member.leave()
        self._members, self._refused = members, refused
        self._graph.follow(members)
        self.want(self._subscriptions)

    @property
    def graph(self) -> Graph:
        """The graph of all robots; without them, that of a base which can only be read."""
        base = None if self._members or self._base is None else self._base.graph
        return base if isinstance(base, ReadOnly) else self._graph

    @property
    def bridges(self) -> Sequence[Bridge]:
        """The links to all robots."""
        others = () if self._base is None else self._base.bridges
        return [*others, *map(self._bridge, self._members), *self._refused]

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, each over its connection."""
        self._subscriptions = subscriptions
        rest: dict[str, Subscription] = {}
        by_robot: dict[str, dict[str, Subscription]] = {m.robot.root: {} for m in self._members}
        robots = [member.robot for member in self._members]
        for topic, subscription in subscriptions.items():
            robot = robot_of([topic], robots)
            (rest if robot is None else by_robot[robot.root])[topic] = subscription
        for member in self._members:
            member.want(by_robot[member.robot.root])
        if self._base is not None:
            self._base.want(rest)

    def offers(self) -> Mapping[str, Offer]:
        """All topics; those in the namespace of a connected robot come over its connection."""
        former, merged = self._offers
        offer_lists = [member.offers() for member in self._members]
        offer_lists = [*([] if self._base is None else [self._base.offers()]), *offer_lists]
        if len(offer_lists) == 1:
            return offer_lists[0]
        if len(former) != len(offer_lists) or any(
            a is not b for a, b in zip(former, offer_lists, strict=True)
        ):
            merged = {topic: offer for offers in offer_lists for topic, offer in offers.items()}
            self._offers = offer_lists, merged
            self._doubled = self._both_ways()
        return merged

    def now_ns(self) -> int:
        """ROS time."""
        clock = self._clock
        return time.time_ns() if clock is None else clock.now_ns()

    def clock_messages(self) -> int | None:
        """Return the number of messages that set ROS time; None while it is wall time."""
        clock = self._clock
        return None if clock is None else clock.clock_messages()

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

    def _bridge(self, member: FleetMember) -> Bridge:
        doubled = self._doubled.get(member.robot.root, ())
        return dataclasses.replace(member.bridge, doubled=doubled) if doubled else member.bridge

    def _both_ways(self) -> Mapping[str, tuple[str, ...]]:
        """Return the topics of robots that others than webviz publish in the base, too."""
        if self._base is None:
            return {}
        offers = self._base.offers().items()
        names = [name for name, o in offers if any(not is_own(p.node) for p in o.publishers)]
        topics: dict[str, tuple[str, ...]] = {}
        for member in self._members:
            own = member.offers()
            doubled = [n for n in names if n.startswith(member.robot.root) and n in own]
            topics[member.robot.root] = tuple(sorted(doubled))
        return topics

    def _member(self, robot: NamespacedRobot) -> FleetMember:
        return FleetMember(robot, self._address(robot), self.inbox, self.now_ns)

    def _address(self, robot: NamespacedRobot) -> RobotAddress:
        """Return the address of a robot's bridge or router; raises Error."""
        is_known = (robot.name, robot.connection) in self._first
        if is_zenoh(robot.connection or ""):
            domain = os.environ.get(DOMAIN, "") if robot.domain is None else str(robot.domain)
            secrets = {name: os.environ.get(name, "") for name in (USER, PASSWORD) if is_known}
            prefix = robot.key_prefix or ""
            return zenoh_address(robot.connection or "", {DOMAIN: domain, **secrets}, prefix)
        environment = headers_of(robot.name) if is_known else {}
        return address(robot.connection or "", environment=environment)

    @property
    def _clock(self) -> Source | None:
        """The source whose simulated time counts, or any; None without robots and other topics."""
        if not self._members:
            return self._base
        members: list[Source] = [member.source for member in self._members]
        sources = members if self._base is None else [self._base, *members]
        simulated = (s for s in sources if s.clock_messages() is not None)
        return next(simulated, sources[0])


def _connected(robots: Sequence[NamespacedRobot]) -> Sequence[NamespacedRobot]:
    return [robot for robot in robots if robot.connection]


def _link(robot: NamespacedRobot) -> tuple[str, str | None, int | None, str | None]:
    """Return what a robot's connection is made of."""
    return robot.root, robot.connection, robot.domain, robot.key_prefix
