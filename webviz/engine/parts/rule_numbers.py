"""The numbers in messages that rules are about, such as `/battery.percentage > 0.2`."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator, Mapping, Sequence

from webviz.api.declared import Topic
from webviz.api.rule import Rule
from webviz.engine.parts.part import Batches, Core, Part
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.watch.path_numbers import PathNumbers
from webviz.sources import Subscriber, Subscription

MAX_KEPT = 1000
"""Numbers of a path between two rounds of the doctor; of more, the last count."""


class RuleNumbersPart(Part):
    """Reads the message paths of rules.

    Args:
        core: shared by all parts.
        settings: have the rules of the config.
        more: returns other rules.
    """

    name = "Rules"

    def __init__(
        self, core: Core, settings: SettingsPart, more: Callable[[], Sequence[Rule]]
    ) -> None:
        super().__init__(core)
        self._settings = settings
        self._more = more
        self._read: dict[str, PathNumbers] = {}
        self._kept: dict[str, deque[float]] = {}
        self._types: dict[str, str] = {}
        """The type of each topic, as it is read."""
        self._subscriber = Subscriber()

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the topics of the paths, as the first type of each."""
        conditions = [rule.condition for rule in self._settings.settings.watch]
        wanted = {rule.path for rule in [*self._more(), *conditions] if rule and rule.path}
        if self._read.keys() != wanted:
            self._read = {text: self._read.get(text) or PathNumbers(text) for text in wanted}
            self._kept = {text: self._kept.get(text) or _empty() for text in wanted}
        topics = dict(self._topics())
        self._types = {
            topic: offer.type or offer.publishers[0].type
            for topic in topics.values()
            if (offer := self.core.offers.get(topic)) and offer.publishers
        }
        return self._subscriber.subscribe(
            {topic: Subscription(type_, Topic(topic)) for topic, type_ in self._types.items()}
        )

    def take(self, batches: Batches) -> None:
        """Read the numbers of the messages."""
        for text, topic in self._topics():
            if topic in batches and topic in self._types:
                self._read[text].read(self._types[topic], list(batches[topic]))
                self._kept[text].extend(self._read[text].numbers)

    def reset(self) -> None:
        """Forget all numbers."""
        self._read = {text: PathNumbers(text) for text in self._read}
        self._kept = {text: _empty() for text in self._kept}

    def numbers(self) -> Mapping[str, Sequence[float]]:
        """Return the numbers by path since the last call; without a message, the newest again."""
        found = {text: tuple(kept) for text, kept in self._kept.items() if kept}
        self._kept = {text: deque(list(kept)[-1:], MAX_KEPT) for text, kept in self._kept.items()}
        return found

    def _topics(self) -> Iterator[tuple[str, str]]:
        """Yield each path and the full name of its topic."""
        for text, each in self._read.items():
            try:
                yield text, self.core.player.resolve(each.path.topic)
            except ValueError:  # no name of a topic
                continue


def _empty() -> deque[float]:
    return deque(maxlen=MAX_KEPT)
