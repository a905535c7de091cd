"""Commands for time."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class Reset(Command):
    """Discard transforms and messages, as RViz's Reset does."""


@dataclass(frozen=True)
class Pause(Command):
    """Pause or resume; messages wait while paused."""

    paused: bool = True
