"""The tools of the toolbar, and their publishers."""

from __future__ import annotations

import contextlib
import functools
import inspect
import logging
import math
from collections.abc import Callable, Collection, Mapping
from concurrent.futures import Future
from typing import Any

from webviz.api.declared import Topic
from webviz.api.goal import GoalRequest
from webviz.api.status import Status
from webviz.api.tool import Gesture, Tool, ToolContext, outputs
from webviz.api.vehicle import Vehicle
from webviz.data.transforms.geometry import REACH_M
from webviz.engine.commands import Command, Sender, SetToolProperty, UseTool
from webviz.engine.driving import VelocityControllers
from webviz.engine.parts.advertisements import advertisement_of
from webviz.engine.parts.advertisements import publish as publish_on
from webviz.engine.parts.goals import GoalsPart
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.parts.plugin_list import PluginList
from webviz.engine.state import ToolButton
from webviz.files.config import ConfigError
from webviz.sources import Advertisement

log = logging.getLogger("webviz")

MAX_POINTS = 1000
"""Of a gesture."""
DRIVING_DEPTH = 1
"""Of velocity commands: only the newest counts."""


class ToolsPart(Part):
    """All tools. Which one is active is known to each page alone.

    Args:
        core: shared by all parts.
        goals: takes the goals of tools.
        controllers: of the vehicles that tools drive.
        others: what else is to be advertised.
    """

    name = "Tools"

    def __init__(
        self,
        core: Core,
        goals: GoalsPart,
        controllers: VelocityControllers,
        others: Callable[[], Collection[Advertisement]],
    ) -> None:
        super().__init__(core)
        self._goals = goals
        self._controllers = controllers
        self._others = others
        self.list = PluginList(Tool)
        self._advertised: set[Advertisement] = set()

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {UseTool: self._use, SetToolProperty: self._set}

    def odometry(self) -> dict[str, Topic]:
        """Return the odometry of each vehicle, by id of its tool."""
        vehicles = {id: tool.vehicle for id, tool in self.list.usable().items()}
        return {id: vehicle.odometry for id, vehicle in vehicles.items() if vehicle}

    def keep_up(self, commanded: bool) -> None:
        """Advertise the outputs of all tools, so that their first messages arrive.

        Those of vehicles only while browsers attend to them: it is the robot's own topic.
        """
        vehicles: dict[str, tuple[Vehicle, Advertisement]] = {}
        wanted = set(self._others())
        for id, tool in self.list.usable().items():
            if (vehicle := tool.vehicle) is None:
                wanted.update(self._advertisements(tool))
            elif advertisement := advertisement_of(
                self.core, vehicle.type, vehicle.topic, DRIVING_DEPTH
            ):
                vehicles[id] = vehicle, advertisement
        self._controllers.equip(vehicles)
        wanted |= self._controllers.advertisements()
        stopping = self._controllers.stopping()
        gate = self.core.gate
        wanted = {each for each in wanted if not gate.lasting_refusal(each.topic)} | stopping
        if wanted != self._advertised:
            self._advertised = wanted
            gate.advertise(wanted, stopping)

    def state(self) -> Mapping[str, Any]:
        """Return the buttons of the toolbar; a key belongs to the first tool that asks for it."""
        keys: dict[str, str] = {}
        for id, tool in self.list.usable().items():
            keys.setdefault(tool.shortcut, id)
        return {
            "tools": tuple(
                _button(
                    id,
                    tool,
                    tool.shortcut if keys[tool.shortcut] == id else "",
                    self._refusal(tool),
                )
                for id, tool in self.list.usable().items()
            )
        }

    def statuses(self) -> Mapping[str, Status]:
        """Return the statuses of unusable tools."""
        return self.list.statuses()

    def _use(self, command: UseTool, sender: Sender) -> None:
        id, tool = self.list.find(command.tool)
        gesture = _gesture(tool, command, sender)
        ports = {name: (output, topic) for name, output, topic in outputs(tool)}

        def publish(name: str, payload: bytes, values: Mapping[str, Any]) -> None:
            output, topic = ports[name]
            if publish_on(self.core, output.type, topic, payload, command.report):
                command.published(topic.name, output.type, values)

        def send_goal(request: GoalRequest) -> None:
            self._goals.send(id, tool.name, request, command.report)

        core, report = self.core, command.report
        context = ToolContext(
            tool, core.frames, core.player.now_ns(), publish, self._call, send_goal, report
        )
        tool.done(gesture, context)

    def _call(self, service: str, type: str, request: bytes, timeout_s: float) -> Future[bytes]:
        name = self.core.player.resolve(service)
        return self.core.gate.call(name, type, request, timeout_s)

    def _refusal(self, tool: Tool) -> str:
        """Why a tool can send nothing, "" if it can or is not known to send anything."""
        names = [advertisement.topic for advertisement in self._advertisements(tool)]
        for name in tool.uses:
            with contextlib.suppress(ValueError):
                names.append(self.core.player.resolve(name))
        refusals = [self.core.gate.refusal(name) for name in names]
        return refusals[0] if refusals and all(refusals) else ""

    def _advertisements(self, tool: Tool) -> list[Advertisement]:
        """Return the advertisements of a tool whose topics have valid names."""
        found = [
            advertisement_of(self.core, output.type, topic) for _, output, topic in outputs(tool)
        ]
        return [advertisement for advertisement in found if advertisement]

    def _set(self, command: SetToolProperty, sender: Sender) -> None:
        self.list.set(command.tool, command.path, command.value)


def _gesture(tool: Tool, command: UseTool, sender: Sender) -> Gesture:
    points, yaws = command.points, command.yaws
    numbers = [*(number for point in points for number in point), *yaws, command.yaw]
    is_finite = all(math.isfinite(n) and abs(n) <= REACH_M for n in numbers)
    if not 1 <= len(points) <= MAX_POINTS or not is_finite:
        raise ConfigError(
            f"{tool.name}: a gesture has 1 to {MAX_POINTS} points within {REACH_M:.0e} m."
        )
    if command.several and (command.several not in tool.several or len(yaws) != len(points)):
        raise ConfigError(f"{tool.name}: expected several poses, for one of its buttons.")
    return Gesture(points, command.yaw, command.keys, sender.browser, yaws, command.several)


@functools.cache
def _tooltip(cls: type[Tool]) -> str:
    return (inspect.getdoc(cls) or "").partition("\n")[0]


def _button(id: str, tool: Tool, shortcut: str, refusal: str) -> ToolButton:
    tooltip = _tooltip(type(tool))
    return ToolButton(
        id=id,
        name=tool.name,
        tooltip=tooltip,
        shortcut=shortcut,
        gesture=tool.gesture,
        icon=tool.icon,
        surface=tool.surface,
        stays=tool.stays,
        asks=tool.asks,
        refusal=refusal,
        several=tool.several,
        tool=tool,
    )
