"""Topic statistics: rates, or the reasons why messages do not arrive."""

from __future__ import annotations

import difflib
import functools
import itertools
import math
from collections import deque
from collections.abc import Mapping, Sequence

from webviz.api.declared import Topic
from webviz.api.ports import ANY, Input
from webviz.api.status import Level, Measurement, Remedy, Status
from webviz.data.transforms.reasons import in_words
from webviz.data.words import counted
from webviz.sources import Offer, Publisher, Raw

AUTOMATIC = {"reliability": "auto", "durability": "auto"}
"""Policies of a topic whose other values stay."""

MAX_TIMES = 50
"""Last messages whose times are kept. Of a bag no more are counted, as a seek skips others."""
FEWEST = 5
"""Messages that show a rate; fewer may be a burst."""


class TopicStatistics:
    """Counts the messages of one input, and explains which are missing.

    Args:
        path: of the input among the properties of the display.
        spec: the input as the display declares it; its first type is read until another one is
            published, `ANY` is none until one is.
        topic: the topic the user chose.
        name: the full name of the topic, "" if it has none.
        problem: why it has none.
    """

    def __init__(self, path: str, spec: Input, topic: Topic, name: str, problem: str) -> None:
        self.count = 0
        self.size = 0
        """Size of the newest message in bytes."""
        self.last: Raw | None = None
        self.silent_s = 0.0
        """Seconds since the last message, or else since listening began, as of the last status."""
        self._listening_s: float | None = None
        self._path = path
        self.type = spec.types[0] if spec.types[0] != ANY else ""
        self._types = spec.types
        self._is_sporadic = spec.is_sporadic
        self._reliability = topic.reliability
        self._durability = "transient_local" if spec.latched else topic.durability
        self._name = name
        self._problem = problem
        self._times: deque[float] = deque(maxlen=MAX_TIMES)
        """Times of reception of the last messages in seconds; of a bag, when they were recorded."""
        self._newest_s = 0.0
        """Time of reception of the newest message by the clock that `status` is asked with,"""
        self.first_s = math.inf
        """and when the first one did, or would have."""
        self._others: tuple[Mapping[str, Offer], str] = {}, ""

    def note(self, raw: Raw, arrived_s: float, is_latched: bool) -> None:
        """Count a message.

        The bytes of a latched one are kept, to notice when it is delivered again.

        Args:
            raw: the message.
            arrived_s: its arrival by the clock that `status` is asked with.
            is_latched: whether the publisher repeats its last message.
        """
        at_s = raw.recorded_ns / 1e9 if raw.recorded_ns else arrived_s
        first_s = arrived_s
        if (earlier := raw.earlier) is not None:
            self._times.clear()
            self._times.extend(each_ns / 1e9 for each_ns in reversed(earlier.recorded_ns))
            self.count = max(self.count, len(earlier.recorded_ns))
            first_s -= (raw.recorded_ns - earlier.first_ns) / 1e9
        self._newest_s, self.first_s = arrived_s, min(self.first_s, first_s)
        self.last = raw if is_latched else Raw(b"", raw.received_ns, raw.arrived_s)
        self.count += 1
        self.size = len(raw.cdr)
        self._times.append(at_s)

    def reset(self) -> None:
        """Forget all messages, such as after a jump of time."""
        self.count = 0
        self._times.clear()
        self.first_s = math.inf
        self.last = self._listening_s = None

    def status(self, offers: Mapping[str, Offer], now_ns: int, clock: float) -> Status:
        """Return the status: what is received, or why nothing is.

        Args:
            offers: all topics.
            now_ns: ROS time.
            clock: monotonic time in seconds.
        """
        if not self._name:
            return Status(Level.ERROR, self._problem)
        offer = offers.get(self._name)
        if offer is None or offer.requested is None:
            self._listening_s = None
        elif self._listening_s is None:
            self._listening_s = clock
        began_s = clock if self._listening_s is None else self._listening_s
        self.silent_s = clock - (self._newest_s if self._times else began_s)
        if offer and offer.problem:
            return Status(Level.ERROR, f"{self._name}: {offer.problem}")
        if offer and offer.type not in ("", self.type):
            return Status(
                Level.ERROR,
                f"Another display reads {self._name} as {offer.type}, this one shows "
                f"{self.type}. A topic has only one type: change one of the displays.",
            )
        publishers = offer.publishers if offer else ()
        matching = [p for p in publishers if p.type == self.type]
        if publishers and not matching:
            other = self._nearest(offers)
            return Status(
                Level.ERROR,
                f"{self._name} has the type {publishers[0].type}, this display shows "
                f"{' or '.join(self._types)}. Choose another topic or another display.",
                self._choose(other) if other else None,
            )
        if not publishers:
            return self._no_publisher(offers, clock)
        if refusal := self._refusal(offer, matching):
            return Status(Level.ERROR, refusal, self._automatic())
        who = ", ".join(sorted(map(_described, matching)))
        if not self.count:
            when = f": {offer.begins}" if offer and offer.begins else f" from {who}"
            return Status(Level.WARN, f"No message yet on {self._name}{when}.")
        age, rate = clock - self._newest_s if self._times else 0.0, self.rate()
        # While simulated time is paused, silence is not a problem.
        silence = min(age, (now_ns - self.last.received_ns) / 1e9) if self.last else 0.0
        if rate and not self._is_sporadic and silence > max(2.0, 5.0 * self._longest_gap()):
            text = f"No message for {_age(age)} on {self._name}, previously at {rate:.1f} Hz; "
            return Status(Level.WARN, f"{text}from {who}.", values=self._values(age))
        pace = f" at {rate:.1f} Hz" if rate else ""
        is_many = offer is not None and offer.is_recorded and self.count > MAX_TIMES
        count = f"More than {MAX_TIMES} messages" if is_many else counted(self.count, "message")
        text = f"{count}{pace}, the newest {age:.1f} s ago, from {who}."
        return Status(Level.OK, text, values=self._values(age))

    def _no_publisher(self, offers: Mapping[str, Offer], clock: float) -> Status:
        if self.count:
            age = clock - self._newest_s if self._times else 0.0
            text = f"No publisher on {self._name} any more, last message {_age(age)} ago."
            return Status(Level.WARN, f"{text} Restart it.", values=self._values(age))
        if other := self._nearest(offers):
            text = f"No publisher on {self._name}. Choose {other}, the nearest topic of its type."
            return Status(Level.WARN, text, self._choose(other))
        text = (
            f"No publisher on {self._name}. Start the node that publishes it or choose another "
            "topic."
        )
        if any(offer.is_recorded for offer in offers.values()):
            text = f"The bag has no topic {self._name}. Choose another topic."
        return Status(Level.WARN, text)

    def _values(self, age: float) -> tuple[Measurement, ...]:
        return (
            Measurement("messages", self.count),
            Measurement("rate", round(self.rate(), 1), "Hz"),
            Measurement("age", round(age, 1), "s"),
        )

    def _choose(self, topic: str) -> Remedy:
        return Remedy(f"{self._path}.name", topic, f"Use {topic}")

    def _automatic(self) -> Remedy:
        return Remedy(self._path, AUTOMATIC, "Set QoS to automatic")

    def _nearest(self, offers: Mapping[str, Offer]) -> str:
        """Return the topic of this type whose name is most like this one's, "" if there is none."""
        if offers is not self._others[0]:  # else nothing has changed
            others = (
                topic
                for topic, offer in offers.items()
                if any(p.type in self._types for p in offer.publishers)
            )
            alike = difflib.SequenceMatcher(b=self._name)
            self._others = (
                offers,
                max(sorted(others), key=functools.partial(_ratio, alike), default=""),
            )
        return self._others[1]

    def _refusal(self, offer: Offer | None, publishers: Sequence[Publisher]) -> str:
        """Return why DDS matches no publisher of the right type with the QoS of this input.

        Another display may read the topic with a QoS that matches.
        """
        if offer is None or offer.requested is None or offer.is_recorded:
            return ""
        if any(_is_match(self._reliability, self._durability, each) for each in publishers):
            return ""
        reliability, durability = offer.requested
        ours = _words(
            reliability if self._reliability == "auto" else self._reliability,
            durability if self._durability == "auto" else self._durability,
        )
        theirs = _words(publishers[0].reliability, publishers[0].durability)
        text = (
            f"QoS does not match on {self._name}: this display requests {ours}, "
            f"the publisher offers {theirs}. Set reliability and durability to auto."
        )
        if any(_is_match(*offer.requested, each) for each in publishers):
            text += " Messages arrive only because another display reads the topic."
        return text

    def rate(self) -> float:
        """Messages per second over the last ones, 0 if unknown."""
        span = self._times[-1] - self._times[0] if len(self._times) >= FEWEST else 0.0
        return (len(self._times) - 1) / span if span > 0 else 0.0

    def _longest_gap(self) -> float:
        """Seconds between two of the last messages."""
        return max(after - before for before, after in itertools.pairwise(self._times))


def _is_match(reliability: str, durability: str, publisher: Publisher) -> bool:
    """Return whether DDS connects a request with an offer; "auto" follows the publisher.

    A bridge subscribes with a QoS that matches.
    """
    if not publisher.is_qos_known:
        return True
    unreliable = reliability == "reliable" and publisher.reliability == "best_effort"
    forgetful = durability == "transient_local" and publisher.durability == "volatile"
    return not unreliable and not forgetful


def _described(publisher: Publisher) -> str:
    """Return a publisher with its QoS, in words."""
    if not publisher.is_qos_known:
        return f"{publisher.label} (QoS unknown)" if publisher.node else publisher.label
    return f"{publisher.label} ({_words(publisher.reliability, publisher.durability)})"


def _age(seconds: float) -> str:
    return in_words(round(seconds * 1e9))


def _words(reliability: str, durability: str) -> str:
    return f"{reliability}, {durability}".replace("_", " ")


def _ratio(alike: difflib.SequenceMatcher[str], other: str) -> float:
    alike.set_seq1(other)
    return alike.ratio()
