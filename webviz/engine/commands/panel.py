"""What is about the panel itself."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class Refresh(Command):
    """Show a new state at once, since somebody asked a panel for something else of it."""
