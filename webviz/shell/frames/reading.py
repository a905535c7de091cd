"""The tree of transforms of the ROS graph or of a bag."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence

import msgspec

from webviz.data.names import readable
from webviz.data.transforms import Diagnosis, TransformBuffer, diagnose, tree_text
from webviz.engine.pipeline.listener import TransformListener
from webviz.sources import Source
from webviz.sources.player import Player

REST_S = 0.1

Progress = Callable[[str, float], object]
"""Called with what is done and the share of it that is."""


class TreeRead(msgspec.Struct, frozen=True):
    """The tree of transforms at a time.

    Args:
        diagnosis: its frames and faults.
        tree: as indented lines.
        nodes: that publish each topic of transforms.
    """

    diagnosis: Diagnosis
    tree: str
    nodes: Mapping[str, Sequence[str]]

    def notes(self) -> list[str]:
        """Sentences on the publishers."""
        return [
            f"{topic} is published by {', '.join(nodes)}."
            for topic, nodes in self.nodes.items()
            if nodes
        ]

    def text(self) -> str:
        """Return the tree for a terminal, with its faults and publishers."""
        tree = self.tree or "No transforms arrived on /tf or /tf_static."
        return "\n".join([tree, *map(readable, (*self.diagnosis.problems, *self.notes()))])


def read_live(source: Source, seconds: float, progress: Progress) -> TreeRead:
    """Listen to live transforms for some seconds, and read their tree."""
    reader = _Reader(source)
    began = time.monotonic()
    while (passed := time.monotonic() - began) < seconds:
        progress("listening", passed / seconds)
        source.inbox.arrived.wait(REST_S)
        source.inbox.arrived.clear()
        reader.take()
    return reader.read()


def read_bag(bag: Player, at_ns: int, progress: Progress) -> TreeRead:
    """Read the transforms of a bag from its beginning to a time of recording.

    All of them, since a frame that has stopped long ago belongs to the tree.

    Raises:
        BagError: the file can no longer be read.
    """
    reader = _Reader(bag)
    span = max(1, at_ns - bag.history.start_ns)
    while bag.reached_ns < at_ns:
        bag.play_step(at_ns)
        reader.take()
        progress("reading", (bag.reached_ns - bag.history.start_ns) / span)
    return reader.read()


class _Reader:
    def __init__(self, source: Source) -> None:
        self._source = source
        self._buffer = TransformBuffer()
        self._listener = TransformListener(self._buffer, time.monotonic)
        source.want(self._listener.subscriptions())

    def take(self) -> None:
        """Insert what arrived."""
        source = self._source
        if self._listener.take(source.inbox.drain(), source.offers()):
            self._listener.reset()
        source.want(self._listener.subscriptions())

    def read(self) -> TreeRead:
        offers, now_ns = self._source.offers(), self._source.now_ns()
        topics = self._listener.subscriptions()
        nodes = {
            topic: tuple(dict.fromkeys(each.label for each in offers[topic].publishers))
            for topic in topics
            if topic in offers and not offers[topic].is_recorded
        }
        if not nodes:  # each transform of a bag is from the bag
            self._buffer.nodes = {}
        return TreeRead(diagnose(self._buffer, now_ns), tree_text(self._buffer, now_ns), nodes)
