"""Commands for plug-ins."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class ReloadPlugin(Command):
    """Reload a plug-in file after it was saved."""

    path: Path
