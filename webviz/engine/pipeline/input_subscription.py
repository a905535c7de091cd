"""One input of a display: from raw messages to those with a pose in the fixed frame."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any

from webviz.api.declared import Topic
from webviz.api.display import Display, inputs
from webviz.api.frames import Frames
from webviz.api.lookback import Lookback
from webviz.api.observation import InputSeen
from webviz.api.ports import ANY, Input
from webviz.api.sample import Sample
from webviz.api.status import Level, Measurement, OtherFixedFrame, Remedy, Status
from webviz.data.messages import MessageError, decode, peek_header
from webviz.data.transforms import MessageFilter, received_ns
from webviz.data.transforms.reasons import in_words
from webviz.data.words import counted, joined
from webviz.engine.pipeline.topic_statistics import TopicStatistics
from webviz.sources import Offer, Raw, Subscription

PATIENCE_S = 1.0
"""A message that waits longer for its transform gets a status; TF is often 30 ms late."""
DROPS_S = 10.0
"""Duration for which dropped messages are reported."""
STAMPS = 20
"""Last messages whose stamps are kept for checks."""
LATE_S = 0.3
"""A message drawn later than this because of its transform gets a warning."""


@dataclass(frozen=True)
class Arrival:
    """A message whose frame has a pose at its stamp, or that needs none.

    Args:
        raw: the message.
        frame: frame id, "" if it needs no pose.
        stamp_ns: of its header.
        number: of the message on its input, from 0.
        message: the decoded message if it was decoded to know how long it lasts.
        lasts_ns: how long that is.
        arrived_s: when it arrived, by the clock of ages and rates.
    """

    raw: Raw
    frame: str
    stamp_ns: int
    number: int
    message: Any = field(default=None, compare=False)
    lasts_ns: int = 0
    arrived_s: float = 0.0


class Drops:
    """Counts dropped messages from the first until none was dropped for `DROPS_S`."""

    def __init__(self) -> None:
        self._total = self._before = 0
        self._last_at = 0.0

    def recent(self, total: int, clock: float) -> int:
        """Return the number to report.

        Args:
            total: dropped so far; less than before if counting started over.
            clock: monotonic time in seconds.
        """
        if total != self._total:
            self._last_at, self._before = clock, min(self._before, total)
        elif clock - self._last_at > DROPS_S:
            self._before = total
        self._total = total
        return total - self._before


class InputSubscription:
    """Counts and filters the messages of one input, and explains what is missing.

    Args:
        path: of the input among the properties of the display.
        spec: the input as the display declares it.
        topic: the topic the user chose.
        name: the full name of the topic, "" if it has none.
        problem: why it has none.
    """

    def __init__(self, path: str, spec: Input, topic: Topic, name: str, problem: str = "") -> None:
        self.path = path
        self.spec = spec
        self.topic = topic
        self.name = name
        self.type = "" if spec.type == ANY else spec.type
        """Type of the messages: the one of `spec.types` that is published; "" of `ANY` until one
        is."""
        self._topic_statistics = TopicStatistics(path, spec, topic, name, problem)
        self._filter: MessageFilter[Arrival] = MessageFilter(topic.filter_size)
        self._fault = ""
        self._placed: Arrival | None = None
        """The newest message with a pose."""
        self._newest = self._newest_placed = -1
        self._drops = Drops()
        self._followed: Offer | None = None
        self._frame = ""
        self._stamps: deque[tuple[int, int]] = deque(maxlen=STAMPS)

    @property
    def has_received(self) -> bool:
        """Return whether any message has arrived."""
        return self._topic_statistics.count > 0

    @property
    def is_waiting(self) -> bool:
        """Return whether the newest message waits for its transform."""
        newest_placed = self._placed.number if self._placed else -1
        return len(self._filter) > 0 and self._newest > newest_placed

    def is_idle(self, offer: Offer | None) -> bool:
        """Return whether `take` has nothing to do unless messages have arrived.

        Args:
            offer: publishers and QoS of the topic.
        """
        return offer is self._followed and not self._filter and not self._filter.is_stuck

    def subscription(self, lookback: Lookback, is_placed: bool) -> Subscription:
        """Return the subscription of the topic.

        Args:
            lookback: which past messages of a recording it needs; the newest, too, for the status.
            is_placed: whether messages wait for the transform at their stamp.
        """
        newest = Lookback(count=1 + is_placed * self.topic.filter_size)
        lookbacks = (lookback,) if lookback.count else (lookback, newest)
        latched = self.spec.latched
        return Subscription(
            self.type, self.topic, latched, lookbacks=lookbacks, is_placed=is_placed
        )

    def take(
        self,
        raws: Iterable[Raw],
        frames: Frames,
        offer: Offer | None,
        clock: float,
        waits: bool,
        duration_ns: Callable[[Any], int] | None = None,
    ) -> list[Arrival]:
        """Take messages and return those that have a pose now, oldest first.

        Args:
            raws: arrived since the last call.
            frames: the transforms of this turn.
            offer: publishers and QoS of the topic.
            clock: monotonic time in seconds.
            waits: whether messages wait for the transform at their stamp.
            duration_ns: how long after its stamp a decoded message waits for transforms, too; None
                if not at all.
        """
        arrivals: list[Arrival] = []
        topic_statistics = self._topic_statistics
        if offer is not self._followed:
            self._followed = offer
            self._follow(offer)
        if offer and offer.type not in ("", self.type):
            raws = ()  # another display reads the topic as another type
        is_latched = bool(
            offer
            and offer.requested
            and offer.requested[1] == "transient_local"
            and not self.spec.every
        )
        for raw in raws:
            last = topic_statistics.last
            is_again = is_latched and last is not None and raw.cdr == last.cdr
            if is_again and last and raw.recorded_ns == last.recorded_ns:
                continue  # delivered again, by a second publisher or a new subscription
            waited_s = _waited_s(raw, frames.now_ns, offer is not None and offer.is_recorded)
            topic_statistics.note(raw, clock - waited_s, is_latched)
            if is_again:
                continue
            message, lasts_ns = None, 0
            try:
                header = peek_header(self.type, raw.cdr, raw.types)
                if header and waits and duration_ns:
                    message = decode(self.type, raw.cdr, raw.types)
                    lasts_ns = duration_ns(message)
            except MessageError as error:
                self.refuse(str(error))
                continue
            if header is None:
                arrivals.append(Arrival(raw, "", 0, topic_statistics.count - 1))
                continue
            frame, stamp_ns = header
            self._frame = frame
            self._stamps.append((stamp_ns, raw.received_ns))
            arrival = Arrival(
                raw,
                frames.named(frame),
                stamp_ns,
                topic_statistics.count - 1,
                message,
                lasts_ns,
                clock - waited_s,
            )
            if not waits:
                arrivals.append(arrival)
                continue
            self._newest = arrival.number
            size = len(raw.cdr)
            self._filter.add(arrival, arrival.frame, stamp_ns, frames.now_ns, lasts_ns, size)
        placed = self._filter.ready(frames.buffer, frames.fixed_frame, frames.now_ns)
        arrivals += placed
        if placed:
            self._placed = placed[-1]
        return arrivals

    def _follow(self, offer: Offer | None) -> None:
        """Read the topic as what is published there, if the display can."""
        published = {publisher.type for publisher in offer.publishers} if offer else set()
        readable = (self.type, *self.spec.types)
        if offer and self.spec.type == ANY:
            # As another display reads it, since a topic has only one type.
            readable = (offer.type, self.type, *sorted(published))
        type_ = next((each for each in readable if each in published), self.type)
        if type_ != self.type:
            self.type = self._topic_statistics.type = type_
            self.reset()

    def refuse(self, reason: str) -> None:
        """Note why the newest message cannot be shown."""
        self._fault = reason

    def accepted(self) -> None:
        """Note that the newest message can be shown."""
        self._fault = ""

    def reset(self) -> None:
        """Forget all messages and their statuses, such as after a jump of time."""
        self._filter.clear()
        self._topic_statistics.reset()
        self._fault = ""
        self._placed = None
        self._newest = -1
        self._stamps.clear()

    def observed(self, sample: Sample | None) -> InputSeen:
        """Return the input as the checks of the doctor see it.

        Args:
            sample: its newest message with a pose, None without one.
        """
        return InputSeen(
            path=self.path,
            topic=self.name,
            types=self.spec.types,
            qos=self.topic,
            latched=self.spec.latched,
            status="Topic" if self.path == "topic" else f"Topic ({self.path})",
            received=self._topic_statistics.count,
            size=self._topic_statistics.size,
            rate_hz=self._topic_statistics.rate(),
            silent_s=self._topic_statistics.silent_s,
            stamps=tuple(self._stamps),
            frame=self._frame,
            type=self.type,
            message=sample and sample.message,
        )

    def statuses(
        self, offers: Mapping[str, Offer], dropped: int, frames: Frames, clock: float
    ) -> dict[str, Status]:
        """Statuses of the topic, its messages and their transforms."""
        result = {}
        if self.has_received or not self.spec.optional:
            result["Topic"] = self._topic_statistics.status(offers, frames.now_ns, clock)
        if self._fault:
            result["Message"] = Status(Level.ERROR, self._fault)
        elif recent := self._drops.recent(dropped, clock):
            text = (
                f"{counted(recent, 'message')} dropped: they arrive faster than they can be read."
            )
            result["Message"] = Status(Level.WARN, text)
        if transform := self._transform_status(frames, clock):
            result["Transform"] = transform
        return result

    def _transform_status(self, frames: Frames, clock: float) -> Status | None:
        waiting = self._filter.explanation(frames.buffer, frames.fixed_frame, frames.now_ns)
        stuck, placed = self._filter.stuck_since, self._placed
        since_s = math.inf if stuck is None else stuck.arrived_s
        if placed is None:
            since_s = min(since_s, self._topic_statistics.first_s)
        is_late = clock - since_s > PATIENCE_S
        if waiting and (is_late or frames.buffer.none_recorded):
            size, remedy = waiting.filter_size, OtherFixedFrame.of(waiting)
            if size:
                label = f"Set the filter size to {size}"
                remedy = Remedy(f"{self.path}.filter_size", size, label)
            return Status(Level.ERROR, waiting.sentence, remedy, waiting, _lag(waiting.lag_ns))
        if placed is None:
            # In a bag nothing arrives while its time stands still.
            if waiting and frames.buffer.recorded:
                level = Level.IDLE if waiting.is_catching_up else Level.WARN
                lag = _lag(waiting.lag_ns)
                return Status(level, waiting.sentence, reason=waiting, values=lag)
            return None
        ready_ns = 0
        if placed.stamp_ns:
            end_ns = placed.stamp_ns + placed.lasts_ns
            ready_ns = received_ns(frames.buffer, frames.fixed_frame, placed.frame, end_ns)
        late = ready_ns - placed.raw.received_ns
        if late > LATE_S * 1e9 and frames.now_ns - ready_ns < PATIENCE_S * 1e9:
            text = f"Drawn {in_words(late)} late: the transforms arrive that long after the data."
            text = joined(text, waiting.sentence) if waiting else text
            return Status(Level.WARN, text, reason=waiting, values=_lag(late))
        return Status(Level.OK, "Transform OK")


def _lag(lag_ns: int) -> tuple[Measurement, ...]:
    """Return how far the transforms are behind the data."""
    return (Measurement("lag", round(lag_ns / 1e9, 3), "s"),) if lag_ns else ()


def input_subscriptions_of(
    display: Display, resolve: Callable[[str], str]
) -> dict[str, InputSubscription]:
    """Return the subscriptions of a display by input.

    Args:
        display: has the topics.
        resolve: the full name of a topic; raises ValueError.
    """
    result: dict[str, InputSubscription] = {}
    for name, spec, topic in inputs(display):
        full, problem = "", ""
        first = next(iter(result.values()), None)
        written = topic.name or (spec.named_after(first.name) if first else "")
        try:
            full = resolve(written) if written else ""
            problem = "" if full else "No topic. Choose one."
        except ValueError as error:
            problem = str(error)
        result[name] = InputSubscription(name, spec, topic, full, problem)
    return result


def _waited_s(raw: Raw, now_ns: int, is_recorded: bool) -> float:
    """Return how long ago a message arrived, such as before a pause.

    That of a recording is due at its time, whenever it is read.
    """
    return (now_ns - raw.received_ns) / 1e9 if is_recorded else time.monotonic() - raw.arrived_s
