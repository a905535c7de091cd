"""How the messages of a topic arrive, or why they do not."""

from __future__ import annotations

import difflib
import functools
from collections import deque
from collections.abc import Mapping, Sequence

from webviz.api.ports import ANY
from webviz.api.status import Level, Remedy, Status
from webviz.engine.sources import Offer, Publisher, Raw

AUTOMATIC = {"reliability": "auto", "durability": "auto"}
"""Of a topic, whose other values stay."""


class Reception:
    """Counts the messages of one input, and explains which are missing.

    Args:
        path: of the input among the properties of the display.
        types: of the messages that the display reads; the first until another one is published.
            `ANY` is none until one is.
        name: the full name of the topic, "" if it has none.
        problem: why it has none.
    """

    def __init__(self, path: str, types: tuple[str, ...], name: str, problem: str) -> None:
        self.count = 0
        self.last: Raw | None = None
        self._path = path
        self.type = types[0] if types[0] != ANY else ""
        self._types = types
        self._name = name
        self._problem = problem
        self._times: deque[float] = deque(maxlen=50)
        self._others: tuple[Mapping[str, Offer], str] = {}, ""

    def note(self, raw: Raw, clock: float) -> None:
        """Count a message."""
        self.last = raw
        self.count += 1
        self._times.append(clock)

    def reset(self) -> None:
        """Forget the times of messages, such as after a jump of time."""
        self._times.clear()
        self.last = None

    def status(self, offers: Mapping[str, Offer], now_ns: int, clock: float) -> Status:
        """What is received, or why nothing is.

        Args:
            offers: all topics.
            now_ns: ROS time.
            clock: monotonic time in seconds.
        """
        if not self._name:
            return Status(Level.ERROR, self._problem)
        offer = offers.get(self._name)
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
        who = ", ".join(
            sorted({f"{p.label} ({_words(p.reliability, p.durability)})" for p in matching})
        )
        if not self.count:
            return Status(Level.WARN, f"No message yet on {self._name} from {who}.")
        age, rate = clock - self._times[-1] if self._times else 0.0, self._rate()
        # While simulated time is paused, silence is not a problem.
        silence = min(age, (now_ns - self.last.received_ns) / 1e9) if self.last else 0.0
        if rate and silence > max(2.0, 5.0 / rate):
            return Status(
                Level.WARN,
                f"No message for {age:.1f} s on {self._name}, previously at {rate:.1f} Hz; "
                f"from {who}.",
            )
        pace = f" at {rate:.1f} Hz" if rate else ""
        count = f"{self.count} message{'s' if self.count != 1 else ''}"
        return Status(Level.OK, f"{count}{pace}, the newest {age:.1f} s ago, from {who}.")

    def _no_publisher(self, offers: Mapping[str, Offer], clock: float) -> Status:
        if self.count:
            age = clock - self._times[-1] if self._times else 0.0
            text = (
                f"No publisher on {self._name} any more, last message {age:.1f} s ago. Restart it."
            )
            return Status(Level.WARN, text)
        if other := self._nearest(offers):
            text = f"No publisher on {self._name}. Choose {other}, the nearest topic of its type."
            return Status(Level.WARN, text, self._choose(other))
        text = (
            f"No publisher on {self._name}. Start the node that publishes it or choose another "
            "topic."
        )
        return Status(Level.WARN, text)

    def _choose(self, topic: str) -> Remedy:
        return Remedy(f"{self._path}.name", topic, f"Use {topic}")

    def _automatic(self) -> Remedy:
        return Remedy(self._path, AUTOMATIC, "Set QoS to automatic")

    def _nearest(self, offers: Mapping[str, Offer]) -> str:
        """The topic of this type whose name is most like this one's, "" if there is none."""
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
            f"QoS does not match on {self._name}: this display requests {ours}, "
            f"the publisher offers {theirs}. Set reliability and durability to auto."
        )

    def _rate(self) -> float:
        """Messages per second over the last ones, 0 if unknown."""
        span = self._times[-1] - self._times[0] if len(self._times) > 2 else 0.0
        return (len(self._times) - 1) / span if span > 0 else 0.0


def _words(reliability: str, durability: str) -> str:
    return f"{reliability}, {durability}".replace("_", " ")


def _ratio(alike: difflib.SequenceMatcher[str], other: str) -> float:
    alike.set_seq1(other)
    return alike.ratio()
