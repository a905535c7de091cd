"""The nodes behind a Foxglove server, as its connection graph tells them."""

from __future__ import annotations

from webviz.sources.bridge import foxglove_wire as wire

MAX_NAMES = 100_000
"""Topics and services in the graph; more are ignored."""


class ConnectionGraph:
    """Publishers and subscribers by topic; it begins empty, and is updated by differences."""

    def __init__(self) -> None:
        self._publishers: dict[str, tuple[str, ...]] = {}
        self._subscribers: dict[str, tuple[str, ...]] = {}
        self._providers: dict[str, tuple[str, ...]] = {}
        self._is_known = False
        self.nodes: tuple[str, ...] = ()
        """Full names, sorted."""

    def update(self, change: wire.ConnectionGraphUpdate) -> None:
        """Apply a difference."""
        self._is_known = True
        for topic in change.removed_topics:
            self._publishers.pop(topic, None)
            self._subscribers.pop(topic, None)
        for service in change.removed_services:
            self._providers.pop(service, None)
        self._publishers |= {t.name: _names(t.publisher_ids) for t in change.published_topics}
        self._subscribers |= {t.name: _names(t.subscriber_ids) for t in change.subscribed_topics}
        self._providers |= {s.name: _names(s.provider_ids) for s in change.advertised_services}
        tables = (self._publishers, self._subscribers, self._providers)
        for table in tables:
            while len(table) > MAX_NAMES:
                table.popitem()
        self.nodes = tuple(
            sorted({n for table in tables for names in table.values() for n in names})
        )

    def publishers(self, topic: str) -> tuple[str, ...]:
        """Return the nodes that publish a topic."""
        return self._publishers.get(topic, ())

    def subscribers(self, topic: str) -> tuple[str, ...] | None:
        """Return the nodes that subscribe to a topic, None if the graph is unknown."""
        return self._subscribers.get(topic, ()) if self._is_known else None


def _names(ids: tuple[str, ...]) -> tuple[str, ...]:
    """Node names; ids that are no names, as some servers have them, are kept as they are."""
    return tuple(sorted(set(ids)))
