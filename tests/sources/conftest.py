"""A bag as the frame loop meets it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path

import pytest

from webviz.api.declared import Topic
from webviz.data.messages import decode
from webviz.sources import Subscription
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

STRING = "std_msgs/msg/String"


class PlayedBag:
    """Plays a bag, and notes what arrives."""

    def __init__(self, source: Player) -> None:
        self.source = source

    def want(self, *topics: str, type_name: str = STRING, resubscriptions: int = 0) -> None:
        self.source.want(
            {
                name: Subscription(type_name, Topic(name), resubscriptions=resubscriptions)
                for name in topics
            }
        )

    def play(self, to_s: float) -> None:
        """Play to so many seconds from the start."""
        until_ns = self.source.history.start_ns + round(to_s * 1e9)
        while self.source.reached_ns < until_ns:
            self.source.play_until(until_ns)

    def texts(self, topic: str = "/words", type_name: str = STRING) -> Sequence[str]:
        """The strings that arrived since the last call."""
        arrived = self.source.inbox.drain().get(topic, ())
        return [decode(type_name, raw.cdr, raw.types).data for raw in arrived]

    def words_until(self, to_s: float) -> Sequence[str]:
        """The strings of /words up to so many seconds from the start."""
        self.want("/words")
        self.play(to_s)
        return self.texts()


@pytest.fixture
def open_bag() -> Iterator[Callable[..., PlayedBag]]:
    """Open a bag; it is closed at the end."""
    sources: list[Player] = []

    def open_bag(path: Path, *args: object, **options: object) -> PlayedBag:
        sources.append(Player(BagHistory(path, *args, **options)))  # pyright: ignore[reportArgumentType]
        return PlayedBag(sources[-1])

    yield open_bag
    for source in sources:
        source.close()
