"""The transforms that a buffer has refused, within bounds."""

from __future__ import annotations

from webviz.data.transforms.records import Rejection, Surplus

MAX_REJECTIONS = 1000
"""Child frames of which the last refusal is kept."""


class Refusals:
    """The refused transforms of a buffer.

    Attributes:
        rejections: the last refusal of each of the `MAX_REJECTIONS` frames refused last.
        surplus: the transforms of more frames than the buffer keeps; None if there were none.
    """

    def __init__(self) -> None:
        self.rejections: dict[str, Rejection] = {}
        self.surplus: Surplus | None = None

    def reject(self, child: str, stamp_ns: int, received_ns: int, fault: tuple[str, str]) -> None:
        """Note a transform that is invalid or too old.

        Args:
            child: its frame.
            stamp_ns, received_ns: its stamp and when it was received, 0 if unknown.
            fault: tf2's name of the reason, and a description.
        """
        last = self.rejections.pop(child, None)
        count = last.count + 1 if last else 1
        self.rejections[child] = Rejection(*fault, count, stamp_ns, received_ns)
        if len(self.rejections) > MAX_REJECTIONS:
            del self.rejections[next(iter(self.rejections))]

    def exceed(self, child: str, received_ns: int) -> None:
        """Note a transform for which there is no room."""
        count = self.surplus.count + 1 if self.surplus else 1
        self.surplus = Surplus(child, count, received_ns)

    def clear(self) -> None:
        """Forget all of them."""
        self.rejections.clear()
        self.surplus = None
