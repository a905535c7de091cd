"""Commands for panels."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class Refresh(Command):
    """Update panels at once, such as after another tab was selected."""


@dataclass(frozen=True)
class AddPanel(Command):
    """Add a panel of a plug-in behind the others.

    Args:
        type: name of the panel type.
        values: its properties, as in a config file.
    """

    type: str
    values: dict[str, Any] = field(default_factory=dict)


@dataclass(frozen=True)
class RemovePanel(Command):
    """Remove a panel of a plug-in, by its id or name."""

    panel: str


@dataclass(frozen=True)
class SetPanelProperty(Command):
    """Change a property of a panel of a plug-in; nested ones have a dotted path.

    Args:
        panel: its id or name.
        path: of the property.
        value: as in a config file.
    """

    panel: str
    path: str
    value: Any


@dataclass(frozen=True)
class OpenPanels(Command):
    """Say which panels of plug-ins are open in any browser; the others rest.

    Args:
        panels: names of their tabs.
    """

    panels: frozenset[str]
