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

    def reject(
        self,
        link: tuple[str, str],
        stamp_ns: int,
        received_ns: int,
        fault: tuple[str, str],
        is_static: bool = False,
    ) -> None:
        """Note a transform that is invalid or too old.

        Args:
            link: its parent and child.
            stamp_ns, received_ns: its stamp and when it was received, 0 if unknown.
            fault: tf2's name of the reason, and a description.
            is_static: whether it is static.
        """
        parent, child = link
        last = self.rejections.pop(child, None)
        count = last.count + 1 if last else 1
        self.rejections[child] = Rejection(*fault, count, stamp_ns, received_ns, parent, is_static)
        if len(self.rejections) > MAX_REJECTIONS:
            del self.rejections[next(iter(self.rejections))]

    def replace(self, child: str) -> None:
        """Note a valid static transform, which replaces one that was refused."""
        rejection = self.rejections.get(child)
        if rejection is not None and rejection.is_static:
            del self.rejections[child]

    def naming(self, frame: str) -> tuple[str, Rejection] | None:
        """Return a frame whose refused transform names a frame, that of its own first."""
        if frame in self.rejections:
            return frame, self.rejections[frame]
        return next((item for item in self.rejections.items() if item[1].parent == frame), None)

    def exceed(self, child: str, received_ns: int) -> None:
        """Note a transform for which there is no room."""
        count = self.surplus.count + 1 if self.surplus else 1
        self.surplus = Surplus(child, count, received_ns)

    def clear(self) -> None:
        """Forget all of them."""
        self.rejections.clear()
        self.surplus = None
