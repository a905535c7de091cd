"""The state of a link over Zenoh, as everybody sees it."""

from __future__ import annotations

from webviz.sources.zenoh.discovered import GraphSnapshot

BRIDGE_LIMITS = ("zenoh-bridge-ros2dds does not report which nodes publish, subscribe and serve.",)


def remarks(graph: GraphSnapshot, silent_s: float) -> tuple[str, ...]:
    """Return sentences about an open link.

    Args:
        graph: the newest one.
        silent_s: seconds for which an answer of the router is overdue; 0 if it is not.
    """
    stall = f"The Zenoh router has not answered for {silent_s:.0f} s. Check the network."
    return (*([stall] if silent_s else []), *graph.remarks)


def limits(graph: GraphSnapshot) -> tuple[str, ...]:
    """Return sentences on what does not come over the link."""
    return BRIDGE_LIMITS if "zenoh-bridge-ros2dds" in graph.transports else ()
