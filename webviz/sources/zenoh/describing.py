"""The state of a link over Zenoh, as everybody sees it."""

from __future__ import annotations

import functools
from collections.abc import Mapping

from webviz.data.messages import UnknownTypeError, type_hash
from webviz.data.words import listed
from webviz.sources.zenoh.discovered import GraphSnapshot
from webviz.sources.zenoh.faults import NAMED

BRIDGE_LIMITS = ("zenoh-bridge-ros2dds does not report which nodes publish, subscribe and serve.",)


def remarks(
    graph: GraphSnapshot, silent_s: float, survey: str, types: Mapping[str, str]
) -> tuple[str, ...]:
    """Return sentences about an open link.

    Args:
        graph: the newest one.
        silent_s: seconds for which an answer of the router is overdue; 0 if it is not.
        survey: sentence on other domains, "" for none.
        types: wanted ones by topic.
    """
    stall = f"The Zenoh router has not answered for {silent_s:.0f} s. Check the network."
    others = [survey] if survey else []
    return (*([stall] if silent_s else []), *others, *graph.remarks, *_versions(graph, types))


def limits(graph: GraphSnapshot) -> tuple[str, ...]:
    """Return sentences on what does not come over the link."""
    return BRIDGE_LIMITS if "zenoh-bridge-ros2dds" in graph.transports else ()


def _versions(graph: GraphSnapshot, types: Mapping[str, str]) -> list[str]:
    """Return a sentence on topics with another version of their type than the one known here."""
    differing = sorted(
        topic
        for topic, type in types.items()
        for each in graph.publishers.get(topic, ())
        if each.type == type and each.hash.startswith("RIHS01_") and _differs(type, each.hash)
    )
    if not differing:
        return []
    return [
        f"The publishers of {listed(differing, NAMED)} have another version of its type than this "
        "machine, so its messages may be read wrongly. Source the workspace of the robot."
    ]


@functools.lru_cache(1000)
def _differs(type: str, hash: str) -> bool:
    try:
        return type_hash(type) != hash
    except UnknownTypeError:
        return False
