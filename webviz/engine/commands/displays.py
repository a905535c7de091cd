"""Commands for displays and their handles."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from typing import Any

import msgspec

from webviz.api.handles import Drag
from webviz.engine.commands.command import Command, ignore
from webviz.engine.state.trace import Trace


class SetProperty(Command, frozen=True):
    """Change a property of a display; nested ones have a dotted path, such as `topic.name`."""

    display: str
    path: str
    value: Any


class AddDisplay(Command, frozen=True):
    """Add a display at the end of the list, or of a group.

    Args:
        type: name of the display type.
        values: its properties, as in a config file.
        group: id of the group; "" is the list itself.
        made: called by the frame loop with the id of the new display; must not block.
    """

    type: str
    values: dict[str, Any] = msgspec.field(default_factory=dict)
    group: str = ""
    made: Callable[[str], None] = ignore


class RemoveDisplay(Command, frozen=True):
    """Remove a display, or a group with its contents."""

    display: str


class DuplicateDisplay(Command, frozen=True):
    """Add a copy of a display, or of a group with its contents, after it.

    Args:
        display: id of the display or group.
        made: called by the frame loop with the id of the copy; must not block.
    """

    display: str
    made: Callable[[str], None] = ignore


class ResetDisplay(Command, frozen=True):
    """Give the properties of a display their defaults, but for its name, switch and topics."""

    display: str


class MoveDisplay(Command, frozen=True):
    """Move a display or a group in the list.

    Args:
        display: id of the display or group.
        group: id of the group; "" is the list itself.
        before: id of the entry of that group that follows it; "" is the end.
    """

    display: str
    group: str = ""
    before: str = ""


class TraceDisplay(Command, frozen=True):
    """Trace the next sample that a display draws.

    Args:
        display: id of the display.
        answer: gets the times; cancel it to stop waiting.
    """

    display: str
    answer: Future[Trace]


class DragHandle(Command, frozen=True):
    """Do something with a handle; see `webviz.api.handles.Drag`.

    Args:
        display: id of the display that has it.
        drag: what is done.
    """

    display: str
    drag: Drag
