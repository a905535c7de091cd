"""Commands that read or write configs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from webviz.engine.commands.command import Command


class FileCommand(Command):
    """A command that reads or writes a config; these run in a thread, in order."""


@dataclass(frozen=True)
class Open(FileCommand):
    """Replace the current config by that of a file."""

    path: str


@dataclass(frozen=True)
class Load(FileCommand):
    """Replace the current config by that of a text.

    Args:
        text: YAML, or RViz's format if the name ends with .rviz.
        name: of the file it came from, which is not accessed.
    """

    text: str
    name: str


@dataclass(frozen=True)
class Save(FileCommand):
    """Save the current config to a file; "" is the file it came from."""

    path: str = ""


@dataclass(frozen=True)
class WriteDisplays(FileCommand):
    """Answer with the text that a config file has of displays, and of all that is in groups."""

    displays: tuple[str, ...]


@dataclass(frozen=True)
class Export(FileCommand):
    """Pass on the current config as text, such as for a download.

    Args:
        deliver: called by the frame loop with the text; must not block.
        name: of the file it is for; RViz's format if it ends with .rviz, else YAML.
    """

    deliver: Callable[[str], None]
    name: str = ""
