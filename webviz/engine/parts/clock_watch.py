"""A look at /clock while the doctor asks for it."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.api.declared import Topic
from webviz.api.observation import NO_OFFER, ClockSeen
from webviz.data.messages import MessageError, decode
from webviz.engine.parts.part import Batches, Core, Part
from webviz.sources import Subscriber, Subscription

CLOCK, TYPE = "/clock", "rosgraph_msgs/msg/Clock"


class ClockWatchPart(Part):
    """Measures whether simulated time moves, also of a viewer that does not follow it.

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

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return that of /clock, if it is wanted and published."""
        offer = self.core.offers.get(CLOCK, NO_OFFER)
        is_published = any(each.type == TYPE for each in offer.publishers)
        if not self.is_wanted or not is_published or offer.is_recorded:
            self._began_s = self._time_ns = None
            return {}
        if self._began_s is None and offer.requested is not None:
            self._began_s = self._moved_s = self.core.clock()
        return self._subscriber.subscribe({CLOCK: Subscription(TYPE, Topic(CLOCK))})

    def take(self, batches: Batches) -> None:
        """Take the newest time."""
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
