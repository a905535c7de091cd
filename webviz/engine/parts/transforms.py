"""The transforms that arrive."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from webviz.api.robots import NamespacedRobot
from webviz.api.status import Level, OtherFixedFrame, Status
from webviz.data.transforms import TransformBuffer
from webviz.data.transforms.explain import unknown_fixed_frame
from webviz.data.transforms.reasons import Explanation, Kind
from webviz.engine.parts.declaring import store
from webviz.engine.parts.part import Batches, Part, PartContext
from webviz.engine.pipeline.listener import TransformListener
from webviz.engine.store import PageStore
from webviz.sources import Subscription


class FramesStore(PageStore, frozen=True):
    """All frame ids, sorted."""

    frames: Sequence[str]


class TransformsPart(Part):
    """Fills the buffer of transforms."""

    name = "Transforms"

    def __init__(
        self, context: PartContext, robots: Callable[[], Sequence[NamespacedRobot]]
    ) -> None:
        super().__init__(context)
        self._robots = robots
        self._followed: Sequence[NamespacedRobot] = ()
        self._listener = TransformListener(context.buffer, context.clock)

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the topics of tf2."""
        if (robots := self._robots()) != self._followed:
            self._followed = robots
            self._listener.follow(robots)
        return self._listener.subscriptions()

    def insert(self, batches: Batches) -> bool:
        """Insert what arrived, before displays ask for it.

        Returns:
            Whether the transforms started over in the past.
        """
        return self._listener.take(batches, self.context.offers)

    def reset(self) -> None:
        """Forget the moving transforms."""
        self._listener.reset()
        self.context.frames.forget_passed()

    @store()
    def frames(self, argument: str = "") -> FramesStore:
        """Return all frame ids."""
        return FramesStore(tuple(sorted(self.context.buffer.frames())))

    def state(self) -> Mapping[str, Any]:
        """Return all frame ids."""
        return {"frames": self.frames().frames}

    def statuses(self) -> Mapping[str, Status]:
        """Return whether anything can be drawn in the fixed frame, and the transforms' problem."""
        context = self.context
        fixed = fixed_frame_status(context.frames.fixed_frame, context.buffer)
        statuses = self._listener.statuses(context.offers, context.frames.now_ns)
        return {"Fixed Frame": fixed, **statuses}


def fixed_frame_status(fixed_frame: str, buffer: TransformBuffer) -> Status:
    """Return whether the fixed frame is known."""
    frames = buffer.frames()
    if fixed_frame in frames:
        return Status(Level.OK, "OK")
    if frames:
        reason = unknown_fixed_frame(buffer, fixed_frame)
        other = reason.near or buffer.largest_tree()[0]
        return Status(Level.ERROR, reason.sentence, OtherFixedFrame(other), reason)
    text = (
        f"No transforms yet, so {fixed_frame} is unknown: {buffer.recorded}."
        if buffer.recorded
        else f"No transforms yet on /tf or /tf_static, so {fixed_frame} is unknown. Start a "
        "publisher of transforms, such as robot_state_publisher."
    )
    return Status(Level.WARN, text, reason=Explanation(Kind.NO_TRANSFORMS, text))
