"""Latched messages, which late subscribers receive: recordings are incomplete without them."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Generic, TypeVar

from webviz.data.messages import MessageError, TFMessage, decode
from webviz.data.messages.transform_layout import Layouts

MOVING_TF, STATIC_TF = "tf", "tf_static"
TF = "tf2_msgs/msg/TFMessage"
MAX_LATCHED = 1000
"""Messages of one topic."""

T = TypeVar("T")


class LatchedMessages(Generic[T]):
    """The newest latched messages of each topic, one per publisher.

    Recordings do not say which publisher sent a message. Each publisher of transforms has frames of
    its own; other messages are distinguished by their bytes, one for each publisher at most.
    """

    def __init__(self) -> None:
        self._topics: dict[str, dict[object, T]] = {}
        self._layouts = Layouts()

    def __len__(self) -> int:
        return sum(len(own) for own in self._topics.values())

    def __iter__(self) -> Iterator[tuple[str, T]]:
        """Topics and messages; those of a topic in the order of arrival."""
        return ((topic, item) for topic, own in self._topics.items() for item in own.values())

    def put(self, topic: str, cdr: bytes, item: T, publishers: int) -> bool:
        """Keep a message instead of the one of its publisher before it.

        Args:
            topic: full name.
            cdr: the serialised message.
            item: what is kept of it.
            publishers: number of publishers of the topic that latch; with 0, nothing is kept.

        Returns:
            Whether it is kept.
        """
        if not publishers:
            return False
        own = self._topics.setdefault(topic, {})
        key = self._publisher_of(topic, cdr)
        own.pop(key, None)
        own[key] = item
        most = MAX_LATCHED if has_transforms(topic) else min(publishers, MAX_LATCHED)
        while len(own) > most:
            del own[next(iter(own))]
        return True

    def remove(self, topic: str, cdr: bytes) -> None:
        """Forget a message that is kept."""
        own = self._topics[topic]
        del own[self._publisher_of(topic, cdr)]
        if not own:
            del self._topics[topic]

    def topics(self) -> tuple[str, ...]:
        """Topics whose messages are kept, sorted."""
        return tuple(sorted(self._topics))

    def copy(self) -> LatchedMessages[T]:
        """Return the same messages, apart from later changes."""
        copy = LatchedMessages[T]()
        copy._topics = {topic: dict(own) for topic, own in self._topics.items()}
        return copy

    def _publisher_of(self, topic: str, cdr: bytes) -> object:
        """Return a key that tells apart messages of several publishers, even if bytes are equal.

        That of transforms is their frames. It is asked for each /tf, so that nothing is decoded
        whose frames are known.
        """
        if not has_transforms(topic):
            return cdr
        if (layout := self._layouts.of(cdr)) is not None:
            return layout.children
        try:
            message: TFMessage = decode(TF, cdr)
        except MessageError:
            return cdr
        self._layouts.learn(cdr, message)
        return frozenset(transform.child for transform in message.transforms)


def has_transforms(topic: str) -> bool:
    """Return whether the name of a topic, in any namespace, is that of transforms."""
    return topic.rpartition("/")[2] in (MOVING_TF, STATIC_TF)
