"""Messages of an interactive marker server, read in any thread."""

from __future__ import annotations

from collections.abc import Mapping, Sequence, Set
from typing import Any, NamedTuple

import msgspec
from msgspec.structs import replace

from webviz.data.messages import decode
from webviz_displays.interactive_markers.completion import (
    Completed,
    RefusedMarker,
    completed,
    pose_of,
)
from webviz_displays.interactive_markers.tracked import Place

SERVICE = "visualization_msgs/srv/GetInteractiveMarkers"
UPDATE = "visualization_msgs/msg/InteractiveMarkerUpdate"
KEEP_ALIVE = 0
MAX_MARKERS = 10_000
"""Markers of a server, and new poses of a message."""


class News(msgspec.Struct, frozen=True):
    """Changes of the markers of a server.

    Args:
        markers: new or changed ones, by name.
        poses: new poses by the names of markers; None for one that cannot be used.
        erased: names of markers that are gone.
        ignored: number of markers and poses beyond the limit.
        is_all: whether these are all markers.
    """

    markers: Mapping[str, Completed | RefusedMarker] = msgspec.field(default_factory=dict)
    poses: Mapping[str, Place | None] = msgspec.field(default_factory=dict)
    erased: Set[str] = frozenset()
    ignored: int = 0
    is_all: bool = False


class ServerMessage(NamedTuple):
    """A message of a server.

    Args:
        number: of an update, which follows that of the update before; that of an answer is the
            number of the last update that it includes.
        news: None for a sign of life.
    """

    number: int
    news: News | None


def read_answer(cdr: bytes) -> ServerMessage:
    """Read the response of the service.

    Raises:
        MessageError: it cannot be decoded; one sentence.
    """
    answer = decode(f"{SERVICE}_Response", cdr)
    markers, ignored = _markers(answer.markers)
    return ServerMessage(int(answer.sequence_number), News(markers, ignored=ignored, is_all=True))


def read_update(cdr: bytes) -> ServerMessage:
    """Read a message of the topic.

    Raises:
        MessageError: it cannot be decoded; one sentence.
    """
    update = decode(UPDATE, cdr)
    if update.type == KEEP_ALIVE:
        return ServerMessage(int(update.seq_num), None)
    markers, ignored = _markers(update.markers)
    poses = {str(each.name): _place(each) for each in update.poses[:MAX_MARKERS]}
    ignored += max(0, len(update.poses) - MAX_MARKERS)
    erased = frozenset(str(name) for name in update.erases)
    return ServerMessage(int(update.seq_num), News(markers, poses, erased, ignored))


def _markers(messages: Sequence[Any]) -> tuple[dict[str, Completed | RefusedMarker], int]:
    """Complete the markers of a message; how many are beyond the limit."""
    by_name: dict[str, Completed | RefusedMarker] = {}
    counts: dict[str, int] = {}
    for message in messages[:MAX_MARKERS]:
        marker = completed(message)
        counts[marker.name] = counts.get(marker.name, 0) + 1
        by_name[marker.name] = marker
    for name, count in counts.items():
        marker = by_name[name]
        if count > 1 and isinstance(marker, Completed):
            text = f"{count} markers of a message have this name. Correct the server."
            by_name[name] = replace(marker, problems=(text, *marker.problems))
    return by_name, max(0, len(messages) - MAX_MARKERS)


def _place(message: Any) -> Place | None:
    pose = pose_of(message.pose)
    if pose is None:
        return None
    return Place(str(message.header.frame_id).removeprefix("/"), message.header.stamp_ns, pose)
