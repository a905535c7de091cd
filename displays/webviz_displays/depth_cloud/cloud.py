"""Points and colours of depth images."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz.api.decoded import opened
from webviz.api.pictures import Encoded
from webviz.data.images import CameraModel, ImageError, RawImage, Tone, decoding, to_rgb, values
from webviz.data.memory import DECODING, OverBudgetError
from webviz.data.words import counted
from webviz_displays.depth_cloud.hidden import HiddenPoints
from webviz_displays.image.transports import Decompression

NEAREST_M, FARTHEST_M = 1e-6, 1e6
_POINT_BYTES = 50
"""Bytes that a point takes on its way, at most: 48 were measured, with colours and hidden
points."""

U8 = NDArray[np.uint8]
Behind = Callable[[NDArray[np.float32], NDArray[np.bool_], U8 | None], HiddenPoints]
"""Points behind an image: takes its depths, their validity mask and its colours."""


class DepthPoints(NamedTuple):
    """Points of a depth image and a colour image.

    Args:
        xyz: float32 (N, 3), metres in the optical frame.
        colors: uint8 (N, 3), None without a colour image.
        ids: (N,), index of the pixel of each in its image.
        pixels: number of pixels of the depth image.
        hidden: number of the last points, which others hide from the camera.
        spacing: distance of neighbouring points 1 m ahead, metres.
        remark: why colours or sizes do not fit, "" if they do.
    """

    xyz: NDArray[np.float32]
    colors: U8 | None
    ids: NDArray[np.intp]
    pixels: int
    hidden: int
    spacing: float
    remark: str


def depth_points(
    depth: RawImage | Encoded | Decompression,
    color: RawImage | Encoded | Decompression | None,
    model: CameraModel,
    most: int,
    behind: Behind | None = None,
) -> DepthPoints:
    """Return the points of a depth image, evenly thinned out to `most` at most; 0 is all.

    With `behind` the points that they hide follow, up to as many again.

    Raises:
        ImageError: it is not a depth image, or of another size than the camera info.
    """
    image = depth.run() if isinstance(depth, Decompression) else depth
    if isinstance(image, Encoded) or image.layout.channels != 1 or not image.layout.unit:
        name = image.mime if isinstance(image, Encoded) else image.encoding
        raise ImageError(f"Expected depths as 16UC1 (mm) or 32FC1 (m), got {name}.")
    if (image.width, image.height) != (model.width, model.height):
        raise ImageError(
            f"The depth image has {image.width} x {image.height} pixels, the camera info "
            f"{model.width} x {model.height}. Choose the camera info of the depth camera."
        )
    count = image.width * image.height
    step = max(1, math.ceil(math.sqrt(count / most))) if most else 1
    size = -(-image.width // step), -(-image.height // step)
    with decoding(*size, _POINT_BYTES):
        points = _points(image, color, model, step, behind)
    try:
        DECODING.hold(points.xyz, points.xyz.nbytes + points.ids.nbytes)
    except OverBudgetError as error:
        raise ImageError(
            f"The {counted(len(points.xyz), 'point')} {error}. Lower Decay Time or Max Points."
        ) from None
    return points


def _points(
    image: RawImage,
    color: RawImage | Encoded | Decompression | None,
    model: CameraModel,
    step: int,
    behind: Behind | None,
) -> DepthPoints:
    """Return the points of every `step`-th pixel of an image."""
    numbers = values(image)[::step, ::step]
    depths = numbers.astype(np.float32)
    if image.layout.unit == "mm":
        depths *= np.float32(0.001)
    with np.errstate(invalid="ignore"):
        is_valid = (depths > NEAREST_M) & (depths < FARTHEST_M)
    grid, remark = _colors(color, image, step)
    layers = [(depths, is_valid, grid)]
    if behind is not None:
        hidden = behind(depths, is_valid, grid)
        layers.append((hidden.depths, hidden.is_hidden, hidden.colors))
    ids = [np.flatnonzero(chosen) for _, chosen, _ in layers]
    own = list(zip(layers, ids, strict=True))
    xyz = np.concatenate([_rows(model.points(z, step), chosen) for (z, _, _), chosen in own])
    colors = [_rows(each, chosen) for (_, _, each), chosen in own if each is not None]
    pixels = np.concatenate(ids)
    if step > 1:
        rows, columns = np.divmod(pixels, depths.shape[1])
        pixels = rows * step * image.width + columns * step
    return DepthPoints(
        xyz,
        np.concatenate(colors) if colors else None,
        pixels,
        image.width * image.height,
        len(xyz) - len(ids[0]),
        step / model.fx,
        remark,
    )


def _rows(grid: NDArray[Any], chosen: NDArray[np.intp]) -> NDArray[Any]:
    """Return selected triples (N, 3) of a grid (H, W, 3)."""
    flat = grid.reshape(-1, 3)
    return flat if len(chosen) == len(flat) else flat.take(chosen, axis=0)


def _colors(
    color: RawImage | Encoded | Decompression | None,
    depth: RawImage,
    step: int,
) -> tuple[U8 | None, str]:
    """Colours (H, W, 3) of every `step`-th pixel, and why there are none."""
    if color is None:
        return None, ""
    try:
        image = color.run() if isinstance(color, Decompression) else color
        pixels: NDArray[Any]
        if isinstance(image, Encoded):
            pixels = np.asarray(opened(image))
        else:
            with decoding(image.width, image.height, image.layout.work_bytes):
                pixels = to_rgb(values(image), image.layout, Tone(0.0, 65535.0))
    except ImageError as error:
        return None, str(error)
    if pixels.shape[:2] != (depth.height, depth.width):
        return None, (
            f"The colour image has {pixels.shape[1]} x {pixels.shape[0]} pixels, the depth image "
            f"{depth.width} x {depth.height}. Choose the one that is registered to the depths."
        )
    thinned = pixels[::step, ::step]
    if thinned.ndim == 2:
        thinned = np.repeat(thinned[..., None], 3, axis=2)
    return thinned, ""
