"""The base class of commands, and their senders."""

from dataclasses import dataclass, field

import msgspec

MAX_PRIORITY = 3


class Command(msgspec.Struct, frozen=True):
    """Base of all commands; one part of the viewer handles each."""

    @property
    def label(self) -> str:
        """The label of the step that undoes it; "" derives it from what has changed."""
        return ""


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
