"""The displays, and the commands that change their list."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import msgspec

from webviz.api.declared import make
from webviz.api.display import Display
from webviz.api.registry import display_types
from webviz.api.status import Level, Status
from webviz.engine.commands import (
    AddDisplay,
    Command,
    DuplicateDisplay,
    MoveDisplay,
    RemoveDisplay,
    ResetDisplay,
    Sender,
    SetProperty,
    TraceDisplay,
)
from webviz.engine.parts.consistency import ConsistencyCheck
from webviz.engine.parts.display_list import DisplayList
from webviz.engine.parts.display_rows import rows
from webviz.engine.parts.part import Batches, Core, Handler, Part
from webviz.engine.pipeline import Runner, Services
from webviz.files.config import ConfigError, mistakes, nearest, sentences
from webviz.sources import Advertisement, Subscription, merged

UNSEEN = Status(
    Level.IDLE,
    "Not received: no browser shows its pane. Expand the pane, or bring the browser to the front.",
)


class DisplaysPart(Part):
    """All displays.

    Args:
        core: shared by all parts.
        services: for the runners.
    """

    name = "Displays"

    def __init__(self, core: Core, services: Services) -> None:
        super().__init__(core)
        self.list = DisplayList(services)
        self.services = services
        self.tracer = services.tracer
        self.points = services.points
        self.consistency = ConsistencyCheck(core, self.list)

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {
            SetProperty: self._set,
            AddDisplay: self._add,
            RemoveDisplay: self._remove,
            DuplicateDisplay: self._duplicate,
            MoveDisplay: self._move,
            ResetDisplay: self._reset_properties,
            TraceDisplay: self._trace,
        }

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the displays' subscriptions. The first decides on type and QoS of a topic."""
        active = self.list.active()
        return merged(each.subscriptions() for each in active if not self._is_unseen(each))

    def advertisements(self) -> set[Advertisement]:
        """Return the publishers of the displays."""
        return {
            advertisement
            for runner in self.list.active()
            for advertisement in runner.advertisements()
        }

    def take(self, batches: Batches) -> None:
        """Pass messages to the displays."""
        for runner in self.list.active():
            runner.take(batches, self.core.frames, self.core.offers)

    def reset(self) -> None:
        """Forget all messages."""
        for runner in self.list.runners():
            self.core.guard(self.name, runner.reset)

    def state(self) -> Mapping[str, Any]:
        """Return the list of displays."""
        self.core.guard("Consistency check", self.consistency.update)
        return {"rows": rows(self.list.entries, self._statuses_of)}

    def _statuses_of(self, runner: Runner) -> Mapping[str, Status]:
        core = self.core
        if self._is_unseen(runner):
            return {"Display": UNSEEN}
        dropped = core.player.inbox.dropped
        return runner.statuses(core.offers, core.frames, dropped, core.is_watched())

    def _is_unseen(self, runner: Runner) -> bool:
        """Return whether all that a display shows is a pane that nobody sees."""
        scene, display = self.core.scene, runner.display
        if not (display.enabled and type(display).has_pane):
            return False
        return self.core.guard.attempt("Scene", False, scene.is_unseen, runner.id)

    # Commands

    def _set(self, command: SetProperty, sender: Sender) -> None:
        self.list.set(command.display, command.path, command.value)

    def _add(self, command: AddDisplay, sender: Sender) -> None:
        new = _new(command.type, command.values)
        (entry,) = self.list.add([new], self.list.group(command.group))
        command.made(entry.id)

    def _remove(self, command: RemoveDisplay, sender: Sender) -> None:
        self.list.remove(command.display)

    def _duplicate(self, command: DuplicateDisplay, sender: Sender) -> None:
        if copied := self.list.duplicate(command.display):
            command.made(copied.id)

    def _move(self, command: MoveDisplay, sender: Sender) -> None:
        self.list.move(command.display, command.group, command.before)

    def _reset_properties(self, command: ResetDisplay, sender: Sender) -> None:
        self.list.reset(command.display)

    def _trace(self, command: TraceDisplay, sender: Sender) -> None:
        self.tracer.ask(command.display, command.answer)


def _new(type_name: str, values: dict[str, Any]) -> Display:
    types = display_types()
    if type_name not in types:
        hint = nearest(type_name, types)
        raise ConfigError(f"Unknown display type `{type_name}`: {hint}")
    cls = types[type_name]
    try:
        return make(cls, values)
    except msgspec.ValidationError as error:
        found = mistakes(cls, values, error)
        raise ConfigError(f"Not added: {sentences(found)}") from error
