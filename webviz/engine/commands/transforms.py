"""What is about transforms."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class InspectTransforms(Command):
    """Report on the transforms while they are shown.

    Args:
        tree: whether on the tree of all frames.
        between: pairs of frames, target and source, between which transforms are read out.
    """

    tree: bool = True
    between: frozenset[tuple[str, str]] = frozenset()
