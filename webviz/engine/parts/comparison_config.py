"""The config of a bag with a second run: copies of its displays, tinted and transparent."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import msgspec

from webviz.api.declared import Topic, make
from webviz.api.display import Display
from webviz.api.group import DisplayGroup
from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.api.robots import NamespacedRobot
from webviz.data.messages.message_paths import MessagePath
from webviz.data.transforms.tree import root_of
from webviz.files.config import Branch, Config, Item
from webviz.files.config.model import Settings
from webviz.sources.bag.comparison import DIFFERENCE, DISTANCE, NAMESPACE, ROOT
from webviz.sources.bag.history import BagHistory

TINT = (90, 150, 255)
OPACITY = 0.4
"""Opacity of what the displays show of the first run."""
COVERING = {"Map", "Costmap", "OccupancyGrid", "OccupancyMap", "GridMap"}
"""Displays that would lie over those of the first run; their copies are switched off."""
NAME = "Ghost"
"""Name of the group of displays, and of the panel."""


def with_comparison(config: Config, bag: BagHistory) -> Config:
    """Return a config that shows the second run of a bag, too.

    Args:
        config: for the first run; changed.
        bag: has a comparison run.
    """
    copies: list[Item] = list(filter(None, map(_copy, _displays(config.displays))))
    config.displays = [*config.displays, Branch(make(DisplayGroup, {"name": NAME}), copies)]
    parents = {child: parent for parent, child in bag.links()}
    root = root_of(config.settings.fixed_frame, parents)
    robot = NamespacedRobot(NAMESPACE, f"{NAMESPACE}/", (root,), tint=TINT, opacity=OPACITY)
    robots = (*config.settings.robots, robot)
    config.settings = msgspec.structs.replace(config.settings, robots=robots)
    units = {DISTANCE: "m", DIFFERENCE: _unit(bag)}
    curves = {f"{topic}.data": unit for topic, unit in units.items() if bag.has(topic)}
    if curves and (plot := plugin_types(Panel).get("Plot")):
        with_units = {name: unit for name, unit in curves.items() if unit}
        values = {"name": NAME, "curves": list(curves), "units": with_units}
        config.panels = [*config.panels, make(plot, values)]
    return config


def without_comparison(settings: Settings) -> Settings:
    """Return settings without the robot of the second run."""
    robots = tuple(
        robot
        for robot in settings.robots
        if not isinstance(robot, NamespacedRobot) or robot.namespace != NAMESPACE
    )
    return msgspec.structs.replace(settings, robots=robots)


def _unit(bag: BagHistory) -> str:
    """Return the unit of the number whose difference is plotted, "" if it is unknown."""
    if bag.comparison is None or not bag.comparison.difference:
        return ""
    path = MessagePath(bag.comparison.difference)
    channels = (each for each in bag.files.channels if each.topic == path.topic)
    return next((path.unit(each.type, each.types) for each in channels), "")


def _displays(items: Sequence[Item]) -> Iterator[Display]:
    for item in items:
        if isinstance(item, Branch):
            yield from _displays(item.displays)
        elif isinstance(item, Display):
            yield item


def _copy(display: Display) -> Display | None:
    """Return a display of the same topics of the second run, None for one without topics."""
    cls = type(display)
    values: dict[str, Any] = msgspec.to_builtins(display)
    topics = {
        field: getattr(display, field)
        for field in cls.__struct_fields__
        if isinstance(getattr(display, field), Topic)
    }
    if not any(topic.name for topic in topics.values()):
        return None
    for field, topic in topics.items():
        if topic.name:
            values[field]["name"] = f"{ROOT}/{topic.name.removeprefix('/')}"
    values["name"] = f"{display.name} (ghost)"
    if cls.__name__ in COVERING or getattr(display, "has_pane", False):
        values["enabled"] = False
    return make(cls, values)
