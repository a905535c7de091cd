"""Images in the plain viewer: behind the scene, and depths as a cloud."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
import PIL.Image
import viser

from side_by_side.systems.shades import rainbow


def on_image(scene: viser.SceneApi, message: Any) -> None:
    """An rgb8 image behind the scene."""
    data = np.frombuffer(message.data, np.uint8)
    scene.set_background_image(data.reshape(message.height, message.width, 3))


def on_compressed(scene: viser.SceneApi, message: Any) -> None:
    """A compressed image behind the scene, which viser wants as an array."""
    opened = PIL.Image.open(io.BytesIO(message.data)).convert("RGB")
    scene.set_background_image(np.asarray(opened))


def depth_points(depth: Any, info: Any) -> tuple[np.ndarray, np.ndarray]:
    """Points (N, 3) of depths in mm, coloured by their depth: uint8 (N, 3)."""
    z = np.frombuffer(depth.data, np.uint16).reshape(depth.height, depth.width) / 1000
    columns, rows = np.meshgrid(np.arange(depth.width), np.arange(depth.height))
    x = (columns - info.p[2]) * z / info.p[0]
    y = (rows - info.p[6]) * z / info.p[5]
    points = np.stack([x, y, z], axis=-1)[z > 0].astype(np.float32)
    return points, rainbow(points[:, 2])
