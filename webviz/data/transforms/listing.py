"""tf2's listing of all frames."""

from __future__ import annotations

from collections.abc import Mapping

from webviz.data.transforms.errors import format_stamp, stamp_to_seconds
from webviz.data.transforms.publishers import Publishers
from webviz.data.transforms.tree import FrameTree

SHORTEST_SPAN_NS = 100_000
"""Lower limit of the history from which tf2 computes a rate; static frames get 10 kHz."""


def frames_as_yaml(tree: FrameTree, publishers: Mapping[str, Publishers], now_ns: int) -> str:
    """Return tf2's all_frames_as_yaml, which `view_frames` reads.

    `transform_delay` is omitted if `now_ns` is 0.
    """
    if not tree.names:
        return "[]"
    parts: list[str] = []
    for name in tree.names:
        cache = tree.caches.get(name)
        if cache is None or (newest := cache.newest) is None:
            continue
        span_ns = cache.newest_stamp - cache.oldest_stamp
        rate = len(cache) * 1e9 / max(span_ns, SHORTEST_SPAN_NS)
        parts += (
            f"{name}: ",
            f"  parent: '{newest[1]}'",
            f"  broadcaster: '{publishers[name].current}'",
            f"  rate: {rate:.3f}",
            f"  most_recent_transform: {format_stamp(cache.newest_stamp)}",
            f"  oldest_transform: {format_stamp(cache.oldest_stamp)}",
        )
        if now_ns:
            delay = stamp_to_seconds(now_ns - cache.newest_stamp)
            parts.append(f"  transform_delay: {delay:.3f}")
        parts.append(f"  buffer_length: {stamp_to_seconds(span_ns):.3f}")
    return "".join(f"{part}\n" for part in parts)
