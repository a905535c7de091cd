"""Messages to an interactive marker server."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from typing import Any

from webviz import Frames, Pose
from webviz.data.transforms import TransformException
from webviz_displays.interactive_markers.tracked import Tracked

FEEDBACK = "visualization_msgs/msg/InteractiveMarkerFeedback"
DEPTH = 100
KEEP_ALIVE, POSE_UPDATE, MENU_SELECT, BUTTON_CLICK, MOUSE_DOWN, MOUSE_UP = range(6)
MAX_WAITING = 100

Position = tuple[float, float, float]


def values_of(
    event: int,
    marker: Tracked,
    control: str,
    frames: Frames,
    client: str,
    point: Position | None = None,
    entry: int = 0,
) -> Mapping[str, Any] | None:
    """Return the values of a visualization_msgs/InteractiveMarkerFeedback.

    None without a transform.

    A marker that moves with its frame is reported in that frame, at the latest time at which its
    transform is known; another one in the fixed frame with a stamp of 0. Frames have the names that
    the robot of the server has for them.

    Args:
        point: under the pointer, in the frame of `Tracked.place`; None for nothing.
        entry: id of the chosen entry of the menu.
    """
    place = marker.place(frames)
    if place is None:
        return None
    stamp_ns, frame = 0, frames.named(place.frame)
    if frame != frames.fixed_frame:
        try:
            stamp_ns = frames.buffer.latest_common_time(frames.fixed_frame, frame)
        except TransformException:
            return None
    sec, nanosec = divmod(stamp_ns, 1_000_000_000)
    return {
        "header": {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": frames.own(frame)},
        "client_id": client,
        "marker_name": marker.content.name,
        "control_name": control,
        "event_type": event,
        "pose": _pose(place.pose),
        "menu_entry_id": entry,
        "mouse_point": dict(zip("xyz", point or (0.0, 0.0, 0.0), strict=True)),
        "mouse_point_valid": point is not None,
    }


class FeedbackQueue:
    """Messages that wait to be sent, one per turn of the frame loop.

    Servers keep one message only until they take it, so that of several at once some would be lost.
    """

    def __init__(self) -> None:
        self._waiting: deque[Mapping[str, Any]] = deque(maxlen=MAX_WAITING)

    def __len__(self) -> int:
        return len(self._waiting)

    def add(self, values: Mapping[str, Any]) -> None:
        """Add a message; a new pose replaces the one before that waits."""
        last = self._waiting[-1] if self._waiting else None
        if last is not None and _is_same_move(last, values):
            self._waiting.pop()
        self._waiting.append(values)

    def next(self) -> Mapping[str, Any] | None:
        """Return the next message, None if there is none."""
        return self._waiting.popleft() if self._waiting else None


def _is_same_move(a: Mapping[str, Any], b: Mapping[str, Any]) -> bool:
    keys = ("event_type", "marker_name", "control_name")
    return a["event_type"] == POSE_UPDATE and all(a[key] == b[key] for key in keys)


def _pose(pose: Pose) -> dict[str, dict[str, float]]:
    w, x, y, z = pose.wxyz
    return {
        "position": dict(zip("xyz", pose.position, strict=True)),
        "orientation": {"x": x, "y": y, "z": z, "w": w},
    }
