"""Displays of places on the earth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from webviz import Color, Context, Details, Display, Hit, Input, Lookback, Pose, Prop, Sample, Topic
from webviz.data.geo import to_enu, to_utm
from webviz.data.words import counted
from webviz_displays.outdoors.aerial_map import AerialMap
from webviz_displays.outdoors.fixes import FIX, fault_of, place_of
from webviz_displays.shared.geometry import LONGEST, Length, is_drawable
from webviz_displays.shared.properties import HistoryLength

__all__ = ["AerialMap", "GeoPath", "NavSatFix"]

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


UNKNOWN = 0
"""`position_covariance_type` without a covariance."""
CIRCLE = np.linspace(0.0, math.tau, 49)


class NavSatFix(Display):
    """Fixes of a satellite receiver, the newest with its deviation."""

    icon = "target"

    topic: Annotated[Topic, FIX, Prop(help="Topic of the fixes.")] = Topic("/gps/fix")
    color: Annotated[Color, Prop(help="Colour of the fixes.")] = (255, 140, 0)
    radius: Annotated[Length, Prop(help="Radius of each fix.")] = 0.2
    show_covariance: Annotated[
        bool, Prop(help="Draw the standard deviation of the newest fix as an ellipse.")
    ] = True
    history_length: HistoryLength = 100

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw fixes relative to the newest, which lies where its frame is."""
        if not samples:
            return
        newest = samples[-1]
        if fault := fault_of(newest.message):
            ctx.error("Fix", fault)
            return
        fixes = [each for each in samples if not fault_of(each.message)]
        origin = place_of(newest.message)
        xyz = to_enu([place_of(each.message) for each in fixes], origin)
        rows = np.flatnonzero(is_drawable(xyz))
        group = ctx.follow(None, offset=Pose(newest.pose.position), key="fixes")
        ids = np.array([each.number for each in fixes])[rows]
        group.instances("fixes", "sphere", xyz[rows], 2 * self.radius, self.color, ids=ids)
        if self.show_covariance and newest.message.position_covariance_type != UNKNOWN:
            ellipse = _ellipse(np.asarray(newest.message.position_covariance, float))
            if ellipse is None:
                ctx.warn("Covariance", "The covariance is invalid. Fix the publisher.")
            else:
                group.strip("deviation", ellipse, self.color)
        ctx.ok("Fix", f"Showing {counted(len(rows), 'position')}.")

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Latitude, longitude and UTM coordinates."""
        sample = next((each for each in hit.samples if each.number == hit.id), hit.samples[-1])
        place = place_of(sample.message)
        values: dict[str, object] = {
            "Latitude": f"{place.latitude:.7f}°",
            "Longitude": f"{place.longitude:.7f}°",
            "Altitude": f"{place.altitude:.2f} m",
        }
        if (utm := to_utm(*place[:2])) is not None:
            values["UTM"] = str(utm)
        return Details("Fix", values)


def _ellipse(covariance: NDArray[np.float64]) -> NDArray[np.float64] | None:
    """Return deviations in the plane, (N, 3) in metres; None if the covariance is invalid."""
    plane = covariance.reshape(3, 3)[:2, :2]
    if not np.isfinite(plane).all() or not np.allclose(plane, plane.T):
        return None
    squares, axes = np.linalg.eigh(plane)
    if squares.min() < 0 or squares.max() > LONGEST**2:
        return None
    flat = axes @ (np.sqrt(squares)[:, None] * [np.cos(CIRCLE), np.sin(CIRCLE)])
    return np.column_stack([flat.T, np.zeros(len(CIRCLE))])
