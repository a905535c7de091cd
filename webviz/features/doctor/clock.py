"""Looks of the doctor at simulated time: at /clock and joint states, and at who follows it."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from concurrent.futures import Future
from contextlib import suppress
from typing import Any

from webviz.api.declared import Topic
from webviz.api.observation import NO_OFFER, ClockSeen
from webviz.data.messages import MessageError, decode, encode, interfaces
from webviz.engine.parts.part import Batches, PartContext
from webviz.sources import RestrictedGraph, Subscriber, Subscription

CLOCK, TYPE = "/clock", "rosgraph_msgs/msg/Clock"
JOINT_STATE = "sensor_msgs/msg/JointState"
MAX_TOPICS = 5
"""Largest number of topics of joint states."""


class ClockWatch:
    """Measures whether simulated time moves, also of a viewer that does not follow it.

    It keeps the newest joint states, too, of which a robot by its transforms reads none.

    Args:
        context: shared by all parts.
    """

    def __init__(self, context: PartContext) -> None:
        self._context = context
        self.is_wanted = False
        """True to subscribe; a simulator may send a thousand messages per second."""
        self._subscriber = Subscriber()
        self._began_s: float | None = None
        self._moved_s = 0.0
        self._time_ns: int | None = None
        self.joint_states: dict[str, Any] = {}
        """The newest message of each topic."""

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return that of /clock and of joint states, if they are wanted and published."""
        if not self.is_wanted:
            self._began_s = self._time_ns = None
            self.joint_states.clear()
            return {}
        subscriptions = self._joint_topics()
        if self._has_clock():
            subscriptions[CLOCK] = Subscription(TYPE, Topic(CLOCK))
        return self._subscriber.subscribe(subscriptions)

    def _joint_topics(self) -> dict[str, Subscription]:
        topics = [
            topic
            for topic, offer in self._context.offers.items()
            if any(each.type == JOINT_STATE for each in offer.publishers)
        ]
        return {topic: Subscription(JOINT_STATE, Topic(topic)) for topic in topics[:MAX_TOPICS]}

    def _has_clock(self) -> bool:
        """Return whether /clock is published, and note when webviz subscribed to it."""
        offer = self._context.offers.get(CLOCK, NO_OFFER)
        is_published = any(each.type == TYPE for each in offer.publishers)
        if not is_published or offer.is_recorded:
            self._began_s = self._time_ns = None
            return False
        if self._began_s is None and offer.requested is not None:
            self._began_s = self._moved_s = self._context.clock()
        return True

    def take(self, batches: Batches) -> None:
        """Take the newest time, and the newest joint states."""
        for topic in self._joint_topics() if self.is_wanted else ():
            if raws := [*batches.get(topic, ())]:
                with suppress(MessageError):
                    self.joint_states[topic] = decode(JOINT_STATE, raws[-1].cdr)
        if self._began_s is None:
            return
        for raw in batches.get(CLOCK, ()):
            try:
                clock = decode(TYPE, raw.cdr).clock
            except MessageError:
                continue
            time_ns = clock.sec * 1_000_000_000 + clock.nanosec
            if time_ns != self._time_ns:
                self._time_ns, self._moved_s = time_ns, self._context.clock()

    def observation(self) -> ClockSeen | None:
        """Return what is known of /clock, None while it is not looked at."""
        if self._began_s is None:
            return None
        return ClockSeen(self._time_ns, self._context.clock() - self._moved_s)


SERVICE = "rcl_interfaces/srv/GetParameters"
PARAMETER = "use_sim_time"
BOOL = 1
"""Constant of rcl_interfaces/msg/ParameterType."""
AGAIN_S = 10.0
"""Time after which an answer is asked for again."""
PATIENCE_S = 3.0
MOST = 20
"""Nodes that are asked."""


class SimTime:
    """Asks nodes whether they follow simulated time.

    Args:
        graph: with the nodes.
    """

    def __init__(self, graph: RestrictedGraph) -> None:
        self._graph = graph
        self._requests: dict[str, tuple[float, Future[bytes]]] = {}
        """Answers by node, with the monotonic time in seconds."""

    def ask(self, nodes: Iterable[str]) -> Mapping[str, bool]:
        """Ask nodes by their full names; return what those that have answered follow."""
        names = [*dict.fromkeys(nodes)][:MOST]
        now = time.monotonic()
        before, self._requests = self._requests, {}
        for node in names:
            at_s, answer = before.get(node, (-AGAIN_S, Future[bytes]()))
            if now - at_s >= AGAIN_S:
                request = encode(interfaces.service(SERVICE).request, {"names": [PARAMETER]})
                at_s = now
                answer = self._graph.query(f"{node}/get_parameters", SERVICE, request, PATIENCE_S)
            self._requests[node] = at_s, answer
        read = {node: _read(answer) for node, (_, answer) in self._requests.items()}
        return {node: follows for node, follows in read.items() if follows is not None}


def _read(answer: Future[bytes]) -> bool | None:
    """Return an answer, None while it is awaited or without one."""
    if not answer.done() or answer.cancelled() or answer.exception() is not None:
        return None
    try:
        values = decode(interfaces.service(SERVICE).response, answer.result()).values
    except MessageError:
        return None
    return bool(values[0].bool_value) if len(values) == 1 and values[0].type == BOOL else None
