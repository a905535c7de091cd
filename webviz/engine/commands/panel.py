"""Commands for panels."""

from __future__ import annotations

from webviz.engine.commands.command import Command


class Refresh(Command, frozen=True):
    """Update panels at once, such as after another tab was selected."""
