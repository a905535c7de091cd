"""Commands for the viewer as a whole: its scene, its time, its history, its plug-ins."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from webviz.api.declared import Color
from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class SetFixedFrame(Command):
    """Set the frame that everything is drawn in."""

    frame: str


@dataclass(frozen=True)
class SetBackground(Command):
    """Set the background colour; None follows the theme of each page."""

    color: Color | None


@dataclass(frozen=True)
class SetFrameRate(Command):
    """Set the maximum number of scene updates per second."""

    hz: float


@dataclass(frozen=True)
class Reset(Command):
    """Discard transforms and messages, as RViz's Reset does."""


@dataclass(frozen=True)
class Pause(Command):
    """Pause or resume; messages wait while paused."""

    paused: bool = True


@dataclass(frozen=True)
class Undo(Command):
    """Take back the newest steps that changed displays, tools, settings or saved views.

    Args:
        steps: how many.
        own: prefer those of the sender; what others have done since stays.
    """

    steps: int = 1
    own: bool = False


@dataclass(frozen=True)
class Redo(Command):
    """Do again what was taken back.

    Args:
        steps: how many.
        own: prefer what the sender has taken back.
    """

    steps: int = 1
    own: bool = False


@dataclass(frozen=True)
class ReloadPlugin(Command):
    """Reload a plug-in file after it was saved."""

    path: Path
