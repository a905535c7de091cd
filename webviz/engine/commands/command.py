"""The base class of commands, and their senders."""

from dataclasses import dataclass


class Command:
    """Base of all commands; each is a frozen dataclass that one part of the viewer handles."""


@dataclass(frozen=True)
class Sender:
    """The sender of a command.

    Args:
        browser: id of the browser; None for Python, ROS and the command line.
    """

    browser: int | None = None


PROGRAM = Sender()
"""Python, ROS and the command line."""


def ignore(result: object) -> None:
    """The default callback of commands: ignore the result."""
