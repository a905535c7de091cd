"""The tools of the toolbar, and what they send."""

from __future__ import annotations

import contextlib
import functools
import inspect
import math
from collections.abc import Callable, Collection, Mapping, Sequence
from concurrent.futures import Future
from typing import Any, ClassVar

from webviz.api.errors import Error
from webviz.api.goal import GoalRequest
from webviz.api.roles import Role
from webviz.api.status import Status
from webviz.api.tool import Gesture, Position, Tool, ToolContext, outputs
from webviz.data.transforms.geometry import REACH_M
from webviz.engine.commands import Sender, ignore
from webviz.engine.feature import command, store
from webviz.engine.forms import Form, form, sendable, values_of
from webviz.engine.parts.advertisements import advertisement_of
from webviz.engine.parts.advertisements import publish as publish_on
from webviz.engine.parts.part import PartContext
from webviz.engine.store import PageStore
from webviz.features.tools.toolbar import Toolbar, ToolButton
from webviz.files.config import ConfigError
from webviz.page.dispatcher import Dispatcher, PageFeature
from webviz.sources import Advertisement

MAX_POINTS = 1000
"""Largest number of points of a gesture."""
MAX_NAMES = 20
"""Largest number of names of a tool, whose rights a page shows."""


class ToolStore(PageStore, frozen=True):
    """The properties of a tool, as `properties` has them of a display.

    Args:
        sends: full names of the topics, services and actions that it sends to.
    """

    spread: ClassVar = {"values": "value."}

    name: str
    type: str
    declared: Form
    values: Mapping[str, Any]
    sends: Sequence[str]


def unheard(topic: str, type: str, values: Mapping[str, Any]) -> None:
    """Ignore a message that was published."""


class ToolsFeature(PageFeature):
    """All tools. Which one is active is known to each page alone."""

    name = "Tools"
    module = "tools.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self.list = context.tools
        self._toolbar: Toolbar | None = None
        self._buttons: Sequence[ToolButton] = ()

    def attach(self, dispatcher: Dispatcher) -> None:
        """Show the tools on pages, and take their gestures."""
        self._toolbar = Toolbar(dispatcher)

    def advertisements(self) -> Collection[Advertisement]:
        """Return the outputs of all tools but vehicles."""
        tools = self.list.usable().values()
        return [
            each for tool in tools if tool.vehicle is None for each in self._advertisements(tool)
        ]

    def update(self) -> None:
        """Show the buttons of the toolbar."""
        self._buttons = self.buttons()
        if self._toolbar is not None:
            self._toolbar.show(self._buttons)

    def state(self) -> Mapping[str, Any]:
        """Return the buttons of the toolbar."""
        return {"tools": self._buttons}

    @store()
    def tool(self, id: str) -> ToolStore | None:
        """Return the properties of the tool with this id; None if it is gone."""
        tool = self.list.usable().get(id)
        if tool is None:
            return None
        return ToolStore(
            name=str(sendable(tool.name)),
            type=type(tool).__name__,
            declared=form(type(tool), ("name",)),
            values=values_of(tool, ("name",)),
            sends=next((button.sends for button in self.buttons() if button.id == id), ()),
        )

    def buttons(self) -> tuple[ToolButton, ...]:
        """Return the buttons of the toolbar; a key belongs to the first tool that asks for it."""
        keys: dict[str, str] = {}
        for id, tool in self.list.usable().items():
            keys.setdefault(tool.shortcut, id)
        return tuple(
            self._button(id, tool, tool.shortcut if keys[tool.shortcut] == id else "")
            for id, tool in self.list.usable().items()
        )

    def _button(self, id: str, tool: Tool, shortcut: str) -> ToolButton:
        return ToolButton(
            id=id,
            name=tool.name,
            tooltip=_tooltip(type(tool)),
            shortcut=shortcut,
            gesture=tool.gesture,
            icon=tool.icon,
            surface=tool.surface,
            stays=tool.stays,
            asks=tool.asks,
            refusal=self._refusal(tool),
            several=tool.several,
            sends=tuple(self._names(tool)[:MAX_NAMES]),
            tool=tool,
        )

    def statuses(self) -> Mapping[str, Status]:
        """Return the statuses of unusable tools."""
        return self.list.statuses()

    @command(Role.OPERATOR, is_noted=True)
    def use_tool(
        self,
        sender: Sender,
        tool: str,
        points: tuple[Position, ...],
        yaw: float = 0.0,
        keys: frozenset[str] = frozenset(),
        yaws: tuple[float, ...] = (),
        several: str = "",
        report: Callable[[Status], None] = ignore,
        published: Callable[[str, str, Mapping[str, Any]], None] = unheard,
    ) -> None:
        """Let a tool act on a finished gesture; see `webviz.api.tool.Gesture`.

        Args:
            tool: id of the tool, or its name.
            points, yaw, keys, yaws, several: of the gesture.
            report: called with the result from any thread; must not block.
            published: called with the topic, type and values of each message.
        """
        id, used = self.list.find(tool)
        gesture = Gesture(points, yaw, keys, sender.browser, yaws, several)
        _check(used, gesture)
        ports = {name: (output, topic) for name, output, topic in outputs(used)}

        def publish(name: str, payload: bytes, values: Mapping[str, Any]) -> None:
            output, topic = ports[name]
            if publish_on(self.context, output.type, topic, payload, report):
                published(topic.name, output.type, values)

        def send_goal(request: GoalRequest) -> None:
            try:
                # Here, as the other tools work without goals, too.
                from webviz.features.goals import GoalsFeature

                goals = self.context.get(GoalsFeature)
            except (ImportError, LookupError) as error:
                raise Error(f"Not sent: {error}") from error
            goals.send(id, used.name, request, report)

        frames, now_ns = self.context.frames, self.context.player.now_ns()
        used.done(
            gesture, ToolContext(used, frames, now_ns, publish, self._call, send_goal, report)
        )

    def _call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        name = self.context.player.resolve(service)
        return self.context.graph.call(name, type, request, timeout_s)

    def _refusal(self, tool: Tool) -> str:
        """Return why a tool can send nothing, "" if it can or is not known to send anything."""
        refusals = [self.context.graph.refusal(name) for name in self._names(tool)]
        return refusals[0] if refusals and all(refusals) else ""

    def _names(self, tool: Tool) -> list[str]:
        """Return the full names that a tool sends to."""
        names = [advertisement.topic for advertisement in self._advertisements(tool)]
        for name in tool.uses:
            with contextlib.suppress(ValueError):
                names.append(self.context.player.resolve(name))
        return names

    def _advertisements(self, tool: Tool) -> list[Advertisement]:
        """Return the advertisements of a tool whose topics have valid names."""
        advertisements = [
            advertisement_of(self.context, output.type, topic) for _, output, topic in outputs(tool)
        ]
        return [advertisement for advertisement in advertisements if advertisement]

    @command(Role.OPERATOR)
    def set_tool_property(self, tool: str, path: str, value: Any) -> None:
        """Change a property of a tool; nested ones have a dotted path, such as `topic.name`."""
        self.list.set(tool, path, value)


def _check(tool: Tool, gesture: Gesture) -> None:
    points, yaws, several = gesture.points, gesture.yaws, gesture.several
    numbers = [*(number for point in points for number in point), *yaws, gesture.yaw]
    is_finite = all(math.isfinite(n) and abs(n) <= REACH_M for n in numbers)
    if not 1 <= len(points) <= MAX_POINTS or not is_finite:
        raise ConfigError(
            f"{tool.name}: a gesture has 1 to {MAX_POINTS} points within {REACH_M:.0e} m."
        )
    if several and (several not in tool.several or len(yaws) != len(points)):
        raise ConfigError(f"{tool.name}: expected several poses, for one of its buttons.")


@functools.cache
def _tooltip(cls: type[Tool]) -> str:
    return (inspect.getdoc(cls) or "").partition("\n")[0]
