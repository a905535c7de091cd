"""Commands for reports on topics and transforms."""

from __future__ import annotations

from webviz.engine.commands.command import Command


class InspectTopic(Command, frozen=True):
    """Follow a topic that need not be shown: its rate and its last message; "" is none.

    Programs and plug-ins follow one at a time, besides those that pages follow.
    """

    topic: str


class InspectTopics(Command, frozen=True):
    """Follow exactly these topics for all pages; the viewer itself keeps count of who looks."""

    topics: frozenset[str]


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
