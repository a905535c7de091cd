"""Line segments and arrows."""

from __future__ import annotations

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import F32, U8, Arrows, Lines, Rgb
from webviz.scene.schemes import SCHEMES
from webviz.scene.visual import Props, SingleNode, finite, marked, rgb_array

_NOTHING = np.zeros((0, 2, 3), np.float32)
_BLACK = np.zeros(3, np.uint8)

_OF_THEME = 256
"""Added to it for lines in the colour that each page has for grids."""


class LinesVisual(SingleNode[Lines]):
    """Lines as viser's line segments."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Return a node without segments."""
        return scene.add_line_segments(name, _NOTHING, _BLACK, thickness=1.0)

    def props(self, node: Lines) -> tuple[Props, ...]:
        """Segments with colours, then the look; segments that are not finite are dropped."""
        colors = SCHEMES["dark"]["grid"] if node.colors is None else node.colors
        props = _finite_segments(node.segments, colors)
        if props["colors"].ndim > 1:  # one colour for all is taken as sRGB
            props["colors"] = linear(props["colors"])
        return (
            props,
            {
                "thickness": marked(node.width, node.opacity, _OF_THEME * (node.colors is None)),
                "thickness_units": "screen" if node.unit == "px" else "world",
            },
        )


class ArrowsVisual(SingleNode[Arrows]):
    """Arrows as viser's arrows."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """Return a node without arrows."""
        return scene.add_arrows(name, _NOTHING, _BLACK)

    def props(self, node: Arrows) -> tuple[Props, ...]:
        """Arrows with colours, then the look; arrows that are not finite are dropped."""
        props = _finite_segments(node.segments, node.colors)
        props["colors"] = linear(props["colors"])
        return (
            props,
            {
                "shaft_radius": float(node.shaft_radius),
                "head_radius": float(node.head_radius),
                "head_length": float(node.head_length),
            },
        )


def linear(colors: U8) -> U8:
    """sRGB to linear light (IEC 61966-2-1), as viser expects vertex colours."""
    return _LINEAR[colors]


def _linear_table() -> U8:
    srgb = np.arange(256) / 255
    light = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return np.round(light * 255).astype(np.uint8)


_LINEAR = _linear_table()


def _finite_segments(segments: F32, colors: U8 | Rgb) -> Props:
    segments, colors = finite(segments, along=(colors,))
    return {"points": segments, "colors": rgb_array(colors, len(segments))}
