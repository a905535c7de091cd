"""Commands for layouts: which panels stand beside, below and over the scene."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command
from webviz.files.config.layout import Layout


@dataclass(frozen=True)
class SetLayout(Command):
    """Arrange the panels in all browsers.

    Args:
        layout: a layout, or the name of a saved one.
        name: of the saved layout to change instead, "" for the one that browsers show.
    """

    layout: Layout | str
    name: str = ""


@dataclass(frozen=True)
class SaveLayout(Command):
    """Save the layout under a name; replaces a saved layout of that name."""

    name: str


@dataclass(frozen=True)
class RemoveLayout(Command):
    """Remove a saved layout."""

    name: str
