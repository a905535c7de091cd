"""The GeoPath display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import numpy as np

from webviz import Color, Context, Details, Display, Hit, Input, Lookback, Pose, Prop, Sample, Topic
from webviz.data.geo import to_enu
from webviz.data.words import counted
from webviz_displays.outdoors.fixes import FIX, fault_of, place_of
from webviz_displays.shared.geometry import is_drawable

MAX_POSES = 100_000
"""Poses drawn."""


class GeoPath(Display):
    """A path of places on the earth, around a satellite receiver."""

    icon = "path"

    topic: Annotated[
        Topic,
        Input("geographic_msgs/msg/GeoPath", is_sporadic=True),
        Prop(help="Topic of the paths."),
    ] = Topic("/geo_path")
    fix_topic: Annotated[
        Topic, FIX, Prop(help="Topic of the receiver's fixes, which place the path.")
    ] = Topic("/gps/fix")
    color: Annotated[Color, Prop(help="Colour of the line.")] = (25, 255, 0)
    line_width: Annotated[float, Prop(gt=0, le=100, unit="px", help="Width of the line.")] = 3.0
    use_altitude: Annotated[
        bool, Prop(help="Draw altitudes; otherwise the path lies at the height of the receiver.")
    ] = False

    def waits(self, name: str) -> bool:
        """Only fixes have a frame that matters."""
        return name == "fix_topic"

    def lookback(self, name: str) -> Lookback:
        """Return the newest of each."""
        return Lookback(count=1)

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the path so that the newest fix lies where its frame is."""
        newest = {each.input: each for each in samples}
        path, fix = newest.get("topic"), newest.get("fix_topic")
        if path is None or fix is None:
            missing = "path" if path is None else "fix"
            topic = self.topic if path is None else self.fix_topic
            ctx.warn("Path", f"Waiting for a {missing} on {topic.name}.")
            return
        if fault := fault_of(fix.message):
            ctx.error("Fix", fault)
            return
        origin = place_of(fix.message)
        poses = path.message.poses[:MAX_POSES]
        points = [each.pose.position for each in poses]
        places = np.array([(p.latitude, p.longitude, p.altitude) for p in points]).reshape(-1, 3)
        if not self.use_altitude:
            places[:, 2] = origin.altitude
        with np.errstate(all="ignore"):
            is_place = (np.abs(places[:, 0]) <= 90.0) & (np.abs(places[:, 1]) <= 360.0)
            xyz = to_enu(places, origin)
        is_place &= is_drawable(np.nan_to_num(xyz, nan=np.inf))
        if not self.use_altitude:
            xyz[:, 2] = 0.0
        if is_place.sum() > 1:
            group = ctx.follow(None, offset=Pose(fix.pose.position), key="path")
            group.strip("line", xyz[is_place], self.color, self.line_width)
        self._report(len(path.message.poses), int(is_place.sum()), ctx)

    def _report(self, count: int, valid: int, ctx: Context) -> None:
        if count > MAX_POSES:
            ctx.warn("Path", f"Showing the first {MAX_POSES} of {count} poses.")
        elif valid < count:
            invalid = counted(count - valid, "pose")
            ctx.error(
                "Path", f"{invalid} of {count} are not places on the earth. Fix the publisher."
            )
        elif count < 2:
            ctx.warn("Path", f"The path has {counted(count, 'pose')}; a line needs two.")
        else:
            ctx.ok("Path", f"Showing {counted(count, 'pose')}.")

    def inspect(self, hit: Hit, ctx: Context) -> Details:
        """Return the number of poses."""
        newest = {each.input: each for each in hit.samples}
        return Details("Path", {"Poses": len(newest["topic"].message.poses)})
