"""Commands for transforms."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class InspectTransforms(Command):
    """Start or stop showing the tree of transforms."""

    inspect: bool = True
