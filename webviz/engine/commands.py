"""The base classes of commands, and their senders; the commands are methods of parts."""

from __future__ import annotations

from dataclasses import dataclass, field

import msgspec

from webviz.data.words import shortened

__all__ = [
    "MAX_PRIORITY",
    "PROGRAM",
    "Command",
    "FileCommand",
    "NodePicks",
    "Pick",
    "Sender",
    "mistaken",
    "wrong_text",
]

MAX_PRIORITY = 3
MAX_QUOTED = 80


class Command(msgspec.Struct, frozen=True):
    """Base of all commands; one part of the viewer handles each."""

    @property
    def label(self) -> str:
        """The label of the step that undoes it; "" derives it from what has changed."""
        return ""


class FileCommand(Command, frozen=True):
    """A command that reads or writes a config; these run in a thread, in order."""


class PageCommand(msgspec.Struct, frozen=True):
    """Base of commands that the server carries out for pages without the frame loop."""


def wrong_text(command: Command) -> str:
    """Return which field of a command is not the text that it must be, as a sentence; "" if none.

    Pages' commands are checked when they come; Python may give anything. Numbers and other values
    are checked by the parts that use them.
    """
    for each in msgspec.structs.fields(type(command)):
        value = getattr(command, each.name)
        if each.type is str and not isinstance(value, str):
            return mistaken(f"{type(command).__name__}.{each.name}", "text", value)
    return ""


def mistaken(name: str, expected: str, value: object) -> str:
    """Return the sentence that what has this name is not of the expected kind."""
    got = "nothing" if value is None else f"`{shortened(str(value), MAX_QUOTED)}`"
    return f"{name}: expected {expected}, got {got}."


@dataclass(frozen=True)
class Sender:
    """The sender of a command.

    Args:
        browser: id of the browser; None for Python, ROS and the command line.
        step: commands of one sender with the same number are undone together; 0 is none.
        priority: 1 to MAX_PRIORITY; who has less can neither delay files nor fill the queue.
    """

    browser: int | None = None
    step: int = 0
    priority: int = field(default=MAX_PRIORITY, compare=False)


PROGRAM = Sender()
"""Python, ROS and the command line."""


def ignore(result: object) -> None:
    """Ignore the result, as callbacks of commands do by default."""


Position = tuple[float, float, float]

Pick = tuple[int, int | None, Position, tuple[int, int, int] | None]
"""One thing in a picture.

The id that the browser gave it; its number in the node, None for meshes and images; where it is, or
was clicked on a mesh or image, in the coordinates that were sent (the start of a line, any position
along an arrow); and the colour of a point, None if all have the same.
"""


class NodePicks(msgspec.Struct, frozen=True):
    """Things of one node.

    Args:
        group, key: of the node in the scene.
        items: see `Pick`.
    """

    group: str
    key: str
    items: tuple[Pick, ...]
