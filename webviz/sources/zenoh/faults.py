"""Faults of a graph that are visible in its tokens alone, as sentences with a remedy."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Collection, Iterator, Mapping

from webviz.data.words import listed
from webviz.sources.names import is_own
from webviz.sources.zenoh.tokens import NO_HASH, GraphEntity

NAMED = 3
"""Topics that one sentence names."""
IDLE_BRIDGE = (
    "A zenoh-bridge-ros2dds routes nothing. Start it in the ROS_DOMAIN_ID of the robot, and check "
    "the lists `allow` and `deny` of its config."
)
Endpoints = Mapping[str, Collection[GraphEntity]]
"""Endpoints by topic."""


def faults(
    entities: Collection[GraphEntity], publishers: Endpoints, readers: Endpoints
) -> Iterator[str]:
    """Yield a sentence for each kind of fault.

    Args:
        entities: all of the graph.
        publishers, readers: endpoints by topic.
    """
    bridged = [each for each in entities if each.is_bridged]
    idle = {each.session for each in bridged if each.kind == "bridge"}
    if idle - {each.session for each in bridged if each.kind != "bridge"}:
        yield IDLE_BRIDGE
    both, twice = doubled(publishers)
    if both:
        yield (
            f"Two ways lead to one robot: {listed(both, NAMED)} come over rmw_zenoh and through "
            "zenoh-bridge-ros2dds. Stop the bridge; webviz reads rmw_zenoh only."
        )
    if twice:
        yield (
            f"Each message on {listed(twice, NAMED)} may come twice, through two "
            "zenoh-bridge-ros2dds. Run one per robot, with a `namespace` of its own."
        )
    apart = [t for t, of_topic in publishers.items() if _are_apart(of_topic, readers.get(t, ()))]
    if apart:
        yield (
            f"Publishers and subscriptions of {listed(sorted(apart), NAMED)} have different "
            "versions of its type, so nothing passes between them. Run both with the same ROS "
            "distribution and build of the package."
        )


def doubled(publishers: Endpoints) -> tuple[list[str], list[str]]:
    """Return the topics that come with and without a bridge, and those of two bridges; sorted."""
    both: list[str] = []
    twice: list[str] = []
    for topic, of_topic in publishers.items():
        bridges = {each.session for each in of_topic if each.is_bridged}
        if bridges and not all(each.is_bridged for each in of_topic):
            both.append(topic)
        elif len(bridges) > 1:
            twice.append(topic)
    return sorted(both), sorted(twice)


def _are_apart(publishers: Collection[GraphEntity], readers: Collection[GraphEntity]) -> bool:
    """Return whether a subscription of the network matches no publisher by the hash of its type.

    Humble has no hashes, so that its nodes never meet those of later distributions.
    """
    hashes = defaultdict[str, set[str]](set)
    for each in publishers:
        if not each.is_bridged and not is_own(each.node):
            hashes[each.type].add(each.hash or NO_HASH)
    return any(
        hashes[each.type] and (each.hash or NO_HASH) not in hashes[each.type]
        for each in readers
        if not each.is_bridged and not is_own(each.node) and each.type in hashes
    )
