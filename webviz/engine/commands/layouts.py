"""Commands for layouts: which panels stand beside, below and over the scene."""

from __future__ import annotations

from webviz.engine.commands.command import Command
from webviz.files.config.layout import Layout


class SetLayout(Command, frozen=True):
    """Arrange the panels in all browsers.

    Args:
        layout: a layout, or the name of a saved one.
        name: of the saved layout to change instead, "" for the one that browsers show.
    """

    layout: Layout | str
    name: str = ""


class SaveLayout(Command, frozen=True):
    """Save the layout under a name; replaces a saved layout of that name."""

    name: str


class RemoveLayout(Command, frozen=True):
    """Remove a saved layout."""

    name: str
