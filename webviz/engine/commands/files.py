"""What reads or writes configs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from webviz.engine.commands.command import Command


class FileCommand(Command):
    """What reads or writes configs; it is done beside the frame loop, in order."""


@dataclass(frozen=True)
class Open(FileCommand):
    """Show what a config file says instead of what is shown."""

    path: str


@dataclass(frozen=True)
class Load(FileCommand):
    """Show what the text of a config says instead of what is shown.

    Args:
        text: YAML, or RViz's if the name ends with .rviz.
        name: of the file it came from; it is not read or written.
    """

    text: str
    name: str


@dataclass(frozen=True)
class Save(FileCommand):
    """Write what is shown to a file, "" to where it came from."""

    path: str = ""


@dataclass(frozen=True)
class WriteDisplays(FileCommand):
    """Answer with the text that a config file has of displays, and of all that is in groups."""

    displays: tuple[str, ...]


@dataclass(frozen=True)
class Export(FileCommand):
    """Hand what is shown to somebody as the text of a config, such as a browser that downloads it.

    Args:
        deliver: called with that text by the frame loop, so it must not block.
        name: of the file it is for; RViz's text if it ends with .rviz, else YAML.
    """

    deliver: Callable[[str], None]
    name: str = ""
