"""The panel Graph: nodes and topics, and who sends what to whom."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from fnmatch import translate
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Prop
from webviz.api.offer import Endpoint, Offer
from webviz.api.panel import Panel, Send, Ui
from webviz.data.names import readable
from webviz.data.words import counted

MAX_TOPICS = 5000
"""Topics that are shown; of more, the first by name."""
MAX_ENDS = 200
"""Publishers, and subscriptions, of a topic."""
MAX_NAME = 256
"""Characters of a name."""
PER_PART = 50
"""Topics that pages receive at once."""


class NodeGraph(Panel):
    """Nodes and topics as a graph, with rates, and the QoS that does not match."""

    title = "Graph"
    icon = "orbit"
    opens = "below"
    module = "graph.js"

    hide: Annotated[
        list[Annotated[str, msgspec.Meta(max_length=MAX_NAME)]],
        msgspec.Meta(max_length=100),
        Prop(help="Topics and nodes that are left out; * matches any characters."),
    ] = msgspec.field(default_factory=lambda: ["/rosout", "/parameter_events", "/webviz"])
    hidden: Annotated[
        bool,
        Prop(help="Show topics whose names begin with _, such as those of actions, too."),
    ] = False

    def __post_init__(self) -> None:
        """Begin without a graph."""
        self.made_of: tuple[Any, ...] = ()
        self.parts: dict[str, Mapping[str, Any]] = {}
        self.values: dict[str, Any] = {}

    def build(self, ui: Ui, send: Send) -> None:
        """Show the graph."""
        self.graph = ui.widget("graph", {}, lambda value, browser: None)

    def show(self, offers: Mapping[str, Offer]) -> None:
        """Show the graph, made anew if it has changed."""
        if self.made_of[1:] != (tuple(self.hide), self.hidden) or self.made_of[0] is not offers:
            self.made_of = offers, tuple(self.hide), self.hidden
            self._make(offers)
        self.graph.show(self.values, self.parts)

    def _make(self, offers: Mapping[str, Offer]) -> None:
        is_hidden = re.compile("|".join(map(translate, self.hide)) or "(?!)").match
        names = [
            name
            for name in sorted(offers)
            if not is_hidden(name) and (self.hidden or "/_" not in name)
        ]
        limited = names[:MAX_TOPICS]
        topics = [topic_of(name, offers[name], is_hidden) for name in limited]
        parts: dict[str, Mapping[str, Any]] = {}
        for at in range(0, len(topics), PER_PART):
            key = str(at // PER_PART)
            part = {"topics": topics[at : at + PER_PART]}
            former = self.parts.get(key)
            parts[key] = former if former == part and former is not None else part
        self.parts = parts
        more = len(names) - len(limited)
        problem = f"{counted(more, 'topic')} not shown; the limit is {MAX_TOPICS}." if more else ""
        if not names:
            problem = "No topics. Start a node, or show hidden topics."
        self.values = {"parts": len(parts), "problem": problem}


def topic_of(name: str, offer: Offer, is_hidden: Any) -> Mapping[str, Any]:
    """Return a topic for pages: its name and types, and the nodes at both of its ends.

    Of each subscription `[node, why]`, where "" means that messages reach it.
    """
    writers = [each for each in offer.publishers if not is_hidden(each.node)]
    readers = [each for each in offer.readers if not is_hidden(each.node)]
    types = dict.fromkeys(each.type for each in (*offer.publishers, *offer.readers))
    published = dict.fromkeys(map(_label, writers[:MAX_ENDS]))
    read: dict[str, str] = {}
    for each in readers[:MAX_ENDS]:
        label = _label(each)
        read[label] = read.get(label) or (
            "" if offer.is_recorded else mismatch(each, offer.publishers)
        )
    return {
        "name": readable(name[:MAX_NAME]),
        "type": readable(", ".join(types)[:MAX_NAME]),
        "from": list(published),
        "to": [[node, why] for node, why in read.items()],
    }


def mismatch(reader: Endpoint, writers: Sequence[Endpoint]) -> str:
    """Return why messages of some publisher do not reach a subscription, a sentence or ""."""
    return next((why for writer in writers for why in _reasons(reader, writer)), "")


def _reasons(reader: Endpoint, writer: Endpoint) -> Iterator[str]:
    ends = f"{_label(reader)} asks for", f"{_label(writer)} offers"
    if reader.type != writer.type:
        yield f"{ends[0]} {readable(reader.type)}, but {ends[1]} {readable(writer.type)}."
    for name, more, less in (
        ("reliability", "reliable", "best_effort"),
        ("durability", "transient_local", "volatile"),
    ):
        if getattr(reader, name) == more and getattr(writer, name) == less:
            requested, offered = more.replace("_", " "), less.replace("_", " ")
            yield f"{ends[0]} {requested}, but {ends[1]} {offered}."


def _label(end: Endpoint) -> str:
    return readable(end.label[:MAX_NAME])
