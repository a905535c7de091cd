"""Commands for panels."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class Refresh(Command):
    """Update panels at once, such as after another tab was selected."""


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
