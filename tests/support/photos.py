"""Images as messages: a room with a box, seen by a camera."""

from __future__ import annotations

import io
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

RAW, COMPRESSED = "sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"


def raw(pixels: NDArray[Any], encoding: str) -> dict[str, Any]:
    """A sensor_msgs/Image of pixels (H, W) or (H, W, channels)."""
    height, width = pixels.shape[:2]
    data = np.frombuffer(np.ascontiguousarray(pixels).tobytes(), np.uint8)
    step = len(data) // height
    return {"width": width, "height": height, "encoding": encoding, "step": step, "data": data}


def jpeg(pixels: NDArray[np.uint8], format_: str = "rgb8; jpeg compressed bgr8") -> dict[str, Any]:
    """A sensor_msgs/CompressedImage."""
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "JPEG", quality=95, subsampling=0)
    return {"format": format_, "data": np.frombuffer(file.getvalue(), np.uint8)}


def png16(pixels: NDArray[np.uint16]) -> dict[str, Any]:
    """A sensor_msgs/CompressedImage of 16 bits."""
    file = io.BytesIO()
    Image.fromarray(pixels).save(file, "PNG")
    return {"format": "16UC1; png compressed ", "data": np.frombuffer(file.getvalue(), np.uint8)}


def compressed_depth(millimetres: NDArray[np.uint16]) -> dict[str, Any]:
    """A sensor_msgs/CompressedImage of depths by the transport compressedDepth."""
    data = np.concatenate((np.zeros(12, np.uint8), png16(millimetres)["data"]))
    return {"format": "16UC1; compressedDepth png", "data": data}


def room(width: int = 160, height: int = 120) -> tuple[NDArray[np.uint8], NDArray[np.float32]]:
    """Colours, and depths in metres: floor, wall, and a red box."""
    rows, columns = np.mgrid[:height, :width].astype(np.float32)
    horizon = 0.45 * height
    depths = np.minimum(0.6 * height / np.maximum(rows - horizon, 1.0), 4.0).astype(np.float32)
    shade = np.clip(1.2 - depths / 6.0, 0.2, 1.0)
    colors = np.stack((120 * shade, 130 * shade, 150 * shade), axis=-1)
    box = (abs(columns - 0.6 * width) < 0.12 * width) & (abs(rows - 0.6 * height) < 0.2 * height)
    colors[box], depths[box] = (210, 60, 40), 1.5
    depths[: height // 8, : width // 8] = np.nan
    return colors.astype(np.uint8), depths


INFO = "sensor_msgs/msg/CameraInfo"


def info(width: int = 160, height: int = 120, **changes: Any) -> dict[str, Any]:
    """A sensor_msgs/CameraInfo; the horizontal field of view is 53 degrees."""
    focal, cx, cy = float(width), (width - 1) / 2, (height - 1) / 2
    k = [focal, 0.0, cx, 0.0, focal, cy, 0.0, 0.0, 1.0]
    p = [focal, 0.0, cx, 0.0, 0.0, focal, cy, 0.0, 0.0, 0.0, 1.0, 0.0]
    return {"width": width, "height": height, "k": k, "p": p} | changes
