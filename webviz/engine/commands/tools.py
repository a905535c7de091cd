"""Commands for tools."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from webviz.api.status import Status
from webviz.api.tool import Position
from webviz.engine.commands.command import Command, ignore


def unheard(topic: str, type: str, values: Mapping[str, Any]) -> None:
    """Ignore a message that was published."""


@dataclass(frozen=True)
class UseTool(Command):
    """Let a tool act on a finished gesture; see `webviz.api.tool.Stroke`.

    Args:
        tool: id of the tool, or its name.
        points, yaw, keys, yaws, several: of the stroke.
        report: called with the result from any thread; must not block.
        published: called with the topic, type and values of each message.
    """

    tool: str
    points: tuple[Position, ...]
    yaw: float = 0.0
    keys: frozenset[str] = frozenset()
    yaws: tuple[float, ...] = ()
    several: str = ""
    report: Callable[[Status], None] = ignore
    published: Callable[[str, str, Mapping[str, Any]], None] = unheard


@dataclass(frozen=True)
class SetToolProperty(Command):
    """Change a property of a tool; nested ones have a dotted path, such as `topic.name`."""

    tool: str
    path: str
    value: Any
