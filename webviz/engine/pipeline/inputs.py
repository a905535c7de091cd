"""The inputs of one display: messages with a pose, synchronized if the display declares it."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any

from webviz.api.capabilities import SelfPlacing, Sweep, capability
from webviz.api.display import Display, Sync, inputs_of, overrides
from webviz.api.frames import Frames
from webviz.api.lookback import Lookback
from webviz.api.status import Level, Status
from webviz.data.transforms.reasons import in_words
from webviz.data.words import counted
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.pipeline.input_subscription import (
    PATIENCE_S,
    Arrival,
    InputSubscription,
    input_subscriptions_of,
)
from webviz.engine.pipeline.synchronizer import Gap, Synchronizer
from webviz.sources import Offer, Raw, Subscriber, Subscription, merged

Set = Mapping[str, Arrival]
"""Messages that are drawn together, by input, at the pose of the first; usually just one."""


class Inputs:
    """Filters and synchronizes the messages of all inputs of a display.

    Args:
        display: has the topics.
        boundary: around its hooks.
        resolve: the full name of a topic; raises ValueError.
    """

    def __init__(
        self, display: Display, boundary: ErrorBoundary, resolve: Callable[[str], str]
    ) -> None:
        self.input_subscriptions = input_subscriptions_of(display, resolve)
        self._subscriber = Subscriber()
        self._synchronizer: Synchronizer[Arrival] | None = None
        self._waiting_since: float | None = None
        self.replace(display, boundary)

    def replace(self, display: Display, boundary: ErrorBoundary) -> None:
        """Continue with another instance that has the same inputs."""
        self._display = display
        self._sweep = capability(display, Sweep)
        self._placing = capability(display, SelfPlacing)
        self._boundary = boundary

    def subscriptions(self) -> dict[str, Subscription]:
        """Return the subscriptions by topic."""
        subscriptions: dict[str, Subscription] = {}
        for name, input_subscription in self.active().items():
            if input_subscription.name and input_subscription.type:
                is_placed = self.waits(name)
                lookback = self._lookback(name, input_subscription, is_placed)
                own = input_subscription.subscription(lookback, is_placed)
                if self._placing and self._boundary("places", self._placing.places, name):
                    own = replace(own, is_placed=True)
                subscriptions = dict(merged([subscriptions, {input_subscription.name: own}]))
        return self._subscriber.subscribe(subscriptions)

    def ask(self) -> None:
        """Request latched messages again."""
        self._subscriber.ask()

    def topics(self) -> list[str]:
        """Return the full names of the topics."""
        return [input_subscription.name for input_subscription in self.input_subscriptions.values()]

    def is_waiting(self) -> bool:
        """Return whether the newest message of an input waits for its transform."""
        return any(input_subscription.is_waiting for input_subscription in self.active().values())

    def waits(self, name: str) -> bool:
        """Return whether messages of an input wait for the transform at their stamp."""
        return self._boundary("waits", self._display.waits, name) is not False

    def reset(self) -> None:
        """Discard waiting messages."""
        for input_subscription in self.input_subscriptions.values():
            input_subscription.reset()
        self.ask()
        self._synchronizer = self._waiting_since = None

    def take(
        self,
        batches: Mapping[str, Iterable[Raw]],
        frames: Frames,
        offers: Mapping[str, Offer],
        clock: float,
    ) -> list[Set]:
        """Take the messages of this turn; those that can be drawn now, in order of arrival."""
        active = self.active()
        arrived: list[tuple[str, Arrival]] = []
        duration_ns = self._duration_ns if self._sweep else None
        for name, input_subscription in active.items():
            raws = batches.get(input_subscription.name, ())
            offer = offers.get(input_subscription.name)
            if raws or not input_subscription.is_idle(offer):
                waits = self.waits(name)
                arrivals = input_subscription.take(raws, frames, offer, clock, waits, duration_ns)
                arrived += [(name, arrival) for arrival in arrivals]
        arrived.sort(key=lambda item: item[1].raw.received_ns)
        synchronizer = self._synchronizer = self._renewed(active)
        if synchronizer is None:
            return [{name: arrival} for name, arrival in arrived]
        sets: list[Set] = []
        for name, arrival in arrived:
            if name not in synchronizer.inputs:
                sets.append({name: arrival})
            elif matched := synchronizer.add(name, arrival.stamp_ns, arrival):
                sets.append(matched)
                self._waiting_since = None
        if self._waiting_since is None and synchronizer.is_waiting:
            self._waiting_since = clock
        return sets

    def statuses(
        self,
        offers: Mapping[str, Offer],
        frames: Frames,
        dropped: Callable[[str], int],
        clock: float,
    ) -> dict[str, Status]:
        """Statuses of topics, messages, transforms and stamps."""
        result: dict[str, Status] = {}
        active = self.active()
        for name, input_subscription in active.items():
            if self._is_replaced(input_subscription, offers.get(input_subscription.name)):
                continue
            own_statuses = input_subscription.statuses(
                offers, dropped(input_subscription.name), frames, clock
            )
            title = "" if name == "topic" else f" ({name})"
            result |= {f"{key}{title}": status for key, status in own_statuses.items()}
        if status := self._sync_status(clock):
            result["Sync"] = status
        return result

    def _lookback(
        self, name: str, input_subscription: InputSubscription, is_placed: bool
    ) -> Lookback:
        """Return the declared lookback of an input, and the messages that wait for others."""
        lookback = self._boundary("lookback", self._display.lookback, name)
        if not isinstance(lookback, Lookback):
            return Lookback()
        since = (
            self.input_subscriptions[lookback.since].name
            if lookback.since in self.input_subscriptions
            else ""
        )
        count, sync = lookback.count, type(self._display).sync
        if count and is_placed:
            count += input_subscription.topic.filter_size
        if count and sync and name in sync.inputs:
            count += sync.queue_size
        return replace(lookback, count=count, since=since)

    def _duration_ns(self, message: Any) -> int:
        duration_ns = self._sweep and self._boundary("duration", self._sweep.duration_ns, message)
        return duration_ns if isinstance(duration_ns, int) else 0

    def _is_replaced(self, input_subscription: InputSubscription, offer: Offer | None) -> bool:
        """Return whether an input has no publisher, but another one that serves as well has."""
        other = self.input_subscriptions.get(input_subscription.spec.unless)
        is_silent = not input_subscription.has_received and not (offer and offer.publishers)
        return is_silent and other is not None and other.has_received

    def active(self) -> dict[str, InputSubscription]:
        """Return the intakes that the display listens to, by input."""
        if not overrides(self._display, "listens"):
            return self.input_subscriptions
        listens = self._display.listens
        active = {
            name: self._boundary("listens", listens, name) for name in self.input_subscriptions
        }
        return {
            name: i for name, i in self.input_subscriptions.items() if active[name] is not False
        }

    def _renewed(self, active: Mapping[str, InputSubscription]) -> Synchronizer[Arrival] | None:
        """Return the synchronizer of the inputs that currently take part."""
        sync = type(self._display).sync
        if sync is None:
            return None
        part = [
            name
            for name in sync.inputs
            if name in active and (active[name].has_received or not active[name].spec.optional)
        ]
        if len(part) < 2:
            return None
        if self._synchronizer is not None and self._synchronizer.inputs == tuple(part):
            return self._synchronizer
        slop_ns = round(sync.slop * 1e9)
        return Synchronizer(part, slop_ns, sync.queue_size, lambda arrival: len(arrival.raw.cdr))

    def _sync_status(self, clock: float) -> Status | None:
        """Return the status on the input others wait for, unless it waits for transforms itself."""
        synchronizer, sync = self._synchronizer, type(self._display).sync
        if synchronizer is None or sync is None:
            return None
        gap, since = synchronizer.gap(), self._waiting_since
        is_late = since is not None and clock - since > PATIENCE_S
        if gap and is_late and not self.input_subscriptions[gap.missing].is_waiting:
            return Status(Level.WARN, self._waiting_for(gap, sync))
        if not synchronizer.sets:
            return None
        stamps = f"stamps within {sync.slop:g} s" if sync.slop else "equal stamps"
        sets = f"{synchronizer.sets} set{'s' if synchronizer.sets > 1 else ''}"
        text = f"{sets} of {len(synchronizer.inputs)} messages with {stamps}"
        unmatched = synchronizer.dropped
        dropped = f"; {counted(unmatched, 'unmatched message')} dropped" if unmatched else ""
        return Status(Level.OK, f"{text}{dropped}.")

    def _waiting_for(self, gap: Gap, sync: Sync) -> str:
        missing, present = self._title(gap.missing), self._title(gap.present)
        article = "an" if missing[0] in "AEIOU" else "a"
        when = f"within {sync.slop:g} s of" if sync.slop else "with the stamp of"
        text = f"Waiting for {article} {missing} {when} the {present}, {gap.stamp_ns / 1e9:.3f} s."
        if gap.off_ns is None:
            return f"{text} None has arrived. Start its publisher or choose another topic."
        size = abs(gap.off_ns)
        distance = in_words(size) if size >= 100_000 else f"{size} ns"
        side = "later" if gap.off_ns > 0 else "earlier"
        remedy = "Synchronise the clocks of" if sync.slop else "Use equal stamps in"
        return f"{text} The nearest is {distance} {side}. {remedy} their publishers."

    def _title(self, name: str) -> str:
        """Type and topic of an input."""
        type_name = inputs_of(type(self._display))[name].type.rpartition("/")[2]
        return f"{type_name} on {self.input_subscriptions[name].name or 'no topic'}"
