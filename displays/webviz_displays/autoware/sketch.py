"""Lines, solids, ellipses and texts of many objects, collected to be drawn as few nodes."""

from __future__ import annotations

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Group, Rgb, Solid
from webviz.data.rotations import from_matrices
from webviz_displays.autoware.object_shapes import BOX, CYLINDER
from webviz_displays.autoware.seen_object import SeenObject

F64 = NDArray[np.float64]

TEXT = 0.5
"""Height of texts, metres."""
THIN = 0.05
"""Height of ellipses, metres."""


class ObjectSketch(msgspec.Struct):
    """Items of all objects, each with a colour and the number of its object.

    Args:
        lines: segments (M, 2, 3) by the key of a node.
        texts: position and text.
        solids: shape, pose and size.
        ellipses: position, deviations and angle, and opacity.
    """

    lines: dict[str, list[tuple[F64, Rgb, int]]] = msgspec.field(default_factory=dict)
    texts: list[tuple[F64, str, Rgb, int]] = msgspec.field(default_factory=list)
    solids: list[tuple[SeenObject, Rgb]] = msgspec.field(default_factory=list)
    ellipses: list[tuple[F64, tuple[float, float, float], float, Rgb, int]] = msgspec.field(
        default_factory=list
    )

    def add(self, key: str, segments: F64, color: Rgb, number: int) -> None:
        """Add lines."""
        self.lines.setdefault(key, []).append((segments, color, number))

    def draw_lines(self, key: str, width: float, opacity: float, origin: F64, group: Group) -> None:
        """Draw the lines of a node with a width in metres."""
        parts = self.lines.get(key, ())
        if not parts or not opacity:
            return
        counts = [len(segments) for segments, _, _ in parts]
        colors = np.repeat(np.array([color for _, color, _ in parts], np.uint8), counts, axis=0)
        ids = np.repeat([number for _, _, number in parts], counts)
        segments = np.concatenate([segments for segments, _, _ in parts]) - origin
        both = np.repeat(colors[:, None], 2, axis=1)
        group.lines(key, segments, both, width, "m", ids, opacity)

    def draw_solids(self, opacity: float, origin: F64, group: Group) -> None:
        """Draw boxes and cylinders."""
        kinds: tuple[tuple[int, Solid], ...] = ((BOX, "box"), (CYLINDER, "cylinder"))
        for kind, solid in kinds:
            own = [(each, color) for each, color in self.solids if each.kind == kind]
            if own and opacity:
                group.instances(
                    f"solids {solid}",
                    solid,
                    np.array([each.xyz for each, _ in own]) - origin,
                    np.array([each.size for each, _ in own]),
                    np.array([color for _, color in own], np.uint8),
                    from_matrices(np.array([each.turn for each, _ in own])),
                    opacity,
                    ids=np.array([each.number for each, _ in own]),
                )

    def draw_ellipses(self, origin: F64, group: Group) -> None:
        """Draw the ellipses on the ground."""
        if not self.ellipses:
            return
        places, axes, densities, colors, ids = zip(*self.ellipses, strict=True)
        half = np.array([angle for _, _, angle in axes]) / 2
        zero = np.zeros(len(half))
        group.instances(
            "ellipses",
            "cylinder",
            np.array(places) - origin,
            np.array([(2 * a, 2 * b, THIN) for a, b, _ in axes]),
            np.array(colors, np.uint8),
            np.column_stack((np.cos(half), zero, zero, np.sin(half))),
            np.array(densities, np.float32),
            ids=np.array(ids),
        )

    def draw_texts(self, origin: F64, group: Group) -> None:
        """Draw the texts."""
        if not self.texts:
            return
        places, texts, colors, ids = zip(*self.texts, strict=True)
        xyz, rgb = np.array(places) - origin, np.array(colors, np.uint8)
        group.labels("texts", xyz, texts, TEXT, colors=rgb, ids=np.array(ids))
