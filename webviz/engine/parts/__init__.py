"""The parts of a viewer: each owns its commands and its fields of the state."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import msgspec

from webviz.api.errors import Error
from webviz.api.status import Status
from webviz.engine.commands import Command, FileCommand, Sender
from webviz.engine.error_boundary import ErrorBoundary
from webviz.engine.parts.part import Batches, Handler, Part, PartContext, overrides
from webviz.engine.requests import Job
from webviz.sources import Advertisement, Subscription, merged

__all__ = ["Batches", "Handler", "Part", "PartContext", "Parts"]

_HOOKS = (
    *("subscriptions", "advertisements", "after", "take", "keep_up", "update"),
    *("review", "statuses", "is_attended", "close"),
)


class Parts:
    """The parts in order: the first that subscribes to a topic decides on its type and QoS.

    Args:
        parts: no two of them may handle the same command.
        boundary: around all calls.
    """

    def __init__(self, parts: Sequence[Part], boundary: ErrorBoundary) -> None:
        self._parts = parts
        self._overriding = {hook: [p for p in parts if overrides(p, hook)] for hook in _HOOKS}
        self._boundary = boundary
        self._handlers: dict[type[Command], Handler] = {}
        for part in parts:
            for kind, handler in part.handles.items():
                if kind in self._handlers:
                    raise ValueError(f"two parts handle {kind.__name__}")
                self._handlers[kind] = handler

    def do(self, command: Command, sender: Sender) -> str | Job[Any]:
        """Let the part that owns a command carry it out.

        Returns:
            Its answer, "" if its effect is visible; or its slow part.

        Raises:
            Error: no part owns it, or it is refused; one sentence.
        """
        kind = type(command)
        if kind not in self._handlers:
            raise Error(f"No part of this viewer handles {kind.__name__}. Add one.")
        result = self._handlers[kind](command, sender) or ""
        if isinstance(result, Job) and not isinstance(command, FileCommand):
            raise TypeError(f"{kind.__name__} has a slow part but is no FileCommand")
        if not isinstance(result, Job):
            self._after(command, sender)
            return result

        def then(value: Any) -> str:
            text = result.then(value)
            self._after(command, sender)
            return text

        return msgspec.structs.replace(result, then=then)

    def _after(self, command: Command, sender: Sender) -> None:
        for part in self._overriding["after"]:
            self._boundary(part.name, part.after, command, sender)

    def subscriptions(self) -> Mapping[str, Subscription]:
        """All subscriptions by topic."""
        own: Mapping[str, Subscription] = {}
        boundary = self._boundary
        return merged(
            boundary.attempt(part.name, own, part.subscriptions)
            for part in self._overriding["subscriptions"]
        )

    def advertisements(self) -> set[Advertisement]:
        """Return the publishers that all parts need."""
        advertisements: set[Advertisement] = set()
        for part in self._overriding["advertisements"]:
            advertisements.update(self._boundary.attempt(part.name, (), part.advertisements))
        return advertisements

    def take(self, batches: Batches) -> None:
        """Pass on the messages since the last turn."""
        for part in self._overriding["take"]:
            self._boundary(part.name, part.take, batches)

    def keep_up(self, commanded: bool) -> None:
        """Do periodic work."""
        for part in self._overriding["keep_up"]:
            self._boundary(part.name, part.keep_up, commanded)

    def update(self) -> None:
        """Have all parts note what there is to show."""
        for part in self._overriding["update"]:
            self._boundary(part.name, part.update)

    def review(self) -> None:
        """Have parts look at what all have noted."""
        for part in self._overriding["review"]:
            self._boundary(part.name, part.review)

    def statuses(self) -> dict[str, Status]:
        """Return the statuses of the viewer as a whole, by key."""
        statuses: dict[str, Status] = {}
        for part in self._overriding["statuses"]:
            own: Mapping[str, Status] = {}
            statuses |= self._boundary.attempt(part.name, own, part.statuses)
        return statuses

    def is_attended(self) -> bool:
        """Return whether a page shows something that changes all the time."""
        return any(
            self._boundary.attempt(part.name, True, part.is_attended)
            for part in self._overriding["is_attended"]
        )

    def close(self) -> None:
        """Close all parts."""
        for part in self._overriding["close"]:
            self._boundary(part.name, part.close)
