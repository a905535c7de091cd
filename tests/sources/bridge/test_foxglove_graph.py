"""The graph of nodes that a Foxglove server tells."""

from __future__ import annotations

import pytest

from webviz.sources.bridge import foxglove_channels
from webviz.sources.bridge.foxglove_channels import ConnectionGraph
from webviz.sources.bridge.foxglove_wire import (
    AdvertisedService,
    ConnectionGraphUpdate,
    PublishedTopic,
    SubscribedTopic,
)


def test_topics_and_services_come_and_go() -> None:
    graph = ConnectionGraph()
    assert graph.subscribers("/scan") is None
    graph.update(
        ConnectionGraphUpdate(
            published_topics=(PublishedTopic("/scan", ("/lidar", "/fake", "/lidar")),),
            subscribed_topics=(SubscribedTopic("/scan", ("/nav",)),),
            advertised_services=(AdvertisedService("/plan", ("/planner",)),),
        )
    )
    assert graph.publishers("/scan") == ("/fake", "/lidar")
    assert graph.subscribers("/scan") == ("/nav",)
    assert graph.nodes == ("/fake", "/lidar", "/nav", "/planner")
    graph.update(ConnectionGraphUpdate(removed_topics=("/scan",), removed_services=("/plan",)))
    assert (graph.publishers("/scan"), graph.subscribers("/scan"), graph.nodes) == ((), (), ())


def test_a_graph_is_bounded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(foxglove_channels, "MAX_NAMES", 3)
    graph = ConnectionGraph()
    topics = tuple(PublishedTopic(f"/{number}", ("/node",)) for number in range(5))
    for count, expected in ((3, 3), (5, 3)):
        graph.update(ConnectionGraphUpdate(published_topics=topics[:count]))
        assert sum(bool(graph.publishers(topic.name)) for topic in topics) == expected
