"""The numbers that message paths name, as rules are about them."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from webviz.data.messages import MessageError, decode
from webviz.data.messages.message_paths import MessagePath
from webviz.data.messages.paths import PathError
from webviz.sources import Raw

NS_PER_S = 1e9


class PathNumbers:
    """The numbers of a path in the last messages that were read.

    Args:
        text: the message path.
    """

    def __init__(self, text: str) -> None:
        self.path = MessagePath(text)
        self.numbers: Sequence[float] = ()
        self._over_time: Callable[[float, float], float] | None = self.path.over_time()

    def read(self, type_name: str, batch: Sequence[Raw]) -> None:
        """Read messages; those that lack the number count as none."""
        numbers: list[float] = []
        for raw in batch:
            try:
                message = decode(type_name, raw.cdr, raw.types)
                number = self.path.number(message)
            except (MessageError, PathError):
                continue
            time_s = raw.received_ns / NS_PER_S
            numbers.append(self._over_time(time_s, number) if self._over_time else number)
        self.numbers = numbers
