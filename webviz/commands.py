"""What people ask of a viewer: queued by the panel, services or Python, done by the frame loop."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class SetProperty:
    """Change a property of a display; nested ones have a dotted path, such as `topic.name`."""

    display: str
    path: str
    value: Any


@dataclass(frozen=True)
class AddDisplay:
    """Add a display at the end of the list, or of a group."""

    type: str
    values: dict[str, Any] = field(default_factory=dict)
    group: str = ""


@dataclass(frozen=True)
class RemoveDisplay:
    """Remove a display."""

    display: str


@dataclass(frozen=True)
class SetFixedFrame:
    """Choose the frame that everything is drawn in."""

    frame: str


@dataclass(frozen=True)
class Reset:
    """Forget transforms and messages, as RViz's Reset does."""


@dataclass(frozen=True)
class ReloadPlugin:
    """Load a file with displays again, after it was saved."""

    path: Path


Command = SetProperty | AddDisplay | RemoveDisplay | SetFixedFrame | Reset | ReloadPlugin
