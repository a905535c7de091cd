"""Line segments and arrows."""

from __future__ import annotations

import numpy as np
from viser import SceneApi, SceneNodeHandle

from webviz.api.nodes import U8, Arrows, Lines
from webviz.edges.scene.drawn import Props, SingleNode, finite, rgb_array

_NOTHING = np.zeros((0, 2, 3), np.float32)
_BLACK = np.zeros(3, np.uint8)

OPACITY_BIT = 40
"""Binary place of the opacity in the width of lines: far below what float32 resolves."""


class LinesDrawn(SingleNode[Lines]):
    """Lines as viser's line segments."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """A node without segments."""
        return scene.add_line_segments(name, _NOTHING, _BLACK, thickness=1.0)

    def props(self, node: Lines) -> tuple[Props, ...]:
        """Segments with colours, then the look; segments that are not finite are dropped."""
        props = _finite_segments(node)
        if props["colors"].ndim > 1:  # one colour for all is taken as sRGB
            props["colors"] = linear(props["colors"])
        return (
            props,
            {
                "thickness": _with_opacity(node.width, node.opacity),
                "thickness_units": "screen" if node.unit == "px" else "world",
            },
        )


class ArrowsDrawn(SingleNode[Arrows]):
    """Arrows as viser's arrows."""

    def create(self, scene: SceneApi, name: str) -> SceneNodeHandle:
        """A node without arrows."""
        return scene.add_arrows(name, _NOTHING, _BLACK)

    def props(self, node: Arrows) -> tuple[Props, ...]:
        """Arrows with colours, then the look; arrows that are not finite are dropped."""
        props = _finite_segments(node)
        props["colors"] = linear(props["colors"])
        return (
            props,
            {
                "shaft_radius": float(node.shaft_radius),
                "head_radius": float(node.head_radius),
                "head_length": float(node.head_length),
            },
        )


def _with_opacity(width: float, opacity: float) -> float:
    """Return a width whose last bits are an opacity, in steps of 1/255.

    viser's lines are opaque. Their width reaches the page as a double, which lines.js makes use of.
    """
    return float(np.float32(width)) * (1.0 + round(255 * (1.0 - opacity)) * 2.0**-OPACITY_BIT)


def linear(colors: U8) -> U8:
    """sRGB to linear light (IEC 61966-2-1), as viser expects vertex colours."""
    return _LINEAR[colors]


def _linear_table() -> U8:
    srgb = np.arange(256) / 255
    light = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    return np.round(light * 255).astype(np.uint8)


_LINEAR = _linear_table()


def _finite_segments(node: Lines | Arrows) -> Props:
    segments, colors = finite(node.segments, along=(node.colors,))
    return {"points": segments, "colors": rgb_array(colors, len(segments))}
