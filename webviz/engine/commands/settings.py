"""Commands for the scene as a whole."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.api.declared import Color
from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class SetFixedFrame(Command):
    """Set the frame that everything is drawn in."""

    frame: str


@dataclass(frozen=True)
class SetBackground(Command):
    """Set the background colour."""

    color: Color


@dataclass(frozen=True)
class SetFrameRate(Command):
    """Set the maximum number of scene updates per second."""

    hz: float
