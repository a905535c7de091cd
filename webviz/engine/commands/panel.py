"""Commands for the panel."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class Refresh(Command):
    """Update panels at once, such as after another tab was selected."""
