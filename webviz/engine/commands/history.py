"""Commands that take changes back."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class Undo(Command):
    """Take back the newest steps that changed displays, tools, settings or saved views.

    Args:
        steps: how many.
    """

    steps: int = 1


@dataclass(frozen=True)
class Redo(Command):
    """Do again what was taken back.

    Args:
        steps: how many.
    """

    steps: int = 1
