"""One curve of the panel Plot: a number of the messages of a topic."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.data.messages import KNOWN, MessageTypes, types_of
from webviz.data.messages.geometry import Header
from webviz.data.messages.message_paths import MessagePath, OverTime
from webviz.data.messages.paths import NothingMatches, PathError
from webviz.panels.plot.history import CurveHistory

How = tuple[float, str]
"""Window in seconds, and which time is used."""


class Series:
    """The values of one curve.

    Args:
        text: the message path of a number.
        how: see `How`.
        before: the same curve with another window, whose values it takes over if their times are
            of the same kind.
    """

    def __init__(self, text: str, how: How, before: Series | None = None) -> None:
        self.how = how
        self.topic = ""
        self.problem = ""
        """Why the newest message has no value."""
        self.has_stamp = True
        self._types: MessageTypes = KNOWN if before is None else before._types
        """Those that define the type of the newest message."""
        self._path: MessagePath | None = None
        self._over_time: OverTime | None = None
        self._invalid = ""
        self.history = CurveHistory(how[0])
        try:
            self._path = path = MessagePath(text)
        except PathError as error:
            self._invalid = str(error)
        else:
            self.topic = path.topic
            self._over_time = path.over_time()
            if not path.has_field:
                self._invalid = f"`{text[:80]}` has no field. Add one, such as {text[:80]}.data."
        if before is not None and before.how[1] == how[1]:
            for point in before.history.points():
                self.history.add(*point)

    def add(self, message: Any, received_ns: int, *, by_stamp: bool) -> None:
        """Add the value of a message."""
        if self._path is None:
            return
        self._types = types_of(message)
        try:
            value = self._path.number(message)
        except NothingMatches as error:  # the element may be in the next message
            self.problem = "" if self.history.newest else str(error)
            return
        except PathError as error:
            self.problem = str(error)
            self.history.gap()
            return
        self.problem = ""
        self.has_stamp = isinstance(getattr(message, "header", None), Header)
        time_s = _time_s(message, received_ns, by_stamp=by_stamp)
        self.history.add(time_s, self._over_time(time_s, value) if self._over_time else value)

    def is_behind(self, message: Any, received_ns: int, *, by_stamp: bool) -> bool:
        """Return whether it has no value as new as that of a message."""
        newest = self.history.newest
        return newest is None or newest[0] < _time_s(message, received_ns, by_stamp=by_stamp)

    def unit(self, types: Mapping[str, str]) -> str:
        """Return the unit of the values, "" if the type of the messages states none."""
        return self._path.unit(types.get(self.topic, ""), self._types) if self._path else ""

    def clear(self) -> None:
        """Forget all values."""
        self.history = CurveHistory(self.how[0])
        self.problem = ""
        self._over_time = self._path.over_time() if self._path else None

    def explanation(self, types: Mapping[str, str]) -> str:
        """Why the curve has no new values, or what to know of them; a sentence or ""."""
        if self._invalid:
            return self._invalid
        if self.topic not in types:
            return f"No publisher on {self.topic}. Start the node that publishes it."
        if self.problem:
            return self.problem
        if self.history.newest is None:
            return "No message yet."
        if not self.has_stamp and self.how[1] != "Received":
            return "The messages have no header: the times are those of their arrival."
        if self.history.late:
            return f"{self.history.late} values were left out: their times go back."
        return ""


def _time_s(message: Any, received_ns: int, *, by_stamp: bool) -> float:
    header = getattr(message, "header", None)
    return (header.stamp_ns if by_stamp and isinstance(header, Header) else received_ns) / 1e9
