"""Rules: the numbers in messages that they are about, and whether they hold."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator, Mapping, Sequence

from webviz.api.declared import Topic
from webviz.api.finding import Severity
from webviz.api.observation import DisplaySeen, InputSeen, Observation
from webviz.api.rule import DOCTOR, Rule, Verdict
from webviz.api.status import worst
from webviz.engine.parts.part import Batches, PartContext
from webviz.engine.path_numbers import PathNumbers
from webviz.sources import Subscriber, Subscription

MAX_KEPT = 1000
"""Numbers of a path between two rounds of the doctor; of more, the last count."""


class RuleNumbers:
    """Reads the message paths of rules.

    Args:
        context: shared by all parts.
    """

    def __init__(self, context: PartContext) -> None:
        self._context = context
        self._read: dict[str, PathNumbers] = {}
        self._numbers: dict[str, deque[float]] = {}
        self._types: dict[str, str] = {}
        """The type of each topic, as it is read."""
        self._subscriber = Subscriber()

    def subscriptions(self, rules: Iterable[Rule]) -> Mapping[str, Subscription]:
        """Return the topics of the paths of rules, as the first type of each."""
        paths = {rule.path for rule in rules if rule.path}
        if self._read.keys() != paths:
            self._read = {text: self._read.get(text) or PathNumbers(text) for text in paths}
            self._numbers = {text: self._numbers.get(text) or _empty() for text in paths}
        topics = dict(self._topics())
        self._types = {
            topic: offer.type or offer.publishers[0].type
            for topic in topics.values()
            if (offer := self._context.offers.get(topic)) and offer.publishers
        }
        return self._subscriber.subscribe(
            {topic: Subscription(type_, Topic(topic)) for topic, type_ in self._types.items()}
        )

    def take(self, batches: Batches) -> None:
        """Read the numbers of the messages."""
        for text, topic in self._topics():
            if topic in batches and topic in self._types:
                self._read[text].read(self._types[topic], list(batches[topic]))
                self._numbers[text].extend(self._read[text].numbers)

    def reset(self) -> None:
        """Forget all numbers."""
        self._read = {text: PathNumbers(text) for text in self._read}
        self._numbers = {text: _empty() for text in self._numbers}

    def numbers(self) -> Mapping[str, Sequence[float]]:
        """Return the numbers by path since the last call; without a message, the newest again."""
        numbers = {text: tuple(values) for text, values in self._numbers.items() if values}
        self._numbers = {
            text: deque(list(values)[-1:], MAX_KEPT) for text, values in self._numbers.items()
        }
        return numbers

    def _topics(self) -> Iterator[tuple[str, str]]:
        """Yield each path and the full name of its topic."""
        for text, each in self._read.items():
            try:
                yield text, self._context.player.resolve(each.path.topic)
            except ValueError:  # no name of a topic
                continue


def _empty() -> deque[float]:
    return deque(maxlen=MAX_KEPT)


NS_PER_S = 1e9


class RuleEvaluator:
    """Evaluates rules; a violation lasts from the first moment at which it was seen."""

    def __init__(self) -> None:
        self._since: dict[str, int] = {}

    def evaluate(self, rules: Iterable[Rule], observation: Observation) -> Sequence[Verdict]:
        """Evaluate rules at the moment of an observation, which must not be before the last one."""
        before, self._since = self._since, {}
        verdicts: list[Verdict] = []
        for rule in rules:
            value = value_of(rule, observation)
            lasting_s = 0.0
            if value is not None and not rule.holds(value):
                now_ns = observation.now_ns
                since = min(before.get(rule.text, now_ns), now_ns)  # time may have jumped back
                self._since[rule.text] = since
                lasting_s = (now_ns - since) / NS_PER_S
            verdicts.append(Verdict(rule, value, lasting_s))
        return verdicts


def value_of(rule: Rule, observation: Observation) -> float | None:
    """Return the value that a rule is about, None while it is unknown."""
    if rule.path:
        return _of_path(rule, observation.numbers.get(rule.path, ()))
    if rule.subject == DOCTOR:
        least = Severity.ERROR if rule.value == "errors" else Severity.WARNING
        return float(sum(finding.severity >= least for finding in observation.findings))
    for display in observation.displays:
        for each in display.inputs:
            if rule.subject == each.topic:
                return _of_input(rule.value, display, each, observation)
    display = next(
        (each for each in observation.displays if each.display.name == rule.subject), None
    )
    return _of_display(rule.value, display, observation) if display else None


def _of_path(rule: Rule, numbers: Sequence[float]) -> float | None:
    """Return the first number that violates a rule, else the newest.

    With a duration the newest counts, since the violation must last.
    """
    if not numbers:
        return None
    violating = () if rule.seconds else (each for each in numbers if not rule.holds(each))
    return next(iter(violating), numbers[-1])


def _of_display(value: str, display: DisplaySeen, observation: Observation) -> float | None:
    if value == "status":
        return float(max(0, worst(display.statuses.values())))
    if value == "walls":
        return display.fit.fit.share if display.fit else None
    if value == "blocked":
        return float(display.blocked)
    return next((_of_input(value, display, each, observation) for each in display.inputs), None)


def _of_input(
    value: str, display: DisplaySeen, each: InputSeen, observation: Observation
) -> float | None:
    stamp_ns, received_ns = each.stamps[-1] if each.stamps else (0, 0)
    if value == "status":
        status = display.statuses.get(each.status)
        return float(max(0, status.level)) if status else None
    if value == "rate" and each.rate_hz:
        waited_s = (observation.now_ns - received_ns) / NS_PER_S if received_ns else 0.0
        return min(each.rate_hz, 1.0 / max(waited_s, 1.0 / each.rate_hz))
    if value not in ("age", "delay") or not stamp_ns:
        return None
    return ((observation.now_ns if value == "age" else received_ns) - stamp_ns) / NS_PER_S
