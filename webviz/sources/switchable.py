"""Live topics in whose place a recording can be shown for a while."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from webviz.api.bridge import Bridge
from webviz.sources.bag.source import BagSource
from webviz.sources.graph import Graph
from webviz.sources.inbox import Inbox
from webviz.sources.rewindable import Rewindable
from webviz.sources.source import Offer, Subscription


class Switchable:
    """Live topics or a bag, as one source; the past is that of `shown`.

    While a bag is shown, live topics stay subscribed to, and are remembered. Names are resolved and
    requests sent as with live topics, of which a recording has the names.

    Args:
        live: shown first.
    """

    def __init__(self, live: Rewindable) -> None:
        self.live = live
        self.bag: BagSource | None = None
        """The recording that is shown, None for live topics."""
        self._told: Mapping[str, Subscription] = {}
        """The subscriptions of the live source while it was shown last."""

    @property
    def shown(self) -> Rewindable | BagSource:
        """The source whose messages are shown."""
        return self.bag or self.live

    def show(self, bag: BagSource) -> BagSource:
        """Show a bag, at its start, and return it; received data is discarded by the caller."""
        bag.inbox.arrived = self.live.inbox.arrived
        if self.bag is not None:
            self.bag.close()
        self.bag = bag
        self.live.inbox.divert()
        self.live.inbox.drain()
        return bag

    def leave(self) -> Rewindable:
        """Show the newest past of live topics instead of a bag; live if nothing is remembered.

        Received data is discarded by the caller.

        Returns:
            The live topics.
        """
        if self.bag is not None:
            self.bag.close()
            self.bag = None
            self.live.seek(self.live.end_ns)
        return self.live

    # The interface of webviz.sources.Source

    @property
    def inbox(self) -> Inbox:
        """The messages to show; all wake the same event."""
        return self.shown.inbox

    @property
    def graph(self) -> Graph:
        """For output, which the gate refuses while a bag is shown."""
        return self.live.graph

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, of live topics also while a bag is shown.

        Meanwhile, these are not asked to repeat what is latched.
        """
        if self.bag is None:
            self._told = subscriptions
        else:
            self.bag.want(subscriptions)
            subscriptions = {topic: self._kept(topic, w) for topic, w in subscriptions.items()}
        self.live.want(subscriptions)

    @property
    def bridges(self) -> Sequence[Bridge]:
        """Those of the live source."""
        return self.live.bridges

    def offers(self) -> Mapping[str, Offer]:
        """Return publishers and QoS by topic, of what is shown."""
        return self.shown.offers()

    def now_ns(self) -> int:
        """ROS time of what is shown."""
        return self.shown.now_ns()

    def clock_messages(self) -> int | None:
        """Return the number of /clock messages of what is shown, None while it is wall time."""
        return self.shown.clock_messages()

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic; raises ValueError."""
        try:
            return self.live.resolve(topic)
        except ValueError:
            if self.bag is None:
                raise
            return self.bag.resolve(topic)  # which may have names that ROS forbids

    def close(self) -> None:
        """Close the bag and the live source."""
        if self.bag is not None:
            self.bag.close()
        self.live.close()

    def _kept(self, topic: str, subscription: Subscription) -> Subscription:
        told = self._told.get(topic)
        return subscription if told is None else replace(subscription, asked=told.asked)
