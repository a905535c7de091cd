"""What changes the scene as a whole."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.api.declared import Color
from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class SetFixedFrame(Command):
    """Choose the frame that everything is drawn in."""

    frame: str


@dataclass(frozen=True)
class SetBackground(Command):
    """Choose the colour behind the scene."""

    color: Color


@dataclass(frozen=True)
class SetFrameRate(Command):
    """Choose how often in a second the scene may change."""

    hz: float
