"""All parts of a viewer as one: each call reaches those it concerns, whatever others raise."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields
from typing import Any

from webviz.api.errors import Error
from webviz.api.status import Status
from webviz.engine.commands import Command, FileCommand, Sender
from webviz.engine.parts.part import Batches, Handler, Part
from webviz.engine.pipeline.guard import Guard
from webviz.engine.requests import Job
from webviz.engine.sources import Subscription, merged
from webviz.engine.state import State

_FIELDS = {field.name for field in fields(State)}


class Parts:
    """The parts in order: of two that want the same topic, the first decides how it is heard.

    Args:
        parts: at work; no two of them may handle the same command.
        guard: for all calls.
    """

    def __init__(self, parts: Sequence[Part], guard: Guard) -> None:
        self._parts = parts
        self._guard = guard
        self._handlers: dict[type[Command], Handler] = {}
        for part in parts:
            for kind, handler in part.handles.items():
                if kind in self._handlers:
                    raise ValueError(f"two parts handle {kind.__name__}")
                self._handlers[kind] = handler

    def do(self, command: Command, sender: Sender) -> str | Job[Any]:
        """Let the part that owns a command do it.

        Returns:
            What there is to tell of it, "" for what can be seen; or its slow part.

        Raises:
            Error: no part owns it, or it cannot be done; a sentence.
        """
        kind = type(command)
        if kind not in self._handlers:
            raise Error(f"No part of this viewer handles {kind.__name__}. Add one that does.")
        result = self._handlers[kind](command, sender) or ""
        if isinstance(result, Job) and not isinstance(command, FileCommand):
            raise TypeError(f"{kind.__name__} has a slow part but is no FileCommand")
        return result

    def subscriptions(self) -> Mapping[str, Subscription]:
        """All that has to be heard, by topic."""
        own: Mapping[str, Subscription] = {}
        guard = self._guard
        return merged(guard.attempt(part.name, own, part.subscriptions) for part in self._parts)

    def take(self, batches: Batches) -> None:
        """Hand on what arrived since the last turn."""
        for part in self._parts:
            self._guard(part.name, part.take, batches)

    def reset(self) -> None:
        """Forget what was received."""
        for part in self._parts:
            self._guard(part.name, part.reset)

    def keep_up(self, commanded: bool) -> None:
        """Do what has to be done now and then."""
        for part in self._parts:
            self._guard(part.name, part.keep_up, commanded)

    def state(self) -> State:
        """What all of them say of themselves; the fields of one that fails have their defaults."""
        found: dict[str, Any] = {}
        for part in self._parts:
            own: Mapping[str, Any] = {}
            found |= self._guard.attempt(part.name, own, part.state)
        more = {name: value for name, value in found.items() if name not in _FIELDS}
        return State(**{name: value for name, value in found.items() if name in _FIELDS}, more=more)

    def statuses(self) -> dict[str, Status]:
        """What they have to say of the viewer as a whole, by key."""
        found: dict[str, Status] = {}
        for part in self._parts:
            own: Mapping[str, Status] = {}
            found |= self._guard.attempt(part.name, own, part.statuses)
        return found

    def close(self) -> None:
        """End all of them."""
        for part in self._parts:
            self._guard(part.name, part.close)
