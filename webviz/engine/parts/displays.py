"""The displays, and the commands that change their list."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from concurrent.futures import Future
from typing import Any

import msgspec

from webviz.api.declared import make
from webviz.api.display import Display
from webviz.api.registry import display_types
from webviz.api.roles import Role
from webviz.api.status import Level, Status
from webviz.engine.commands.command import ignore
from webviz.engine.parts.consistency import ConsistencyCheck
from webviz.engine.parts.declaring import command
from webviz.engine.parts.display_list import DisplayList
from webviz.engine.parts.display_rows import rows
from webviz.engine.parts.part import Batches, Core, Part
from webviz.engine.pipeline import Runner, Services
from webviz.engine.state.trace import Trace
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

    @command(Role.OPERATOR)
    def set_property(self, display: str, path: str, value: Any) -> None:
        """Change a property of a display; nested ones have a dotted path, such as `topic.name`."""
        self.list.set(display, path, value)

    @command(Role.OPERATOR)
    def add_display(
        self,
        type: str,
        values: dict[str, Any] = {},  # noqa: B006 - nobody changes it
        group: str = "",
        made: Callable[[str], None] = ignore,
    ) -> None:
        """Add a display at the end of the list, or of a group.

        Args:
            type: name of the display type.
            values: its properties, as in a config file.
            group: id of the group; "" is the list itself.
            made: called by the frame loop with the id of the new display; must not block.
        """
        new = _new(type, values)
        (entry,) = self.list.add([new], self.list.group(group))
        made(entry.id)

    @command(Role.OPERATOR)
    def remove_display(self, display: str) -> None:
        """Remove a display, or a group with its contents."""
        self.list.remove(display)

    @command(Role.OPERATOR)
    def duplicate_display(self, display: str, made: Callable[[str], None] = ignore) -> None:
        """Add a copy of a display, or of a group with its contents, after it.

        Args:
            display: id of the display or group.
            made: called by the frame loop with the id of the copy; must not block.
        """
        if copied := self.list.duplicate(display):
            made(copied.id)

    @command(Role.OPERATOR)
    def move_display(self, display: str, group: str = "", before: str = "") -> None:
        """Move a display or a group in the list.

        Args:
            display: id of the display or group.
            group: id of the group; "" is the list itself.
            before: id of the entry of that group that follows it; "" is the end.
        """
        self.list.move(display, group, before)

    @command(Role.OPERATOR)
    def reset_display(self, display: str) -> None:
        """Give the properties of a display their defaults, but for its name, switch and topics."""
        self.list.reset(display)

    @command(None)
    def trace_display(self, display: str, answer: Future[Trace]) -> None:
        """Trace the next sample that a display draws.

        Args:
            display: id of the display.
            answer: gets the times; cancel it to stop waiting.
        """
        self.tracer.ask(display, answer)


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
