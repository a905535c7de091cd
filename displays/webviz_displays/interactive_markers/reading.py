"""Messages of an interactive marker server, read in any thread."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

from webviz.data.messages import decode
from webviz_displays.interactive_markers.completion import Completed, RefusedMarker, completed

SERVICE = "visualization_msgs/srv/GetInteractiveMarkers"
UPDATE = "visualization_msgs/msg/InteractiveMarkerUpdate"
KEEP_ALIVE = 0
MAX_MARKERS = 5000
"""Of one message; those beyond it are neither completed nor shown."""


class MarkerAnswer(NamedTuple):
    """All markers of a server.

    Args:
        number: of the last update that it includes.
        markers: at most one more than `MAX_MARKERS`.
    """

    number: int
    markers: Sequence[Completed | RefusedMarker]


class MarkerUpdate(NamedTuple):
    """A change of a server's markers.

    Args:
        number: follows that of the update before.
        is_keep_alive: whether it is only a sign of life.
        markers: new or changed ones, at most one more than `MAX_MARKERS`.
        poses: new poses, visualization_msgs/InteractiveMarkerPose.
        erased: names.
    """

    number: int
    is_keep_alive: bool
    markers: Sequence[Completed | RefusedMarker]
    poses: Sequence[Any]
    erased: Sequence[str]


def read_answer(cdr: bytes) -> MarkerAnswer:
    """Read the response of the service.

    Raises:
        MessageError: it cannot be decoded; one sentence.
    """
    answer = decode(f"{SERVICE}_Response", cdr)
    return MarkerAnswer(int(answer.sequence_number), list(_completed(answer.markers)))


def read_update(cdr: bytes) -> MarkerUpdate:
    """Read a message of the topic.

    Raises:
        MessageError: it cannot be decoded; one sentence.
    """
    update = decode(UPDATE, cdr)
    return MarkerUpdate(
        int(update.seq_num),
        update.type == KEEP_ALIVE,
        list(_completed(update.markers)),
        update.poses,
        [str(name) for name in update.erases],
    )


def _completed(messages: Sequence[Any]) -> Iterator[Completed | RefusedMarker]:
    # One more than the limit, so that the server finds that there are too many.
    for message in messages[: MAX_MARKERS + 1]:
        yield completed(message)
