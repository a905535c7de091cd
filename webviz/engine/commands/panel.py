"""Commands for panels."""

from __future__ import annotations

from typing import Any

import msgspec

from webviz.engine.commands.command import Command


class Refresh(Command, frozen=True):
    """Update panels at once, such as after another tab was selected."""


class AddPanel(Command, frozen=True):
    """Add a panel of a plug-in behind the others.

    Args:
        type: name of the panel type.
        values: its properties, as in a config file.
    """

    type: str
    values: dict[str, Any] = msgspec.field(default_factory=dict)


class RemovePanel(Command, frozen=True):
    """Remove a panel of a plug-in, by its id or name."""

    panel: str


class SetPanelProperty(Command, frozen=True):
    """Change a property of a panel of a plug-in; nested ones have a dotted path.

    Args:
        panel: its id or name.
        path: of the property.
        value: as in a config file.
    """

    panel: str
    path: str
    value: Any


class OpenPanels(Command, frozen=True):
    """Say which panels of plug-ins are open in any browser; the others rest.

    Args:
        panels: names of their tabs.
    """

    panels: frozenset[str]
