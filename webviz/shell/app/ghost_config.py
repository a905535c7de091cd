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
from webviz.files.config import Branch, Config, Item
from webviz.sources.bag.ghost import DIFFERENCE, DISTANCE, NAMESPACE, ROOT
from webviz.sources.bag.source import BagSource

TINT = [90, 150, 255]
OPACITY = 0.4
"""Of what the displays show of the first run."""
FLAT = "FlatColor"
COVERING = {"Map", "Costmap", "OccupancyGrid", "OccupancyMap", "GridMap"}
"""Displays that would lie over those of the first run; their copies are switched off."""


def with_ghost(config: Config, bag: BagSource) -> Config:
    """Return a config that shows the second run of a bag, too.

    Args:
        config: for the first run; changed.
        bag: has a ghost.
    """
    copies: list[Item] = list(filter(None, map(_copy, _displays(config.displays))))
    config.displays = [*config.displays, Branch(make(DisplayGroup, {"name": "Ghost"}), copies)]
    root = _root(config.settings.fixed_frame, bag.links())
    robot = NamespacedRobot(NAMESPACE, f"{NAMESPACE}/", (root,))
    robots = (*config.settings.robots, robot)
    config.settings = msgspec.structs.replace(config.settings, robots=robots)
    curves = [f"{topic}.data" for topic in (DISTANCE, DIFFERENCE) if bag.has(topic)]
    if curves and (plot := plugin_types(Panel).get("Plot")):
        config.panels = [*config.panels, make(plot, {"name": "Ghost", "curves": curves})]
    return config


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
    values = _tinted(values)
    for field, topic in topics.items():
        if topic.name:
            values[field]["name"] = f"{ROOT}/{topic.name.removeprefix('/')}"
    values["name"] = f"{display.name} (ghost)"
    if cls.__name__ in COVERING or getattr(display, "has_pane", False):
        values["enabled"] = False
    if "color_transformer" in values:
        try:
            return make(cls, values | {"color_transformer": FLAT})
        except msgspec.ValidationError:
            pass  # it has no such choice
    return make(cls, values)


def _tinted(value: Any, key: str = "") -> Any:
    """Plain values with other colours and opacities."""
    if isinstance(value, dict):
        return {name: _tinted(each, name) for name, each in value.items()}
    is_color = isinstance(value, list | tuple) and len(value) == 3
    if key.endswith("color") and is_color:
        return TINT
    if key.endswith("alpha") and isinstance(value, float):
        return value * OPACITY
    return value


def _root(frame: str, links: Sequence[tuple[str, str]]) -> str:
    """Return the frame at the root of the transforms above a frame."""
    parents = {child: parent for parent, child in links}
    seen = {frame}
    while (parent := parents.get(frame)) is not None and parent not in seen:
        seen.add(parent)
        frame = parent
    return frame
