"""What all commands are, and who sends them."""

from dataclasses import dataclass


class Command:
    """What somebody asks of a viewer; each kind is a frozen dataclass that one part handles."""


@dataclass(frozen=True)
class Sender:
    """Who sent a command.

    Args:
        browser: id of the browser; None for Python, ROS and the command line.
    """

    browser: int | None = None


PROGRAM = Sender()
"""Python, ROS and the command line."""


def ignore(result: object) -> None:
    """The default callback of commands: ignore the result."""
