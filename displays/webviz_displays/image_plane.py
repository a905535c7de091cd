"""The ImagePlane display."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Literal, NamedTuple

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Context, Details, Hit, Image, Pose, Prop, Remedy, Sample, compose
from webviz.api.pictures import Encoded, Pixels
from webviz.data.images import ImageError, values
from webviz_displays.image.base import ImageDisplay, ImageState
from webviz_displays.image.newest import Newest
from webviz_displays.image.texels import texels
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import LONGEST, Metres
from webviz_displays.shared.properties import opaque

_HALF = math.sqrt(0.5)
# Rotations (w, x, y, z) that turn right and up, or right and down, into axes of the frame.
_TURNS = {
    "Optical": (1.0, 0.0, 0.0, 0.0),
    "XY": (1.0, 0.0, 0.0, 0.0),
    "XZ": (_HALF, _HALF, 0.0, 0.0),
    "YZ": (0.5, 0.5, 0.5, 0.5),
}


class _Texture(NamedTuple):
    """An image at the size at which it is sent.

    Args:
        number: of its message.
        cells: RGBA (H, W, 4).
        picture: at its full size.
    """

    number: int
    cells: NDArray[np.uint8]
    picture: Pixels | Encoded


class _State(ImageState):
    """Kept between images.

    Args:
        poses: of the frame in the fixed frame by number of the message, from that of the
            texture on.
        texture: what is drawn.
    """

    textures: Newest[_Texture] = msgspec.field(default_factory=Newest[_Texture])
    poses: dict[int, Pose] = msgspec.field(default_factory=dict)
    texture: _Texture | None = None


class ImagePlane(ImageDisplay):
    """Images on a plane in the scene, with their centre at the origin of their frame."""

    icon = "camera"
    width: Annotated[Metres, Prop(help="Width of the image; the height follows from it.")] = 1.0
    plane: Annotated[
        Literal["Optical", "XY", "XZ", "YZ"],
        Prop(
            help="Axes of the frame that span the image. The first points to its right, the second "
            "to its top; Optical is x to its right and y to its bottom, as in optical frames."
        ),
    ] = "Optical"
    alpha: Annotated[Alpha, Prop(help="Opacity; 0 is invisible.")] = 1.0

    def new_state(self) -> _State:
        """Return the state before the first image."""
        return _State()

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Show the newest image that is ready, where its frame was at its stamp."""
        if not samples:
            return
        if self.alpha == 0:
            ctx.warn("Image", "Invisible: alpha is 0. Increase it to show the image.", opaque())
            return
        newest = samples[-1]
        state: _State = ctx.state
        state.poses[newest.number] = newest.pose
        try:
            picture = self.picture(newest, ctx)
            texture = None if picture is None else self._texture(picture, ctx)
        except ImageError as error:
            ctx.error("Image", str(error))
            state.poses.clear()
            return
        if texture is None:
            return
        pose = state.poses.get(texture.number, newest.pose)
        state.poses = {n: each for n, each in state.poses.items() if n >= texture.number}
        state.texture = texture
        self._place(texture, pose, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a pixel, with its value if it is a measurement."""
        texture: _Texture | None = ctx.state.texture
        if texture is None or not isinstance(hit.node, Image):
            return None
        picture, x, y = (
            texture.picture,
            hit.point[0] / hit.node.width,
            hit.point[1] / hit.node.height,
        )
        column, row = (
            int(np.clip(share * count, 0, count - 1))
            for share, count in zip((x, y), picture.size, strict=True)
        )
        if self.plane != "Optical":
            row = picture.size[1] - 1 - row
        title = f"Pixel {column}, {row}"
        if isinstance(picture, Pixels) and picture.image.layout.is_scaled:
            return Details(title, {"Value": values(picture.image)[row, column]})
        return Details(title)

    def _texture(self, picture: Pixels | Encoded, ctx: Context) -> _Texture | None:
        """Return the newest texture that is ready."""
        number, alpha = ctx.state.number, self.alpha
        tone = picture.tone if isinstance(picture, Pixels) else None
        texture = ctx.state.textures.of(
            (number, tone, alpha),
            lambda: _Texture(number, texels(picture, alpha), picture),
            ctx,
        )
        if texture is None:
            ctx.warn("Image", "Preparing the first image.")
        return texture

    def _place(self, texture: _Texture, pose: Pose, ctx: Context) -> None:
        columns, rows = texture.picture.size
        width, height = self.width, self.width * rows / columns
        if max(width, height) > LONGEST:
            ctx.error(
                "Image",
                f"The image is {width:g} m x {height:g} m large. Reduce its width.",
                Remedy("width", 1.0, "Set the width to 1 m"),
            )
            return
        cells = texture.cells  # row 0 lies along y = 0
        if self.plane != "Optical":
            cells = np.ascontiguousarray(cells[::-1])
        corner = compose(Pose(wxyz=_TURNS[self.plane]), Pose((-width / 2, -height / 2, 0.0)))
        group = ctx.follow(None, offset=pose, key="image")
        group.add("image", Image(cells, width, height), corner)
