"""The displays AutowarePath and AutowareTrajectory."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from webviz import (
    Context,
    Details,
    Display,
    Group,
    Hit,
    Input,
    Mesh,
    Pose,
    Prop,
    Rgb,
    Sample,
    Topic,
    compose,
)
from webviz.data.rotations import matrices, normalized
from webviz.data.words import counted
from webviz_displays.autoware.look import (
    DrivableAreaView,
    FootprintView,
    LaneView,
    PointView,
    TextView,
    VelocityView,
)
from webviz_displays.shared.geometry import LONGEST, is_drawable, origin_near

F64 = NDArray[np.float64]
U8 = NDArray[np.uint8]

MAX_POINTS = 5000
"""Points drawn per message."""
MAX_TEXTS = 1000
"""Numbers of each kind drawn per message."""
DISC = 0.01
"""Height of discs, metres."""


class _Points:
    """The points of a message, as far as they are drawn.

    Args:
        points: with `pose` and `longitudinal_velocity_mps`.

    Attributes:
        xyz: (N, 3), metres in the frame of the message.
        turns: (N, 3, 3), rotations of the vehicle.
        speeds: (N,), m/s; negative backwards.
        ok: whether all are finite and can be drawn.
    """

    def __init__(self, points: Sequence[Any]) -> None:
        rows = [(each.pose.position, each.pose.orientation) for each in points]
        self.xyz = np.array([(p.x, p.y, p.z) for p, _ in rows])
        wxyzs = np.array([(q.w, q.x, q.y, q.z) for _, q in rows])
        self.speeds = np.array([each.longitudinal_velocity_mps for each in points], np.float64)
        self.ok = bool(
            is_drawable(self.xyz).all()
            and np.isfinite(wxyzs).all()
            and (np.abs(self.speeds) < LONGEST).all()
        )
        self.turns = matrices(normalized(wxyzs)[0])


class AutowarePathDisplay(Display):
    """Base of the displays of Autoware's paths."""

    topic: Annotated[Topic, Prop(help="Topic of the paths.")] = Topic()
    view_path: Annotated[LaneView, Prop(help="How to draw the lane of the vehicle.")] = LaneView()
    color_border_vel_max: Annotated[
        float,
        Prop(ge=0, unit="m/s", rviz="Color Border Vel Max", help="Velocity of the last colour."),
    ] = 3.0
    view_velocity: Annotated[VelocityView, Prop(help="How to draw the velocities.")] = (
        VelocityView()
    )
    view_text_velocity: Annotated[TextView, Prop(help="Velocities as numbers, in m/s.")] = (
        TextView()
    )
    view_footprint: Annotated[FootprintView, Prop(help="Outlines and size of the vehicle.")] = (
        FootprintView()
    )
    view_point: Annotated[PointView, Prop(help="How to draw the points.")] = PointView()
    view_text_slope: Annotated[TextView, Prop(help="Slopes as numbers, in radians.")] = TextView()

    def draw(self, sample: Sample, ctx: Context) -> None:
        """Draw the path, in the frame and at the stamp of the header."""
        message_points = sample.message.points
        if not len(message_points):
            ctx.warn("Path", "The path is empty. Check the planner's log.")
            return
        points = _Points(message_points[:MAX_POINTS])
        if not points.ok:
            text = "A pose or velocity is not finite or too large. Fix the planner."
            ctx.error("Path", text)
            return
        least, most = points.speeds.min(), points.speeds.max()
        amounts = f"{counted(len(points.xyz), 'point')}, {least:.2f} to {most:.2f} m/s"
        if len(message_points) > MAX_POINTS:
            ctx.warn("Path", f"Showing the first {amounts}; the path has {len(message_points)}.")
        else:
            ctx.ok("Path", f"{amounts}.")
        origin = np.array(origin_near(points.xyz))
        points.xyz = points.xyz - origin
        group = ctx.follow(None, offset=compose(sample.pose, Pose(tuple(origin.tolist()))))
        self._draw_lane(points, group)
        self._draw_velocities(points, group)
        self._draw_footprints(points, group)
        self._draw_points(points, group)
        if self.view_text_velocity.value:
            texts = [f"{speed:.2f}" for speed in points.speeds.tolist()]
            add_texts("velocities", texts, self.view_text_velocity.scale, points.xyz, group)
        if self.view_text_slope.value and len(points.xyz) > 1:
            texts = [f"{slope:.2f}" for slope in slopes(points.xyz).tolist()]
            add_texts("slopes", texts, self.view_text_slope.scale, points.xyz, group)
        self.draw_more(sample.message, points.xyz, origin, group, ctx)

    def draw_more(self, message: Any, xyz: F64, origin: F64, group: Group, ctx: Context) -> None:
        """Draw what only some messages have.

        Args:
            message: of the path.
            xyz: (N, 3), its points that are drawn, relative to `origin`.
            origin: (3,), metres in the frame of the message.
            group: where to draw, relative to `origin`.
            ctx: collects statuses.
        """

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a point of the path."""
        points = hit.sample.message.points
        if hit.id is None or hit.id >= len(points):
            return Details("Path", {"Points": len(points)})
        point = points[hit.id]
        values: dict[str, object] = {
            "Velocity": f"{point.longitudinal_velocity_mps:g} m/s",
            "Lateral velocity": f"{point.lateral_velocity_mps:g} m/s",
            "Heading rate": f"{point.heading_rate_rps:g} rad/s",
        }
        return Details(f"Point {hit.id} of {len(points)}", values | self.details(point))

    def details(self, point: Any) -> dict[str, object]:
        """Return what only the points of some messages have."""
        return {}

    def _velocity_colors(self, speeds: F64) -> U8:
        """Colours (N, 3) between the three of the lane."""
        view = self.view_path
        stops = (view.min_velocity_color, view.mid_velocity_color, view.max_velocity_color)
        top = max(self.color_border_vel_max, 1e-9)
        places = np.array((0.0, top / 2, top))
        channels = [np.interp(np.abs(speeds), places, part) for part in zip(*stops, strict=True)]
        return np.rint(np.stack(channels, axis=-1)).astype(np.uint8)

    def _draw_lane(self, points: _Points, group: Group) -> None:
        view, count = self.view_path, len(points.xyz)
        width = view.width if view.constant_width else self.view_footprint.vehicle_width
        if not view.value or count < 2 or not view.alpha or not width:
            return
        colors = (
            np.full((count, 3), view.color, np.uint8)
            if view.constant_color
            else self._velocity_colors(points.speeds)
        )
        alphas = np.full(count, view.alpha)
        if view.fade_out_distance:
            steps = np.linalg.norm(np.diff(points.xyz[:, :2], axis=0), axis=1)
            left = np.append(np.cumsum(steps[::-1])[::-1], 0.0)
            alphas *= np.minimum(left / view.fade_out_distance, 1.0)
        rgba = np.column_stack((colors, np.rint(255 * alphas).astype(np.uint8)))
        sides = np.array((-width / 2, width / 2))
        vertices = points.xyz[:, None] + sides[:, None] * points.turns[:, None, :, 1]
        first = 2 * np.arange(count - 1)[:, None]
        faces = np.concatenate((first + np.array((0, 2, 1)), first + np.array((1, 2, 3))))
        group.add(
            "lane",
            Mesh(
                np.ascontiguousarray(vertices.reshape(-1, 3), np.float32),
                faces.astype(np.uint32),
                (255, 255, 255),
                ids=np.tile(np.arange(count - 1), 2),
                colors=np.ascontiguousarray(np.repeat(rgba, 2, axis=0)),
            ),
        )

    def _draw_velocities(self, points: _Points, group: Group) -> None:
        view = self.view_velocity
        if not view.value or not view.alpha:
            return
        xyz = points.xyz + np.outer(view.scale * points.speeds, (0.0, 0.0, 1.0))
        colors: U8 | Rgb = view.color
        if not view.constant_color:
            each = self._velocity_colors(points.speeds)
            colors = np.stack((each[:-1], each[1:]), axis=1)
        segments = np.stack((xyz[:-1], xyz[1:]), axis=1)
        group.lines("velocity line", segments, colors, opacity=view.alpha)

    def _draw_footprints(self, points: _Points, group: Group) -> None:
        view = self.view_footprint
        if not view.value or not view.alpha:
            return
        front = view.vehicle_length - view.rear_overhang - view.offset_from_baselink
        back, half = view.offset_from_baselink - view.rear_overhang, view.vehicle_width / 2
        outline = np.array(((front, half), (front, -half), (back, -half), (back, half)))
        own = np.column_stack((outline, np.zeros(4)))
        corners = points.xyz[:, None] + own @ points.turns.transpose(0, 2, 1)
        segments = np.stack((corners, np.roll(corners, -1, axis=1)), axis=2)
        ids = np.repeat(np.arange(len(corners)), 4)
        segments = segments.reshape(-1, 2, 3)
        group.lines("footprints", segments, view.color, ids=ids, opacity=view.alpha)

    def _draw_points(self, points: _Points, group: Group) -> None:
        view = self.view_point
        if not view.value or not view.alpha:
            return
        xyz = points.xyz + view.offset * points.turns[..., 0]
        size = (2 * view.radius, 2 * view.radius, DISC)
        group.instances("points", "cylinder", xyz, size, view.color, opacity=view.alpha)


class AutowarePath(AutowarePathDisplay):
    """A path of Autoware's planners, with velocities and the bounds of the drivable area."""

    rviz = "rviz_plugins/Path"

    topic: Annotated[
        Topic, Input("autoware_planning_msgs/msg/Path"), Prop(help="Topic of the paths.")
    ] = Topic("/planning/scenario_planning/lane_driving/behavior_planning/path")
    view_drivable_area: Annotated[
        DrivableAreaView, Prop(help="How to draw the bounds of the drivable area.")
    ] = DrivableAreaView()

    def draw_more(self, message: Any, xyz: F64, origin: F64, group: Group, ctx: Context) -> None:
        """Draw the bounds of the drivable area."""
        view = self.view_drivable_area
        if not view.value or not view.alpha:
            return
        for name, bound in (("left", message.left_bound), ("right", message.right_bound)):
            if not is_drawable(bound).all():
                ctx.error("Drivable area", f"The {name} bound is not finite. Fix the planner.")
            elif len(bound) > 1:
                line = np.asarray(bound[:MAX_POINTS]) - origin
                group.strip(f"{name} bound", line, view.color, view.width, "m", opacity=view.alpha)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a point of the path, or a bound."""
        if hit.key.endswith("bound"):
            return Details(hit.key.capitalize())
        return super().inspect(hit, ctx)


class AutowareTrajectory(AutowarePathDisplay):
    """A trajectory of Autoware's planners, with velocities."""

    rviz = "rviz_plugins/Trajectory"

    topic: Annotated[
        Topic,
        Input("autoware_planning_msgs/msg/Trajectory"),
        Prop(help="Topic of the trajectories."),
    ] = Topic("/planning/trajectory")
    view_text_time: Annotated[
        TextView, Prop(help="Times since the start as numbers, in seconds.")
    ] = TextView()

    def draw_more(self, message: Any, xyz: F64, origin: F64, group: Group, ctx: Context) -> None:
        """Draw the times."""
        if self.view_text_time.value:
            texts = [f"{seconds(each):.2f}" for each in message.points[: len(xyz)]]
            add_texts("times", texts, self.view_text_time.scale, xyz, group)

    def details(self, point: Any) -> dict[str, object]:
        """Time, acceleration and steering."""
        return {
            "Time": f"{seconds(point):g} s",
            "Acceleration": f"{point.acceleration_mps2:g} m/s²",
            "Front wheels": f"{point.front_wheel_angle_rad:g} rad",
        }


def seconds(point: Any) -> float:
    """Return the time since the start of a trajectory."""
    return point.time_from_start.ns / 1e9


def slopes(xyz: F64) -> F64:
    """Return the slopes (N,) to the next of two or more points (N, 3), in radians.

    Up is positive.
    """
    steps = np.diff(xyz, axis=0)
    angles = np.arctan2(steps[:, 2], np.linalg.norm(steps[:, :2], axis=1))
    return np.append(angles, angles[-1])


def add_texts(key: str, texts: Sequence[str], height: float, xyz: F64, group: Group) -> None:
    """Draw texts above points (N, 3)."""
    step = -(-len(texts) // MAX_TEXTS)
    rows = np.arange(0, len(texts), step)
    above = xyz[rows] + (0.0, 0.0, height / 2)
    group.labels(key, above, tuple(texts[row] for row in rows.tolist()), height, ids=rows)
