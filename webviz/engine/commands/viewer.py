"""Commands for the viewer as a whole: its scene, its time, its history, its plug-ins."""

from __future__ import annotations

from pathlib import Path

from webviz.engine.commands.command import Command


class ReloadPlugin(Command, frozen=True):
    """Reload a plug-in file after it was saved."""

    path: Path
