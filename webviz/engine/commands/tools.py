"""Commands for tools."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from webviz.api.status import Status
from webviz.api.tool import Position
from webviz.engine.commands.command import Command, ignore


@dataclass(frozen=True)
class UseTool(Command):
    """Let a tool act on a finished gesture; see `webviz.api.tool.Stroke`.

    Args:
        tool: id of the tool, or its name.
        points, yaw, keys: of the stroke.
        report: called with the result from any thread; must not block.
    """

    tool: str
    points: tuple[Position, ...]
    yaw: float = 0.0
    keys: frozenset[str] = frozenset()
    report: Callable[[Status], None] = ignore


@dataclass(frozen=True)
class SetToolProperty(Command):
    """Change a property of a tool; nested ones have a dotted path, such as `topic.name`."""

    tool: str
    path: str
    value: Any
