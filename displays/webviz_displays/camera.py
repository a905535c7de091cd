"""The Camera display."""

from __future__ import annotations

import re
from collections import OrderedDict
from collections.abc import Sequence
from typing import Annotated, Any, Literal

import msgspec

from webviz import Context, Input, Pane, Pose, Prop, Remedy, Sample, Topic
from webviz.api.frames import compose
from webviz.api.pictures import Encoded, OverlayCamera, Pixels, Warp
from webviz.data.images import CameraModel, ImageError, Lens, optical_problem
from webviz_displays.image.annotated import INPUT, AnnotatedImage, AnnotatedState, Annotations

MAX_INFOS = 30
FAR_APART_NS = 200_000_000
SKIPPED_NS = 2_000_000_000
"""The same if images had the camera info of their stamp: a busy machine skips those of some."""


class Infos:
    """The newest camera infos: that of an image may arrive before it or after it."""

    def __init__(self) -> None:
        self._by_stamp: OrderedDict[int, Any] = OrderedDict()
        self._are_alike = False

    def put(self, sample: Sample) -> None:
        """Take a camera info."""
        self._by_stamp.pop(sample.stamp_ns, None)
        self._by_stamp[sample.stamp_ns] = sample.message
        while len(self._by_stamp) > MAX_INFOS:
            self._by_stamp.popitem(last=False)

    def of(self, stamp_ns: int) -> tuple[Any, float]:
        """Return the camera info with the stamp of an image, else the newest one.

        Returns:
            The message, and by how many seconds the nearest stamp differs if that is suspicious:
            a single camera info is good for all images.

        Raises:
            LookupError: there is none.
        """
        if not self._by_stamp:
            raise LookupError("no camera info")
        exact = self._by_stamp.get(stamp_ns)
        if exact is not None:
            self._are_alike = True
            return exact, 0.0
        message = next(reversed(self._by_stamp.values()))
        apart = min(abs(stamp - stamp_ns) for stamp in self._by_stamp)
        far_apart = SKIPPED_NS if self._are_alike else FAR_APART_NS
        is_suspicious = len(self._by_stamp) > 1 and stamp_ns and apart > far_apart
        return message, apart / 1e9 if is_suspicious else 0.0


BESIDE = Remedy("camera_info_topic.name", "", "Use camera_info beside the images")

_RECTIFIED = re.compile(r"(?:^|[/_])rect[^/]*(?:/[^/]*)?$")


class _State(AnnotatedState):
    """Kept between images.

    Args:
        infos: the newest camera infos.
        poses: of the optical frame in the fixed frame by number of their image; that which is
            decompressed may be older than the newest.
        warp: by the lens and the camera it is made for.
        annotations: the newest.
    """

    infos: Infos = msgspec.field(default_factory=Infos)
    poses: dict[int, Pose] = msgspec.field(default_factory=dict)
    warp: tuple[tuple[Lens, CameraModel], Warp | None] | None = None
    annotations: Annotations = msgspec.field(default_factory=Annotations)


class Camera(AnnotatedImage):
    """The scene over and under the image of a camera, as that camera sees it."""

    rviz = "rviz_default_plugins/Camera"
    icon = "camera"
    has_pane = True

    camera_info_topic: Annotated[
        Topic,
        Input("sensor_msgs/msg/CameraInfo", beside="camera_info"),
        Prop(help="Topic of the camera info; empty is camera_info beside the images."),
    ] = Topic()
    image_rendering: Annotated[
        Literal["background and overlay", "background", "overlay"],
        Prop(help="Draw the image behind the scene, over it, or both."),
    ] = "background and overlay"
    overlay_alpha: Annotated[
        float,
        Prop(
            ge=0,
            le=1,
            when=("image_rendering", ("background and overlay", "overlay")),
            help="Opacity of the image over the scene.",
        ),
    ] = 0.5
    zoom_factor: Annotated[
        float, Prop(ge=1e-5, le=1e5, help="Magnification; below 1 shows more than the image.")
    ] = 1.0
    far_plane_distance: Annotated[
        float, Prop(gt=0.01, unit="m", help="Things farther away are not drawn.")
    ] = 100.0
    undistort: Annotated[
        Literal["Auto", "Always", "Never"],
        Prop(
            help="Bend the image as if taken without lens distortion; Auto does so unless the "
            "topic is named as rectified, such as image_rect."
        ),
    ] = "Auto"
    visibility: Annotated[
        dict[str, bool],
        Prop(
            widget="displays",
            help="Displays drawn in this pane; those of groups are named as Group > Display.",
        ),
    ] = msgspec.field(default_factory=dict)

    def new_state(self) -> _State:
        """Return the state before the first message."""
        return _State()

    def waits(self, name: str) -> bool:
        """Return whether a transform is needed: camera info has the frame of the images."""
        return name == "topic"

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Show the newest image, and how its camera sees the scene."""
        state: _State = ctx.state
        for each in samples:
            if each.input == "camera_info_topic":
                state.infos.put(each)
            elif each.input == INPUT:
                state.annotations = state.annotations.taken(each)
        images = [each for each in samples if each.input == "topic"]
        if not images:
            return
        image = images[-1]
        state.poses[image.number] = image.pose
        try:
            picture = self.picture(image, ctx)
            if picture is None:
                return
            number = state.number if state.number in state.poses else image.number
            camera = self._camera(picture, image, state.poses[number], ctx)
        except ImageError as error:
            ctx.error("Image", str(error))
            state.poses.clear()
            return
        state.poses = {n: pose for n, pose in state.poses.items() if n >= number}
        stamp_ns = self.stamp_of(picture, image, ctx)
        pane = Pane(
            picture, stamp_ns, ctx.order, camera, self.marks(state.annotations, stamp_ns, ctx)
        )
        ctx.add("pane", self.reuse(pane, ctx))

    def _camera(
        self, picture: Pixels | Encoded, image: Sample, pose: Pose, ctx: Context
    ) -> OverlayCamera | None:
        """Return the overlay camera for the scene, None without a camera info."""
        try:
            info, late = ctx.state.infos.of(image.stamp_ns)
        except LookupError:
            ctx.warn(
                "Camera Info",
                "No camera info yet, without which the scene has no place in the image. See the "
                "status Topic (camera_info_topic).",
            )
            return None
        try:
            whole, model = CameraModel.whole(info, picture.size), CameraModel.of(info, picture.size)
        except ImageError as error:
            ctx.error("Camera Info", str(error))
            return None
        warp, remark = self._warp(info, whole, picture.size, ctx.state)
        self._report(picture, model, late, image.frame, remark, ctx)
        eye = compose(pose, Pose((*whole.center, 0.0)))
        return OverlayCamera(
            eye.position,
            eye.wxyz,
            (whole.width, whole.height),
            (whole.fx, whole.fy),
            (whole.cx, whole.cy),
            (0.0, 0.0, 1.0, 1.0) if warp else _part(info, whole),
            self.far_plane_distance,
            self.zoom_factor,
            0.0 if self.image_rendering == "background" else self.overlay_alpha,
            self.image_rendering != "overlay",
            warp,
        )

    def _warp(
        self, info: Any, whole: CameraModel, size: tuple[int, int], state: _State
    ) -> tuple[Warp | None, str]:
        """Return the distortion to apply to the scene, and why the image fits or does not."""
        if self.undistort == "Never":
            return None, ""
        if self.undistort == "Auto" and _RECTIFIED.search(self.topic.name):
            return None, "rectified according to its topic"
        try:
            lens = Lens.of(info, size)
            if state.warp is None or state.warp[0] != (lens, whole):
                grid = lens.grid(whole)
                state.warp = (lens, whole), None if grid is None else Warp(grid)
        except ImageError as error:
            return None, str(error)
        lens_warp = state.warp[1]
        return lens_warp, f"undistorted by {lens.model}" if lens_warp else ""

    def _report(
        self,
        picture: Pixels | Encoded,
        model: CameraModel,
        late_s: float,
        frame: str,
        remark: str,
        ctx: Context,
    ) -> None:
        width, height = picture.size
        size = f"{model.width} x {model.height}"
        if (width, height) != (model.width, model.height):
            ctx.warn(
                "Camera Info",
                f"The image has {width} x {height} pixels, the camera info {size}: they belong to "
                "different cameras or modes. Choose the camera info of this camera.",
                BESIDE if self.camera_info_topic.name else None,
            )
        elif remark.endswith("."):
            ctx.warn("Camera Info", remark)
        elif late_s:
            ctx.warn(
                "Camera Info",
                f"No camera info has the stamp of the image; the nearest differs by "
                f"{late_s:.3g} s. Make the driver stamp both alike.",
            )
        elif problem := optical_problem(frame):
            ctx.warn("Camera Info", problem)
        else:
            more = f", {remark}" if remark else ""
            ctx.ok("Camera Info", f"{size}, focal length {model.fx:.4g} px{more}.")


def _part(info: Any, whole: CameraModel) -> tuple[float, float, float, float]:
    """Return the region of interest: left, top, right and bottom as shares of the size."""
    roi = info.roi
    left, top = int(roi.x_offset) / whole.width, int(roi.y_offset) / whole.height
    width = (int(roi.width) or whole.width) / whole.width
    height = (int(roi.height) or whole.height) / whole.height
    return left, top, left + width, top + height
