"""What arrives: time, transforms, and the messages of topics."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping

from webviz.api.status import Status
from webviz.data.transforms import TransformBuffer
from webviz.engine.pipeline.guard import Guard
from webviz.engine.pipeline.listener import TransformListener
from webviz.engine.pipeline.ros_time import RosTime
from webviz.engine.pipeline.topic_monitor import TopicMonitor
from webviz.engine.sources import Offer, Raw, Source, Subscription

Batches = Mapping[str, Iterable[Raw]]
"""Messages by topic, oldest first."""


class Hearing:
    """Takes what a source has, and notices when time or the transforms start over.

    Args:
        source: where messages come from.
        buffer: of transforms, to fill.
        guard: for all calls.
        clock: monotonic time in seconds.
    """

    def __init__(
        self, source: Source, buffer: TransformBuffer, guard: Guard, clock: Callable[[], float]
    ) -> None:
        self.now_ns = 0
        """ROS time of the turn."""
        self.offers: Mapping[str, Offer] = {}
        """What is known of every topic."""
        self.monitor = TopicMonitor(source.inbox, clock)
        self._source = source
        self._guard = guard
        self._time = RosTime(clock)
        self._listener = TransformListener(buffer, clock)

    def take(self, is_paused: bool) -> tuple[Batches, bool]:
        """Take what arrived since the last turn.

        Args:
            is_paused: messages wait in the inbox, which is bounded and counts what gives way.

        Returns:
            The messages, and whether everything that is older has to be forgotten.
        """
        attempt = self._guard.attempt
        batches: Batches = {}
        self.now_ns = attempt("Source", self.now_ns, self._source.now_ns)
        self.offers = attempt("Source", self.offers, self._source.offers)
        if not is_paused:
            batches = attempt("Source", batches, self._source.inbox.drain)
        if is_over := attempt("Time", False, self._time.step, self.now_ns):
            # What arrived with it may be older or newer; what is latched is asked for again.
            batches = {}
            self.reset()
        if attempt("Transforms", False, self._listener.take, batches, self.offers):
            self._time.tell("The transforms started over in the past: everything was reset.")
            self.reset()
            is_over = True
        attempt("Topics", None, self.monitor.take, batches)
        return batches, is_over

    def reset(self) -> None:
        """Forget the moving transforms."""
        self._guard("Transforms", self._listener.reset)

    def subscriptions(self) -> dict[str, Subscription]:
        """What transforms need to hear by topic."""
        return self._guard.attempt("Transforms", {}, self._listener.subscriptions)

    def inspected(self) -> dict[str, Subscription]:
        """What somebody looks into, by topic."""
        return self._guard.attempt("Topics", {}, self.monitor.subscription, self.offers)

    def want(self, wanted: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, by topic."""
        self._guard("Source", self._source.want, wanted)

    def statuses(self, shown_ns: int) -> dict[str, Status]:
        """What is wrong with time and transforms, by key."""
        attempt = self._guard.attempt
        time_status = attempt("Time", None, self._time.status, self.offers)
        found = {"Time": time_status} if time_status else {}
        return found | attempt("Transforms", {}, self._listener.statuses, self.offers, shown_ns)
