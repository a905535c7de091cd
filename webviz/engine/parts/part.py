"""What the parts of a viewer are, and what they share."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from typing import Any, ClassVar

from webviz.api.frames import Frames
from webviz.api.status import Status
from webviz.data.transforms import TransformBuffer
from webviz.engine.commands import Command, Sender
from webviz.engine.pipeline.guard import Guard
from webviz.engine.requests import Job
from webviz.engine.scene import Scene
from webviz.engine.sources import Offer, Raw, Source, Subscription

Batches = Mapping[str, Iterable[Raw]]
"""Messages by topic, oldest first."""

Handler = Callable[[Any, Sender], str | Job[Any] | None]
"""Does a command, and returns what there is to tell of it; of a `FileCommand`, its slow part.

It raises a `webviz.Error` to refuse it, with a sentence.
"""


class Core:
    """What the parts of a viewer share. Only the frame loop changes it.

    Args:
        source: where messages come from.
        scene: where to draw.
        guard: for all calls.
        clock: monotonic time in seconds.
    """

    def __init__(
        self, source: Source, scene: Scene, guard: Guard, clock: Callable[[], float]
    ) -> None:
        self.source = source
        self.scene = scene
        self.guard = guard
        self.clock = clock
        self.buffer = TransformBuffer()
        self.frames = Frames(self.buffer, "", 0)
        """Where everything is at the time that is shown."""
        self.now_ns = 0
        """ROS time of the turn, whatever time is shown; 0 while it is not known."""
        self.offers: Mapping[str, Offer] = {}
        """What is known of every topic."""

    def is_watched(self) -> bool:
        """Whether any browser is connected."""
        return self.guard.attempt("Scene", True, self.scene.has_watchers)


class Part:
    """One thing that a viewer does: it owns some commands and some fields of `State`.

    All methods are called by the frame loop, so none may block. What they raise becomes a status
    named after the part.

    Args:
        core: what all parts share.
    """

    name: ClassVar[str] = ""
    """In the sentence that says that the part failed."""

    def __init__(self, core: Core) -> None:
        self.core = core

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """What does each of its commands."""
        return {}

    def subscriptions(self) -> Mapping[str, Subscription]:
        """What it wants to hear, by topic."""
        return {}

    def take(self, batches: Batches) -> None:
        """Take what arrived since the last turn."""

    def reset(self) -> None:
        """Forget what was received: time starts over."""

    def keep_up(self, commanded: bool) -> None:
        """Do what has to be done now and then, before a new state.

        Args:
            commanded: whether a command was done since the last call.
        """

    def state(self) -> Mapping[str, Any]:
        """Its fields of `State`."""
        return {}

    def statuses(self) -> Mapping[str, Status]:
        """What it has to say of the viewer as a whole, by key."""
        return {}

    def close(self) -> None:
        """End: the loop is over."""
