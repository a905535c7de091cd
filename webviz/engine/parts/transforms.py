"""The transforms, and problems with them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.api.status import Status
from webviz.data.transforms import tree_text
from webviz.engine.commands import Command, InspectTransforms, Sender
from webviz.engine.parts.part import Batches, Core, Handler, Part
from webviz.engine.pipeline.listener import TransformListener
from webviz.engine.sources import Subscription
from webviz.engine.statuses import fixed_frame_status


class TransformsPart(Part):
    """Fills the transform buffer and reports problems of its tree."""

    name = "Transforms"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self._listener = TransformListener(core.buffer, core.clock)
        self._is_inspected = False

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {InspectTransforms: self._inspect}

    def subscriptions(self) -> Mapping[str, Subscription]:
        """The topics of tf2."""
        return self._listener.subscriptions()

    def insert(self, batches: Batches) -> bool:
        """Insert what arrived, before displays look it up.

        Returns:
            Whether the transforms started over in the past.
        """
        return self._listener.take(batches, self.core.offers)

    def reset(self) -> None:
        """Discard the moving transforms."""
        self._listener.reset()

    def state(self) -> Mapping[str, Any]:
        """The frames, and their tree while it is inspected."""
        buffer, core = self.core.buffer, self.core
        wanted = self._is_inspected and core.is_watched()
        return {
            "frames": tuple(sorted(buffer.frames())),
            "transforms": tree_text(buffer, core.frames.now_ns) if wanted else "",
        }

    def statuses(self) -> Mapping[str, Status]:
        """Whether the fixed frame is known, and problems with transforms."""
        core = self.core
        fixed = fixed_frame_status(core.frames.fixed_frame, core.buffer)
        found = self._listener.statuses(core.offers, core.frames.now_ns)
        return {"Fixed Frame": fixed, **found}

    def _inspect(self, command: InspectTransforms, sender: Sender) -> None:
        self._is_inspected = command.inspect
