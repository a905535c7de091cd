"""Cameras with distortion, and where OpenCV sees points with them.

Made by OpenCV 5.0.0, with R as a 3 x 3 matrix:

    rotation = cv2.Rodrigues(R.T)[0]
    cv2.projectPoints(RAYS, rotation, np.zeros(3), K, D)
    cv2.fisheye.projectPoints(RAYS[:, None], rotation, np.zeros(3), K, D)  # equidistant
"""

from __future__ import annotations

from typing import Any

import numpy as np

WIDTH, HEIGHT = 640, 480
K = [600.0, 0.0, 310.5, 0.0, 610.0, 242.25, 0.0, 0.0, 1.0]
P = [580.0, 0.0, 320.0, -58.0, 0.0, 580.0, 240.0, 0.0, 0.0, 0.0, 1.0, 0.0]
R = [
    *(0.999350075830, -0.030092988824, -0.019845351159),
    *(0.029893012156, 0.999500058331, -0.010297631832),
    *(0.020145316161, 0.009697701828, 0.999750029165),
]
"""cv2.Rodrigues(np.array([0.01, -0.02, 0.03]))[0]"""
RAYS = np.array(
    [(0, 0, 1), (0.2, -0.1, 1), (-0.4, 0.3, 1), (0.5, 0.4, 1), (-0.53, -0.41, 1)], np.float64
)
"""Rays in the rectified camera."""

CAMERAS: dict[str, tuple[str, list[float], list[tuple[float, float]]]] = {
    "plumb_bob": (
        "plumb_bob",
        [-0.28, 0.09, 0.001, -0.0005, -0.01],
        [
            (322.5884, 248.1665),
            (439.0241, 184.3145),
            (102.5304, 425.7907),
            (598.8823, 460.1029),
            (32.6975, 34.6508),
        ],
    ),
    "rational_polynomial": (
        "rational_polynomial",
        [0.9, 0.15, 0.0003, -0.0002, 0.01, 1.2, 0.35, 0.04],
        [
            (322.5883, 248.1663),
            (438.9479, 184.3293),
            (103.1598, 425.1714),
            (598.3347, 459.4360),
            (33.2538, 34.8380),
        ],
    ),
    "thin prism": (
        "rational_polynomial",
        [0.9, 0.15, 0.0003, -0.0002, 0.01, 1.2, 0.35, 0.04, 0.001, -0.002, 0.0015, 0.0007],
        [
            (322.5886, 248.1667),
            (438.9780, 184.3826),
            (103.2347, 425.4140),
            (598.3611, 459.9358),
            (33.2988, 35.2823),
        ],
    ),
    "equidistant": (
        "equidistant",
        [-0.01, 0.02, -0.003, 0.0005],
        [
            (322.5881, 248.1661),
            (438.6803, 184.4426),
            (104.8434, 423.6678),
            (595.2001, 456.9487),
            (36.2197, 36.9468),
        ],
    ),
}
"""Model, D, and the pixels (column, row) of `RAYS`, by name."""


def info(name: str, **changes: Any) -> dict[str, Any]:
    """A sensor_msgs/CameraInfo with one of these lenses."""
    model, d, _ = CAMERAS[name]
    size = {"width": WIDTH, "height": HEIGHT}
    return {**size, "distortion_model": model, "d": d, "k": K, "r": R, "p": P} | changes
