"""What is about time."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class Reset(Command):
    """Forget transforms and messages, as RViz's Reset does."""


@dataclass(frozen=True)
class Pause(Command):
    """Let time stand still on the page, or go on; messages wait meanwhile."""

    paused: bool = True
