"""Live topics in whose place a recording can be shown for a while."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

from webviz.api.bridge import Bridge
from webviz.sources.bag.source import BagSource
from webviz.sources.graph import Graph
from webviz.sources.inbox import Inbox
from webviz.sources.past_state import Event
from webviz.sources.rewindable import Rewindable
from webviz.sources.source import Offer, Subscription


class Switchable:
    """Live topics or a bag, as one source with a past.

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

    def show(self, bag: BagSource) -> None:
        """Show a bag, at its start; received data is discarded by the caller."""
        bag.inbox.arrived = self.live.inbox.arrived
        if self.bag is not None:
            self.bag.close()
        self.bag = bag
        self.live.inbox.divert()
        self.live.inbox.drain()

    def leave(self) -> None:
        """Show the newest past of live topics instead of a bag; live if nothing is remembered.

        Received data is discarded by the caller.
        """
        if self.bag is not None:
            self.bag.close()
            self.bag = None
            self.live.seek(self.live.end_ns)

    # The interface of webviz.engine.playback.Playable

    @property
    def absence(self) -> str:
        """Return why there is no past, "" if there is one."""
        return self.shown.absence

    @property
    def is_live(self) -> bool:
        """Return whether what arrives is shown."""
        return self.shown.is_live

    @property
    def origin_ns(self) -> int:
        """`Playable.origin_ns`."""
        return self.shown.origin_ns

    @property
    def start_ns(self) -> int:
        """`Playable.start_ns`."""
        return self.shown.start_ns

    @property
    def end_ns(self) -> int:
        """`Playable.end_ns`."""
        return self.shown.end_ns

    @property
    def gap_ns(self) -> tuple[int, int] | None:
        """`Playable.gap_ns`."""
        return self.shown.gap_ns

    @property
    def position_ns(self) -> int:
        """`Playable.position_ns`."""
        return self.shown.position_ns

    @property
    def names(self) -> Sequence[str]:
        """`Playable.names`."""
        return self.shown.names

    @property
    def warnings(self) -> Sequence[str]:
        """`Playable.warnings`."""
        return self.shown.warnings

    def play(self, until_ns: int) -> None:
        """`Playable.play`."""
        self.shown.play(until_ns)

    def play_step(self, until_ns: int) -> None:
        """`Playable.play_step`."""
        self.shown.play_step(until_ns)

    def seek(self, at_ns: int) -> None:
        """`Playable.seek`."""
        self.shown.seek(at_ns)

    def rejoin(self) -> bool:
        """`Playable.rejoin`."""
        return self.shown.rejoin()

    def neighbour(self, topic: str, is_forward: bool) -> int | None:
        """`Playable.neighbour`."""
        return self.shown.neighbour(topic, is_forward)

    def histogram(self, buckets: int) -> Mapping[str, Sequence[int]]:
        """`Playable.histogram`."""
        return self.shown.histogram(buckets)

    @property
    def counted_ns(self) -> tuple[int, int] | None:
        """`Playable.counted_ns`."""
        return self.shown.counted_ns

    def logged(self) -> Sequence[Event]:
        """`Playable.logged`."""
        return self.shown.logged()

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
        return self.live.resolve(topic)

    def close(self) -> None:
        """Close the bag and the live source."""
        if self.bag is not None:
            self.bag.close()
        self.live.close()

    def _kept(self, topic: str, subscription: Subscription) -> Subscription:
        told = self._told.get(topic)
        return subscription if told is None else replace(subscription, asked=told.asked)
