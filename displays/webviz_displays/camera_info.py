"""The CameraInfo display."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Color, Context, Display, Image, Input, Pose, Prop, Sample, Topic
from webviz.api.nodes import Mesh
from webviz.api.pictures import Encoded, Pixels
from webviz.data.images import (
    CameraModel,
    ImageError,
    RawImage,
    Tone,
    calibration_problem,
    optical_problem,
    value_range,
    values,
)
from webviz_displays.image import transports
from webviz_displays.image.newest import Newest
from webviz_displays.image.texels import texels
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import Metres
from webviz_displays.shared.properties import opaque

EDGE_M = 0.01

_SIDES = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 4), (0, 4, 1)], np.uint32)
_END = np.array([(1, 3, 2), (1, 4, 3)], np.uint32)


Cells = tuple[NDArray[np.uint8], tuple[int, int]]
"""RGBA (H, W, 4), and the full size of the image."""


class _State(msgspec.Struct):
    """Kept between messages.

    Args:
        cells: of the images.
    """

    cells: Newest[Cells] = msgspec.field(default_factory=Newest[Cells])


class CameraInfo(Display):
    """The view of a camera as a pyramid, with its image at the far end on request."""

    rviz = "rviz_default_plugins/CameraInfo"
    icon = "camera"

    topic: Annotated[
        Topic, Input("sensor_msgs/msg/CameraInfo"), Prop(help="Topic of the camera info.")
    ] = Topic("/camera/camera_info")
    far_clip: Annotated[Metres, Prop(rviz="Far clip", help="Distance of the far end.")] = 1.0
    show_edges: Annotated[bool, Prop(rviz="Show edges", help="Draw the edges.")] = True
    show_polygons: Annotated[bool, Prop(rviz="Show polygons", help="Fill the pyramid.")] = True
    not_show_side_polygons: Annotated[
        bool,
        Prop(
            rviz="Not show side polygons",
            when=("show_polygons", True),
            help="Fill the far end only.",
        ),
    ] = True
    color: Annotated[
        Color, Prop(when=("show_polygons", True), help="Colour of the filled sides.")
    ] = (85, 255, 255)
    edge_color: Annotated[
        Color, Prop(rviz="Edge color", when=("show_edges", True), help="Colour of the edges.")
    ] = (125, 125, 125)
    alpha: Annotated[Alpha, Prop(help="Opacity; 0 is invisible.")] = 0.5
    show_image: Annotated[bool, Prop(help="Show the image at the far end.")] = False
    image_topic: Annotated[
        Topic,
        Input(transports.RAW, also=(transports.COMPRESSED,), optional=True, is_offered=False),
        Prop(
            rviz="Far Image Topic",
            when=("show_image", True),
            help="Topic of the image; raw, compressed or depth.",
        ),
    ] = Topic("/camera/image_raw")

    def new_state(self) -> _State:
        """Return the state before the first message."""
        return _State()

    def listens(self, name: str) -> bool:
        """Return whether an input is needed: the image only if it is shown."""
        return name == "topic" or self.show_image

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Draw the pyramid, and the newest image in it."""
        infos = [each for each in samples if each.input == "topic"]
        images = [each for each in samples if each.input == "image_topic"]
        if not infos:
            if images and self.show_image:
                ctx.warn(
                    "Image", "Waiting for a camera info, without which the image has no place."
                )
            return
        info = infos[-1]
        try:
            model = CameraModel.of(info.message)
        except ImageError as error:
            ctx.error("Camera Info", str(error))
            return
        self._draw_pyramid(model, info, ctx)
        if images and self.show_image:
            self._draw_image(model, images[-1], ctx)

    def _draw_pyramid(self, model: CameraModel, info: Sample, ctx: Context) -> None:
        corners = np.concatenate(([(*model.center, 0.0)], model.corners(self.far_clip)))
        if not np.abs(corners).max() < 1e6:
            ctx.error("Camera Info", "The pyramid is wider than 1000 km. Calibrate the camera.")
            return
        group, points = (
            ctx.follow(None, offset=info.pose, key="pyramid"),
            corners.astype(np.float32),
        )
        if self.alpha > 0 and self.show_edges:
            pairs = [(0, 1), (0, 2), (0, 3), (0, 4), (1, 2), (2, 3), (3, 4), (4, 1)]
            edges = points[np.array(pairs)]
            group.lines("edges", edges, self.edge_color, EDGE_M, "m", opacity=self.alpha)
        if self.alpha > 0 and self.show_polygons and not self._hides_polygons():
            faces = _END if self.not_show_side_polygons else np.concatenate((_SIDES, _END))
            both = np.concatenate((faces, faces[:, ::-1]))  # seen from both sides
            group.add("polygons", Mesh(points, both, self.color, self.alpha))
        size = f"{model.width} x {model.height}, focal length {model.fx:.4g} px"
        if self.alpha == 0:
            ctx.warn("Camera Info", f"{size}, invisible: alpha is 0. Increase it.", opaque())
        elif problem := calibration_problem(info.message) or optical_problem(info.frame):
            ctx.warn("Camera Info", problem)
        else:
            ctx.ok("Camera Info", f"{size}.")

    def _hides_polygons(self) -> bool:
        return self.show_image and self.not_show_side_polygons  # the image takes their place

    def _draw_image(self, model: CameraModel, sample: Sample, ctx: Context) -> None:
        try:
            picture = transports.read(sample)
            drawn_cells = ctx.state.cells.of(sample.number, lambda: _cells(picture), ctx)
        except ImageError as error:
            ctx.error("Image", str(error))
            return
        if drawn_cells is None:
            ctx.warn("Image", "Decompressing the first image.")
            return
        cells, size = drawn_cells
        corners = model.corners(self.far_clip)
        width, height, _ = (corners[2] - corners[0]).tolist()
        x, y, _ = corners[0].tolist()
        group = ctx.follow(None, offset=sample.pose, key="image")
        group.add("image", Image(cells, width, height), Pose((x, y, self.far_clip)))
        if size != (model.width, model.height):
            ctx.warn(
                "Image",
                f"The image has {size[0]} x {size[1]} pixels, the camera info "
                f"{model.width} x {model.height}: they belong to different cameras or modes.",
            )
        else:
            ctx.ok("Image", f"{size[0]} x {size[1]}.")


def _cells(source: RawImage | Encoded | transports.Decompression) -> Cells:
    """RGBA (H, W, 4) of an image, and its full size."""
    image = source.run() if isinstance(source, transports.Decompression) else source
    if isinstance(image, Encoded):
        picture: Pixels | Encoded = image
    else:
        limits = None
        if image.layout.is_scaled:
            limits = value_range(values(image), image.layout.zero_is_invalid)
        picture = Pixels(image, Tone(*limits) if limits else Tone())
    return texels(picture), picture.size
