"""Output to the robots of a fleet: each message and call goes over the right connection."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import Future, InvalidStateError

from msgspec.structs import replace

from webviz.api.robots import robot_of
from webviz.sources.fleet.member import FleetMember
from webviz.sources.graph import Advertisement, Goal, Graph, ReadOnly


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
        sent = member.sent(advertisement.type, cdr)
        return member.source.graph.publish(_renamed(advertisement, member), sent)

    def call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        """Call a service of the robot that offers it."""
        member = self._member(service)
        if member is None:
            return self._base.call(service, type, request, timeout_s)
        return member.source.graph.call(member.inner(service), type, request, timeout_s)

    def send_goal(
        self, action: str, type: str, goal: bytes, feedback: Callable[[bytes], object]
    ) -> Goal:
        """Send a goal; bridges refuse it."""
        member = self._member(action)
        if member is None:
            return self._base.send_goal(action, type, goal, feedback)
        return member.source.graph.send_goal(member.inner(action), type, goal, feedback)

    def nodes(self) -> tuple[str, ...]:
        """Full names of the nodes of all graphs, sorted."""
        found = [*self._base.nodes()]
        for member in self._members:
            found += member.nodes()
        return tuple(sorted(found))

    def services(self) -> Mapping[str, str]:
        """Types of the services of the base; bridges are only asked for what is called."""
        return self._base.services()

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
    done: Future[None] = Future()

    def look(future: Future[None]) -> None:
        # Connections have threads of their own: the last two may see at once that all are done.
        with contextlib.suppress(InvalidStateError):
            if error := future.exception():
                done.set_exception(error)
            elif all(each.done() for each in futures):
                done.set_result(None)

    for future in futures:
        future.add_done_callback(look)
    return done
