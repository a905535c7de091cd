"""Commands for reports on topics and transforms."""

from __future__ import annotations

from webviz.engine.commands.command import Command


class InspectTransforms(Command, frozen=True):
    """Report on the transforms while they are shown.

    Args:
        tree: whether on the tree of all frames.
        between: pairs of frames, target and source, between which transforms are read out.
    """

    tree: bool = True
    between: frozenset[tuple[str, str]] = frozenset()


class LookUpTransform(Command, frozen=True):
    """Answer with the newest transform between two frames, in words."""

    target: str
    source: str
