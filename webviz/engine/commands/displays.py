"""What changes the list of displays."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from dataclasses import dataclass, field
from typing import Any

from webviz.engine.commands.command import Command, ignore
from webviz.engine.trace import Trace


@dataclass(frozen=True)
class SetProperty(Command):
    """Change a property of a display; nested ones have a dotted path, such as `topic.name`."""

    display: str
    path: str
    value: Any


@dataclass(frozen=True)
class AddDisplay(Command):
    """Add a display at the end of the list, or of a group.

    Args:
        type: name of the display type.
        values: its properties, as in a config file.
        group: where to; "" is the list itself.
        made: called with the id of the new display by the frame loop, so it must not block.
    """

    type: str
    values: dict[str, Any] = field(default_factory=dict)
    group: str = ""
    made: Callable[[str], None] = ignore


@dataclass(frozen=True)
class RemoveDisplay(Command):
    """Remove a display, or a group with all that is in it."""

    display: str


@dataclass(frozen=True)
class DuplicateDisplay(Command):
    """Add a copy right behind a display, or a group with all that is in it.

    Args:
        display: what to copy.
        made: called with the id of the copy by the frame loop, so it must not block.
    """

    display: str
    made: Callable[[str], None] = ignore


@dataclass(frozen=True)
class MoveDisplay(Command):
    """Put a display or a group elsewhere in the list.

    Args:
        display: what to move.
        group: where to; "" is the list itself.
        before: goes before this one of that group; "" is the end.
    """

    display: str
    group: str = ""
    before: str = ""


@dataclass(frozen=True)
class TraceDisplay(Command):
    """Note the times of the next sample that a display draws.

    Args:
        display: id of the display.
        answer: is given them; cancel it to stop waiting.
    """

    display: str
    answer: Future[Trace]
