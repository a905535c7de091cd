"""The base class of commands, and their senders."""

from dataclasses import dataclass


class Command:
    """Base of all commands; each is a frozen dataclass that one part of the viewer handles."""


@dataclass(frozen=True)
class Sender:
    """The sender of a command.

    Args:
        browser: id of the browser; None for Python, ROS and the command line.
        step: commands of one sender with the same number are undone together; 0 is none.
    """

    browser: int | None = None
    step: int = 0


PROGRAM = Sender()
"""Python, ROS and the command line."""


def ignore(result: object) -> None:
    """The default callback of commands: ignore the result."""
