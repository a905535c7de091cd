"""Charts in panels: curves over time, which pages pan and zoom."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Protocol


@dataclass(frozen=True, eq=False)
class Chunk:
    """A piece of a curve. It is sent once, and again only if another object has its number.

    Args:
        number: of the piece in its curve, consecutive.
        times_s: ROS time in seconds, not decreasing.
        values: as many; NaN and infinities end a line.
    """

    number: int
    times_s: Sequence[float]
    values: Sequence[float]


@dataclass(frozen=True)
class Curve:
    """A curve of a chart.

    Args:
        name: in the legend, different from all others.
        chunks: oldest first.
        problem: why there is none, or what is wrong; a sentence or "".
        axis: of its values: 0 is at the left, 1 and higher are at the right, the lowest innermost.
        unit: of its values, "" if it is unknown.
    """

    name: str
    chunks: Sequence[Chunk] = ()
    problem: str = ""
    axis: int = 0
    unit: str = ""


Remove = Callable[[str, int | None], object]
"""Called with the name of a curve that a browser removes, and its id."""
SeekTo = Callable[[float, int | None], object]
"""Called with a ROS time in seconds that a browser wants to go to, and its id."""


class Chart(Protocol):
    """A chart of curves over time."""

    def show(
        self, curves: Sequence[Curve], window_s: float, now_s: float, across: str = ""
    ) -> None:
        """Show these curves.

        Args:
            curves: in the order of the legend.
            window_s: how much time is shown until a browser zooms.
            now_s: end of that time, in seconds of ROS time.
            across: name of the curve whose values the others are drawn over, "" for time.
        """
        ...
