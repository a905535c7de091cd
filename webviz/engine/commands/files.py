"""Commands that read or write configs."""

from __future__ import annotations

from pathlib import Path

from webviz.data.words import counted
from webviz.engine.commands.command import Command
from webviz.files.config import Config


class FileCommand(Command, frozen=True):
    """A command that reads or writes a config; these run in a thread, in order."""


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
