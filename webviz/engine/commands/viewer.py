"""Commands for the viewer as a whole: its scene, its time, its history, its plug-ins."""

from __future__ import annotations

from pathlib import Path

from webviz.api.declared import Color
from webviz.engine.commands.command import Command


class SetFixedFrame(Command, frozen=True):
    """Set the frame that everything is drawn in."""

    frame: str


class SetBackground(Command, frozen=True):
    """Set the background colour; None follows the theme of each page."""

    color: Color | None


class SetFrameRate(Command, frozen=True):
    """Set the maximum number of scene updates per second."""

    hz: float


class Reset(Command, frozen=True):
    """Discard transforms and messages, as RViz's Reset does."""


class Pause(Command, frozen=True):
    """Pause or resume; messages wait while paused."""

    paused: bool = True


class Undo(Command, frozen=True):
    """Take back the newest steps that changed displays, tools, settings or saved views.

    Args:
        steps: how many.
        own: prefer those of the sender; what others have done since stays.
    """

    steps: int = 1
    own: bool = False


class Redo(Command, frozen=True):
    """Do again what was taken back.

    Args:
        steps: how many.
        own: prefer what the sender has taken back.
    """

    steps: int = 1
    own: bool = False


class ReloadPlugin(Command, frozen=True):
    """Reload a plug-in file after it was saved."""

    path: Path
