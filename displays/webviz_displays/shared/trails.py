"""Trails of links."""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping
from math import dist

import numpy as np

from webviz import Context, Pose
from webviz_displays.shared.geometry import origin_near

ELEMENTS = 100
SPACING = 0.02
"""Metres between the points of a trail: RViz's ribbon of 2 m in 100 elements."""

WIDTH = 0.01
COLOR = (0, 128, 128)

Position = tuple[float, float, float]


class Trails:
    """Trails of links in one fixed frame; each keeps the last 2 m."""

    def __init__(self) -> None:
        self._points: dict[str, deque[Position]] = {}

    def update(self, positions: Mapping[str, Position | None]) -> None:
        """Record where the links are now, None if unknown; other links are forgotten."""
        self._points = {link: self._points.get(link, deque(maxlen=ELEMENTS)) for link in positions}
        for link, position in positions.items():
            points = self._points[link]
            if position and not (points and dist(points[-1], position) < SPACING):
                points.append(position)

    def draw(self, ctx: Context) -> None:
        """Draw the trails."""
        for link, points in self._points.items():
            if len(points) > 1:
                near = origin_near(points)
                group = ctx.follow(None, offset=Pose(near), key=link)
                group.strip(f"{link} trail", np.subtract(points, near), COLOR, WIDTH, "m")
