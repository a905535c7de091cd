"""Commands for reports on topics and transforms."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class InspectTopic(Command):
    """Follow a topic that need not be shown: its rate and its last message; "" is none.

    Programs and plug-ins follow one at a time, besides those that pages follow.
    """

    topic: str


@dataclass(frozen=True)
class InspectTopics(Command):
    """Follow exactly these topics for all pages; the viewer itself keeps count of who looks."""

    topics: frozenset[str]


@dataclass(frozen=True)
class InspectLatency(Command):
    """Trace samples of all displays while a page shows their latencies."""

    is_wanted: bool = True


@dataclass(frozen=True)
class InspectTransforms(Command):
    """Report on the transforms while they are shown.

    Args:
        tree: whether on the tree of all frames.
        between: pairs of frames, target and source, between which transforms are read out.
    """

    tree: bool = True
    between: frozenset[tuple[str, str]] = frozenset()


@dataclass(frozen=True)
class LookUpTransform(Command):
    """Answer with the newest transform between two frames, in words."""

    target: str
    source: str
