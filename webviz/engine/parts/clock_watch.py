"""A look at /clock and at joint states while the doctor asks for it."""

from __future__ import annotations

from collections.abc import Mapping
from contextlib import suppress
from typing import Any

from webviz.api.declared import Topic
from webviz.api.observation import NO_OFFER, ClockSeen
from webviz.data.messages import MessageError, decode
from webviz.engine.parts.part import Batches, Core, Part
from webviz.sources import Subscriber, Subscription

CLOCK, TYPE = "/clock", "rosgraph_msgs/msg/Clock"
JOINT_STATE = "sensor_msgs/msg/JointState"
MAX_TOPICS = 5
"""Of joint states."""


class ClockWatchPart(Part):
    """Measures whether simulated time moves, also of a viewer that does not follow it.

    It keeps the newest joint states, too, of which a robot by its transforms reads none.

    Args:
        core: shared by all parts.
    """

    name = "Clock"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
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
        wanted = self._joint_topics()
        if self._has_clock():
            wanted[CLOCK] = Subscription(TYPE, Topic(CLOCK))
        return self._subscriber.subscribe(wanted)

    def _joint_topics(self) -> dict[str, Subscription]:
        topics = [
            topic
            for topic, offer in self.core.offers.items()
            if any(each.type == JOINT_STATE for each in offer.publishers)
        ]
        return {topic: Subscription(JOINT_STATE, Topic(topic)) for topic in topics[:MAX_TOPICS]}

    def _has_clock(self) -> bool:
        """Return whether /clock is published, and note when webviz subscribed to it."""
        offer = self.core.offers.get(CLOCK, NO_OFFER)
        is_published = any(each.type == TYPE for each in offer.publishers)
        if not is_published or offer.is_recorded:
            self._began_s = self._time_ns = None
            return False
        if self._began_s is None and offer.requested is not None:
            self._began_s = self._moved_s = self.core.clock()
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
                self._time_ns, self._moved_s = time_ns, self.core.clock()

    def seen(self) -> ClockSeen | None:
        """Return what is known of /clock, None while it is not looked at."""
        if self._began_s is None:
            return None
        return ClockSeen(self._time_ns, self.core.clock() - self._moved_s)
