"""tf2's exceptions, and how tf2 prints a time in their texts."""

from __future__ import annotations

from collections.abc import Callable

NS_PER_S = 1_000_000_000


class TransformException(Exception):
    """A transform is not available; the base of tf2's exceptions.

    Args:
        text: in tf2's words, or what makes it: most failures are counted, few are read.
    """

    def __init__(self, text: str | Callable[[], str]) -> None:
        super().__init__(text)
        self._text = text

    def __str__(self) -> str:
        return self._text if isinstance(self._text, str) else self._text()


class LookupException(TransformException):
    """A frame is unknown, or the tree contains a loop."""


class ConnectivityException(TransformException):
    """The two frames are in unconnected trees."""


class InvalidArgumentException(TransformException):
    """A frame id is empty or starts with a slash."""


class TimeoutException(TransformException):
    """A transform did not become available in time."""


class ExtrapolationException(TransformException):
    """A link of the chain has no data that brackets the requested time."""


class BackwardExtrapolationException(ExtrapolationException):
    """The requested time is older than a link's oldest data."""


class ForwardExtrapolationException(ExtrapolationException):
    """The requested time is newer than a link's newest data."""


class NoDataForExtrapolationException(ExtrapolationException):
    """A link holds no data, or a single sample at another time."""


def stamp_to_seconds(stamp_ns: int) -> float:
    """Seconds as tf2 computes them: whole seconds plus 1e-9 times the remainder."""
    whole, rest = divmod(abs(stamp_ns), NS_PER_S)
    seconds = whole + 1e-9 * rest
    return -seconds if stamp_ns < 0 else seconds


def format_stamp(stamp_ns: int) -> str:
    """Return a stamp in tf2's texts: seconds with six decimals."""
    return f"{stamp_to_seconds(stamp_ns):.6f}"
