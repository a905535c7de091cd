"""The DepthCloud display."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import partial
from typing import Annotated, Literal

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import (
    ColorScale,
    Context,
    Group,
    Input,
    Pose,
    Prop,
    Rgb,
    Sample,
    Status,
    Sync,
    Topic,
)
from webviz.data.images import CameraModel, ImageError, calibration_problem, optical_problem
from webviz.data.words import counted
from webviz_displays.depth_cloud.cloud import DepthPoints, depth_points
from webviz_displays.depth_cloud.hidden import Hidden
from webviz_displays.image import transports
from webviz_displays.image.newest import Newest
from webviz_displays.shared.points_display import BY_INTENSITY, PointsDisplay
from webviz_displays.shared.properties import opaque

__all__ = ["DepthCloud"]

U8 = NDArray[np.uint8]

IMAGE_PLANE = (0.0, 0.0, 1.0, 0.0)
"""Plane through the origin of the optical frame: points are as far from it as their depths."""


class _CloudNodes(msgspec.Struct, frozen=True):
    """The points of an image as they were drawn.

    Args:
        points: of the image.
        look: all else that the nodes depend on.
        groups: the nodes.
        statuses: what was reported with them.
        scale: of their colours.
    """

    points: DepthPoints
    look: object
    groups: Mapping[str, Group]
    statuses: Mapping[str, Status]
    scale: ColorScale | None


class _State(msgspec.Struct):
    """Kept between messages.

    Args:
        newest: computes the points of images.
        hidden: what the points of earlier images hide; only used by the work for `newest`.
        clouds: points by the number of their image.
        poses: of these images in the fixed frame, as far as they were known last.
        cloud_nodes: the clouds as they were drawn, until something that they depend on changes.
    """

    newest: Newest[tuple[int, DepthPoints]] = msgspec.field(
        default_factory=Newest[tuple[int, DepthPoints]]
    )
    hidden: Hidden = msgspec.field(default_factory=Hidden)
    clouds: dict[int, DepthPoints] = msgspec.field(default_factory=dict)
    poses: dict[int, Pose] = msgspec.field(default_factory=dict)
    cloud_nodes: dict[int, _CloudNodes] = msgspec.field(default_factory=dict)


class DepthCloud(PointsDisplay):
    """The points of a depth image, in the colours of an image if there is one."""

    rviz = "rviz_default_plugins/DepthCloud"
    icon = "cloud"
    sync = Sync("topic", "color_topic", slop=0.05)

    topic: Annotated[
        Topic,
        Input(transports.RAW, also=(transports.COMPRESSED,)),
        Prop(rviz="Depth Map Topic", help="Topic of the depth images; raw or compressedDepth."),
    ] = Topic("/camera/depth/image_rect_raw")
    camera_info_topic: Annotated[
        Topic,
        Input("sensor_msgs/msg/CameraInfo", beside="camera_info"),
        Prop(help="Topic of the depth camera's info; empty is camera_info beside the depths."),
    ] = Topic()
    color_topic: Annotated[
        Topic,
        Input(transports.RAW, also=(transports.COMPRESSED,), optional=True, is_offered=False),
        Prop(
            rviz="Color Image Topic",
            help="Topic of colour images that are registered to the depths; empty for none.",
        ),
    ] = Topic()
    color_transformer: Annotated[
        Literal["Auto", "RGB8", "Intensity", "AxisColor", "FlatColor"],
        Prop(help="How points are coloured; Auto is by the colour image, or by an axis."),
    ] = "Auto"
    channel_name: Annotated[
        Literal["z", "x", "y"],
        Prop(when=BY_INTENSITY, help="Coordinate in the optical frame; z is the depth."),
    ] = "z"
    auto_size: Annotated[
        bool, Prop(help="Make each point as large as the distance of neighbours at its depth.")
    ] = True
    size: Annotated[
        float,
        Prop(
            gt=0,
            unit="m",
            rviz="Size (m)",
            when=("auto_size", False),
            help="Edge or diameter of each point.",
        ),
    ] = 0.01
    auto_size_factor: Annotated[
        float,
        Prop(
            gt=0,
            rviz="Auto Size/Auto Size Factor",
            when=("auto_size", True),
            help="Times that distance.",
        ),
    ] = 1.0
    occlusion_compensation: Annotated[
        bool,
        Prop(
            help="Keep points that something nearer hides from the camera, at half their "
            "brightness, until the camera moves by 1 cm or turns by half a degree."
        ),
    ] = False
    occlusion_time_out: Annotated[
        float,
        Prop(
            ge=0,
            unit="s",
            rviz="Occlusion Compensation/Occlusion Time-Out",
            when=("occlusion_compensation", True),
            help="How long to keep them.",
        ),
    ] = 30.0
    max_points: Annotated[
        int,
        Prop(ge=0, help="Limit of points shown, evenly sampled; 0 shows all."),
    ] = 100_000

    def new_state(self) -> _State:
        """Return the state before the first message."""
        return _State()

    def listens(self, name: str) -> bool:
        """Colours only if there is a topic."""
        return name != "color_topic" or bool(self.color_topic.name)

    def waits(self, name: str) -> bool:
        """Return whether a transform is needed: camera info has the frame of the images."""
        return name != "camera_info_topic"

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the points of the newest image, and of those before it within the decay time."""
        infos = [each for each in samples if each.input == "camera_info_topic"]
        images = [each for each in samples if each.input == "topic"]
        try:
            model = CameraModel.of(infos[-1].message) if infos else None
        except ImageError as error:
            ctx.error("Camera Info", str(error))
            return
        if not images:
            return
        if model is None:
            ctx.warn(
                "Camera Info",
                "No camera info yet, without which depths have no place. See the status "
                "Topic (camera_info_topic).",
            )
            return
        # Points are drawn where their image was taken, though a newer one has come meanwhile.
        ctx.state.poses |= {each.number: each.pose for each in images}
        try:
            newest = self._points(images[-1], model, ctx)
        except ImageError as error:
            ctx.state.poses.clear()
            ctx.error("Points", str(error))
            return
        if newest is None:
            ctx.warn("Points", "Computing the points of the first image.")
            return
        self._hold(*newest, images, ctx.state)
        state: _State = ctx.state
        state.cloud_nodes = {
            number: self._cloud_nodes(number, points, state.poses[number], ctx)
            for number, points in state.clouds.items()
        }
        for cloud in state.cloud_nodes.values():
            ctx.groups.update(cloud.groups)
            ctx.statuses.update(cloud.statuses)
            ctx.color_scale = cloud.scale
        doubt = calibration_problem(infos[-1].message) or optical_problem(images[-1].frame)
        self._report(newest[1], doubt, ctx)

    def _points(
        self, sample: Sample, model: CameraModel, ctx: Context
    ) -> tuple[int, DepthPoints] | None:
        """Return the points of an image and its number; of an earlier one until they are ready."""
        colored = sample.synced.get("color_topic") if self.color_topic.name else None
        number, most = sample.number, self.max_points
        depth = transports.read(sample)
        color = transports.read(colored) if colored else None
        behind, time_out = None, self.occlusion_time_out
        if self.occlusion_compensation:
            behind = partial(
                ctx.state.hidden.behind,
                model=model,
                pose=sample.pose,
                now_ns=sample.received_ns,
                time_out=time_out,
            )
        else:
            ctx.state.hidden = Hidden()
        return ctx.state.newest.of(
            (number, most, model, colored and colored.number, behind and time_out),
            lambda: (number, depth_points(depth, color, model, most, behind)),
            ctx,
        )

    def _hold(
        self, number: int, points: DepthPoints, images: Sequence[Sample], state: _State
    ) -> None:
        """Hold the newest points, and those of images that are held."""
        image_numbers = {each.number for each in images} if self.decay_time else set()
        state.clouds[number] = points
        state.clouds = {
            n: each for n, each in state.clouds.items() if n in image_numbers | {number}
        }
        newest = images[-1].number
        numbers = {number, newest} | image_numbers
        state.poses = {n: pose for n, pose in state.poses.items() if n in numbers or n > number}

    def _cloud_nodes(
        self, number: int, points: DepthPoints, pose: Pose, ctx: Context
    ) -> _CloudNodes:
        """Draw the points of an image, unless they are drawn already."""
        look = pose, msgspec.structs.astuple(self)
        former: _CloudNodes | None = ctx.state.cloud_nodes.get(number)
        if former and former.points is points and former.look == look:
            return former
        own = Context(ctx.frames, ctx.background, None)
        # Without a decay time a new cloud replaces the one before in place.
        key = str(number) if self.decay_time else "newest"
        self._draw_points(points, pose, own.follow(None, offset=pose, key=key), own)
        return _CloudNodes(points, look, own.groups, own.statuses, own.color_scale)

    def _draw_points(self, points: DepthPoints, pose: Pose, group: Group, ctx: Context) -> None:
        """Draw points where their image was taken."""
        if self.alpha == 0:
            return
        colors = self._colors(points, pose, ctx)
        if points.hidden:
            colors = np.array(np.broadcast_to(np.asarray(colors, np.uint8), points.xyz.shape))
            colors[-points.hidden :] //= 2
        size, plane = self.size, None
        if self.auto_size:
            size, plane = self.auto_size_factor * points.spacing, IMAGE_PLANE
        self.draw_points(points.xyz, colors, group, ctx, ids=points.ids, size=size, plane=plane)

    def _colors(self, points: DepthPoints, pose: Pose, ctx: Context) -> U8 | Rgb:
        if points.colors is not None and self.color_transformer in ("Auto", "RGB8"):
            return points.colors
        if self.color_transformer == "Auto":
            ctx.ok("Color", "By an axis, because there is no colour image.")
        if self.color_transformer in ("Auto", "AxisColor"):
            return self.axis_colors(points.xyz, Pose(), pose, ctx)
        if self.color_transformer == "Intensity":
            return self.intensity_colors(points.xyz[:, "xyz".index(self.channel_name)], ctx)
        return self.color if self.color_transformer == "FlatColor" else (255, 255, 255)

    def _report(self, points: DepthPoints, doubt: str, ctx: Context) -> None:
        if self.alpha == 0:
            ctx.warn("Points", "Invisible: alpha is 0. Increase it to show the points.", opaque())
        elif len(points.xyz) == points.hidden:
            ctx.warn("Points", "No pixel has a depth. Check the camera.")
        elif points.remark:
            ctx.warn("Points", points.remark)
        elif doubt:
            ctx.warn("Points", doubt)
        else:
            count = counted(len(points.xyz) - points.hidden, "point")
            behind = f", and {points.hidden} hidden behind them" if points.hidden else ""
            ctx.ok("Points", f"{count} of {points.pixels} pixels{behind}.")
