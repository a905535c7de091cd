"""One input of a display: from raw messages to those with a pose in the fixed frame."""

from __future__ import annotations

import difflib
import functools
import itertools
from collections import deque
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass

from webviz.api.declared import Topic
from webviz.api.display import Display, inputs
from webviz.api.frames import Frames
from webviz.api.ports import Input
from webviz.api.status import Level, Remedy, Status
from webviz.data.messages import MessageError, peek_header
from webviz.data.transforms import MessageFilter
from webviz.data.words import counted
from webviz.engine.sources import Offer, Publisher, Raw, Subscription

PATIENCE_S = 1.0
"""A message that waits longer for its transform gets a status; TF is often 30 ms late."""
LATE_S = 0.3
"""A message drawn later than this because of its transform gets a warning."""


_ASKED = itertools.count(1)
"""Every new or reset intake requests latched messages."""


@dataclass(frozen=True)
class Arrival:
    """A message whose frame has a pose at its stamp, or that needs none."""

    raw: Raw
    frame: str
    stamp_ns: int
    number: int


class Intake:
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
        self._problem = problem
        self._filter: MessageFilter[Arrival] = MessageFilter(topic.filter_size)
        self._received = 0
        self._last: Raw | None = None
        self._times: deque[float] = deque(maxlen=50)
        self._fault = ""
        self._durations: deque[int] = deque(maxlen=10)
        self._placed_at = 0.0
        self._late_s = 0.0
        self._waiting_since: float | None = None
        self._asked = next(_ASKED)
        self._newest = self._newest_placed = -1
        self._others: tuple[Mapping[str, Offer], str] = {}, ""

    @property
    def has_received(self) -> bool:
        """Whether any message has arrived."""
        return self._received > 0

    @property
    def is_waiting(self) -> bool:
        """Whether the newest message waits for its transform."""
        return len(self._filter) > 0 and self._newest > self._newest_placed

    def subscription(self) -> Subscription:
        """The subscription of the topic."""
        return Subscription(self.spec.type, self.topic, self.spec.latched, self._asked)

    def take(
        self, raws: Iterable[Raw], frames: Frames, offer: Offer | None, clock: float, waits: bool
    ) -> list[Arrival]:
        """Take messages and return those that have a pose now, oldest first.

        Args:
            raws: arrived since the last call.
            frames: the transforms of this turn.
            offer: publishers and QoS of the topic.
            clock: monotonic time in seconds.
            waits: whether messages wait for the transform at their stamp.
        """
        arrivals: list[Arrival] = []
        first_new = self._received
        if offer and offer.type not in ("", self.spec.type):
            raws = ()  # another display reads the topic as another type
        is_latched = bool(offer and offer.requested and offer.requested[1] == "transient_local")
        for raw in raws:
            if is_latched and self._last is not None and raw.cdr == self._last.cdr:
                continue  # delivered again, by a second publisher or a new subscription
            self._last = raw
            self._received += 1
            self._times.append(clock)
            try:
                header = peek_header(self.spec.type, raw.cdr)
            except MessageError as error:
                self.refuse(str(error))
                continue
            if header is None:
                arrivals.append(Arrival(raw, "", 0, self._received - 1))
                continue
            frame, stamp_ns = header
            arrival = Arrival(raw, frame.removeprefix("/"), stamp_ns, self._received - 1)
            if not waits:
                arrivals.append(arrival)
                continue
            self._newest = arrival.number
            self._filter.add(arrival, arrival.frame, stamp_ns, frames.now_ns, self.duration_ns)
        placed = self._filter.ready(frames.buffer, frames.fixed_frame, frames.now_ns)
        arrivals += placed
        if placed:
            self._placed_at, self._waiting_since = clock, None
            self._newest_placed = placed[-1].number
            has_waited = placed[-1].number < first_new
            waited_ns = frames.now_ns - placed[-1].raw.received_ns if has_waited else 0
            self._late_s = waited_ns / 1e9
        elif self._waiting_since is None and self._filter.is_stuck:
            self._waiting_since = clock
        return arrivals

    @property
    def duration_ns(self) -> int:
        """How long messages last after their stamp: the longest of the last ones."""
        return max(self._durations, default=0)

    def measure(self, duration_ns: int) -> None:
        """Note how long a message lasts; that of lasers varies by a tenth and more."""
        self._durations.append(duration_ns)

    def refuse(self, reason: str) -> None:
        """Note why the newest message cannot be shown."""
        self._fault = reason

    def accepted(self) -> None:
        """Note that the newest message can be shown."""
        self._fault = ""

    def reset(self) -> None:
        """Discard waiting messages, such as after a jump of time."""
        self._filter.clear()
        self._times.clear()
        self._waiting_since = self._last = None
        self._asked = next(_ASKED)

    def statuses(
        self, offers: Mapping[str, Offer], dropped: int, frames: Frames, clock: float
    ) -> dict[str, Status]:
        """Statuses of the topic, its messages and their transforms."""
        result = {}
        if self._received or not self.spec.optional:
            result["Topic"] = self._topic_status(offers, frames.now_ns, clock)
        if self._fault:
            result["Message"] = Status(Level.ERROR, self._fault)
        elif dropped:
            text = (
                f"{counted(dropped, 'message')} dropped: they arrive faster than they can be read."
            )
            result["Message"] = Status(Level.WARN, text)
        if transform := self._transform_status(frames, clock):
            result["Transform"] = transform
        return result

    def _transform_status(self, frames: Frames, clock: float) -> Status | None:
        waiting = self._filter.explanation(frames.buffer, frames.fixed_frame, frames.now_ns)
        since = self._waiting_since
        if waiting and since is not None and clock - since > PATIENCE_S:
            return Status(Level.ERROR, waiting.sentence)
        if not self._placed_at:
            return None
        if self._late_s > LATE_S and clock - self._placed_at < PATIENCE_S:
            text = (
                f"Drawn {self._late_s:.1f} s late: the transforms arrive that long after the data."
            )
            return Status(Level.WARN, f"{text} {waiting.sentence}" if waiting else text)
        return Status(Level.OK, "Transform OK")

    def _topic_status(self, offers: Mapping[str, Offer], now_ns: int, clock: float) -> Status:
        if not self.name:
            return Status(Level.ERROR, self._problem)
        offer = offers.get(self.name)
        if offer and offer.problem:
            return Status(Level.ERROR, f"{self.name}: {offer.problem}")
        if offer and offer.type not in ("", self.spec.type):
            return Status(
                Level.ERROR,
                f"Another display reads {self.name} as {offer.type}, this one shows "
                f"{self.spec.type}. A topic has only one type: change one of the displays.",
            )
        publishers = offer.publishers if offer else ()
        matching = [p for p in publishers if p.type == self.spec.type]
        if publishers and not matching:
            return Status(
                Level.ERROR,
                f"{self.name} has the type {publishers[0].type}, this display shows "
                f"{self.spec.type}. Choose another topic or another display.",
            )
        if not publishers:
            return self._no_publisher(offers, clock)
        if refusal := self._refusal(offer, matching):
            return Status(Level.ERROR, refusal)
        who = ", ".join(
            sorted({f"{p.label} ({_words(p.reliability, p.durability)})" for p in matching})
        )
        if not self._received:
            return Status(Level.WARN, f"No message yet on {self.name} from {who}.")
        age, rate = clock - self._times[-1] if self._times else 0.0, self._rate()
        # While simulated time is paused, silence is not a problem.
        silence = min(age, (now_ns - self._last.received_ns) / 1e9) if self._last else 0.0
        if rate and silence > max(2.0, 5.0 / rate):
            return Status(
                Level.WARN,
                f"No message for {age:.1f} s on {self.name}, previously at {rate:.1f} Hz; "
                f"from {who}.",
            )
        pace = f" at {rate:.1f} Hz" if rate else ""
        count = f"{self._received} message{'s' if self._received != 1 else ''}"
        return Status(Level.OK, f"{count}{pace}, the newest {age:.1f} s ago, from {who}.")

    def _no_publisher(self, offers: Mapping[str, Offer], clock: float) -> Status:
        if self._received:
            age = clock - self._times[-1] if self._times else 0.0
            text = (
                f"No publisher on {self.name} any more, last message {age:.1f} s ago. Restart it."
            )
            return Status(Level.WARN, text)
        if other := self._nearest(offers):
            text = f"No publisher on {self.name}. Choose {other}, the nearest topic of its type."
            return Status(Level.WARN, text, Remedy(f"{self.path}.name", other))
        text = (
            f"No publisher on {self.name}. Start the node that publishes it or choose another "
            "topic."
        )
        return Status(Level.WARN, text)

    def _nearest(self, offers: Mapping[str, Offer]) -> str:
        """The topic of this type whose name is most like this one's, "" if there is none."""
        if offers is not self._others[0]:  # else nothing has changed
            others = (
                topic
                for topic, offer in offers.items()
                if any(p.type == self.spec.type for p in offer.publishers)
            )
            alike = difflib.SequenceMatcher(b=self.name)
            self._others = (
                offers,
                max(sorted(others), key=functools.partial(_ratio, alike), default=""),
            )
        return self._others[1]

    def _refusal(self, offer: Offer | None, publishers: Sequence[Publisher]) -> str:
        """Why DDS matches none of the publishers, though the type fits."""
        if offer is None or offer.requested is None:
            return ""
        reliability, durability = offer.requested
        for publisher in publishers:
            unreliable = reliability == "reliable" and publisher.reliability == "best_effort"
            forgetful = durability == "transient_local" and publisher.durability == "volatile"
            if not unreliable and not forgetful:
                return ""
        ours = _words(reliability, durability)
        theirs = _words(publishers[0].reliability, publishers[0].durability)
        return (
            f"QoS does not match on {self.name}: this display requests {ours}, "
            f"the publisher offers {theirs}. Set reliability and durability to auto."
        )

    def _rate(self) -> float:
        """Messages per second over the last ones, 0 if unknown."""
        span = self._times[-1] - self._times[0] if len(self._times) > 2 else 0.0
        return (len(self._times) - 1) / span if span > 0 else 0.0


def _words(reliability: str, durability: str) -> str:
    return f"{reliability}, {durability}".replace("_", " ")


def intakes_of(display: Display, resolve: Callable[[str], str]) -> dict[str, Intake]:
    """The intakes of a display by input.

    Args:
        display: has the topics.
        resolve: the full name of a topic; raises ValueError.
    """
    result: dict[str, Intake] = {}
    for name, spec, topic in inputs(display):
        full, problem = "", ""
        first = next(iter(result.values()), None)
        wish = topic.name or (first.name + spec.suffix if first and spec.suffix else "")
        try:
            full = resolve(wish) if wish else ""
            problem = "" if full else "No topic. Choose one."
        except ValueError as error:
            problem = str(error)
        result[name] = Intake(name, spec, topic, full, problem)
    return result


def _ratio(alike: difflib.SequenceMatcher[str], other: str) -> float:
    alike.set_seq1(other)
    return alike.ratio()
