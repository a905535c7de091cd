"""The MapInfo display."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Annotated, Any

import numpy as np

from webviz import Context, Display, Input, Lookback, Pose, Prop, Sample, Topic
from webviz.data.rotations import normalized, to_rpy
from webviz.data.words import counted

LISTED = 100
"""Statistics that have a status; RTAB-Map sends about 80."""
LONGEST_NAME = 80


@dataclass(frozen=True)
class SeenInfo:
    """Messages so far.

    Args:
        newest: rtabmap_msgs/Info, None before the first.
        loops: how many had a loop closure.
        nearby: how many had a proximity detection instead.
    """

    newest: Any = field(default=None, compare=False)
    loops: int = 0
    nearby: int = 0


class MapInfo(Display):
    """RTAB-Map's statistics, and the loops that it closes, as statuses."""

    rviz = "rtabmap_rviz_plugins/Info"
    reports_only = True

    topic: Annotated[Topic, Input("rtabmap_msgs/msg/Info"), Prop(help="Topic of RTAB-Map.")] = (
        Topic("/rtabmap/info")
    )

    def waits(self, name: str) -> bool:
        """Nothing is placed in the scene."""
        return False

    def lookback(self, name: str) -> Lookback:
        """Return all: their loops are counted."""
        return Lookback()

    def fold(self, name: str, sample: Sample, state: SeenInfo | None) -> SeenInfo:
        """Count loops, and remember the newest message."""
        before, message = state or SeenInfo(), sample.message
        is_loop = bool(message.loop_closure_id)
        is_near = not is_loop and bool(message.proximity_detection_id)
        return replace(
            before,
            newest=message,
            loops=before.loops + is_loop,
            nearby=before.nearby + is_near,
        )

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the statuses; nothing is drawn."""
        if not samples:
            return
        info: SeenInfo = samples[-1].message
        message = info.newest
        ctx.ok("Info", _link(message))
        is_linked = message.loop_closure_id or message.proximity_detection_id
        if is_linked and (pose := _pose(message.loop_closure_transform)):
            x, y, z = pose.position
            ctx.ok("Position", f"x {x:.3f}, y {y:.3f}, z {z:.3f} m.")
            roll, pitch, yaw = to_rpy(pose.wxyz)
            ctx.ok("Orientation", f"roll {roll:.3f}, pitch {pitch:.3f}, yaw {yaw:.3f} rad.")
        ctx.ok("Loop closures", f"{counted(info.loops, 'loop closure')} so far.")
        ctx.ok("Proximity detections", f"{counted(info.nearby, 'detection')} so far.")
        names, values = message.stats_keys, message.stats_values
        if len(names) != len(values):
            text = f"{len(values)} values for {counted(len(names), 'name')}. Fix the publisher."
            ctx.error("Statistics", text)
            return
        for name, value in list(zip(names, values.tolist(), strict=True))[:LISTED]:
            ctx.ok(name[:LONGEST_NAME].strip("/"), f"{value:g}")
        if len(names) > LISTED:
            ctx.ok("Statistics", f"The first {LISTED} of {len(names)} are listed.")


def _link(message: Any) -> str:
    if message.loop_closure_id:
        return f"{message.ref_id} closes a loop with {message.loop_closure_id}."
    if message.proximity_detection_id:
        return f"{message.ref_id} is near {message.proximity_detection_id}."
    return f"Node {message.ref_id}, no loop."


def _pose(transform: Any) -> Pose | None:
    """Return the transform of a link, None if it is invalid."""
    place, turn = transform.translation, transform.rotation
    wxyz = np.array([[turn.w, turn.x, turn.y, turn.z]])
    if not np.isfinite([place.x, place.y, place.z, *wxyz[0]]).all() or not wxyz.any():
        return None
    w, x, y, z = normalized(wxyz)[0][0].tolist()
    return Pose((place.x, place.y, place.z), (w, x, y, z))
