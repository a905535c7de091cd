"""The topics of the graph, and one that somebody looks into."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.commands import Command, InspectTopic, Sender
from webviz.engine.parts.part import Batches, Core, Handler, Part
from webviz.engine.pipeline.topic_monitor import TopicMonitor
from webviz.engine.sources import Subscription


class TopicsPart(Part):
    """What is published, how fast, and the last message of one topic."""

    name = "Topics"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self._monitor = TopicMonitor(core.source.inbox, core.clock)

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """What does each of its commands."""
        return {InspectTopic: self._inspect}

    def subscriptions(self) -> Mapping[str, Subscription]:
        """What somebody looks into, while a browser is open."""
        return self._monitor.subscription(self.core.offers) if self.core.is_watched() else {}

    def take(self, batches: Batches) -> None:
        """Keep the newest message of the topic that somebody looks into."""
        self._monitor.take(batches)

    def state(self) -> Mapping[str, Any]:
        """All topics."""
        offers = self.core.offers
        return {
            "topics": {
                topic: tuple(sorted({publisher.type for publisher in offer.publishers}))
                for topic, offer in offers.items()
            },
            "offers": offers,
            "traffic": self._monitor.traffic(),
            "inspected": self._monitor.look(offers),
        }

    def _inspect(self, command: InspectTopic, sender: Sender) -> None:
        self._monitor.inspected = command.topic
