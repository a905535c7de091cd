"""What is about transforms."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class InspectTransforms(Command):
    """Report on the tree of transforms, or no longer."""

    inspect: bool = True
