"""Commands that read or write configs."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path, PurePath

from webviz.data.words import counted
from webviz.engine.commands.command import Command
from webviz.files.config import Config


class FileCommand(Command, frozen=True):
    """A command that reads or writes a config; these run in a thread, in order."""


class Open(FileCommand, frozen=True):
    """Replace the current config by that of a file."""

    path: str

    @property
    def label(self) -> str:
        """Names the file."""
        return f"Open {PurePath(self.path).name}"


class Load(FileCommand, frozen=True):
    """Replace the current config by that of a text.

    Args:
        text: YAML, or RViz's format if the name ends with .rviz.
        name: of the file it came from, which is not accessed.
    """

    text: str
    name: str

    @property
    def label(self) -> str:
        """Names the file."""
        return f"Open {self.name}"


class Restore(Command, frozen=True):
    """Show the unsaved changes of the last session; undo brings back the config as it is saved.

    Args:
        config: as it was shown.
        path: of the config file that was open, None for none.
    """

    config: Config
    path: Path | None

    @property
    def label(self) -> str:
        """Says how much there is."""
        return f"Restore {self.amount}"

    @property
    def amount(self) -> str:
        """The number of displays, in words."""
        return counted(len(self.config.displays), "display")


class Save(FileCommand, frozen=True):
    """Save the current config to a file; "" is the file it came from."""

    path: str = ""

    @property
    def label(self) -> str:
        """Names the file."""
        return f"Save as {PurePath(self.path).name}"


class WriteDisplays(FileCommand, frozen=True):
    """Answer with the text that a config file has of displays, and of all that is in groups."""

    displays: tuple[str, ...]


class Export(FileCommand, frozen=True):
    """Pass on the current config as text, such as for a download.

    Args:
        deliver: called by the frame loop with the text; must not block.
        name: of the file it is for; RViz's format if it ends with .rviz, else YAML.
    """

    deliver: Callable[[str], None]
    name: str = ""
