"""How the TF display draws frames. All sizes and colours are RViz's, at a marker scale of 1."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from webviz import Group
from webviz_displays.fading import faded
from webviz_displays.geometry import matrices

F64 = NDArray[np.float64]

AXIS_LENGTH, AXIS_RADIUS = 0.2, 0.01
SHAFT_DIAMETER, HEAD_DIAMETER, HEAD_LENGTH = 0.01, 0.04, 0.1
SHORT_HEAD_LENGTH = 0.005
"""RViz flattens the head of an arrow shorter than a head, to a tenth of the arrow."""
TEXT_HEIGHT = 0.1
LEAST_DISTANCE = 0.001
"""Metres to the parent from which on there is an arrow."""

_AXES = np.array(((255.0, 0.0, 0.0), (0.0, 255.0, 0.0), (0.0, 0.0, 255.0)))
_SHAFT = np.array((204.0, 204.0, 76.5))
_HEAD = np.array((255.0, 25.5, 153.0))


@dataclass(frozen=True, eq=False)
class Marks:
    """The frames to draw.

    Args:
        positions: (N, 3), metres.
        greyness, opacity: (N,), 0 to 1.
    """

    positions: F64
    greyness: F64
    opacity: F64

    def only(self, rows: NDArray[np.bool_]) -> Marks:
        """Some of them."""
        return Marks(self.positions[rows], self.greyness[rows], self.opacity[rows])

    def colors(self, color: F64) -> NDArray[np.uint8]:
        """uint8 (N, M, 3): the colours (M, 3) as each frame's age has them."""
        return faded(np.broadcast_to(color, (len(self.positions), *color.shape)), *self._age)

    @property
    def _age(self) -> tuple[F64, F64]:
        return self.greyness, self.opacity


def add_axes(group: Group, marks: Marks, wxyzs: F64, scale: float) -> None:
    """Axes; those of ageing frames as coloured lines, for the batch has fixed colours."""
    length, radius = AXIS_LENGTH * scale, AXIS_RADIUS * scale
    fresh = marks.greyness == 0.0
    if fresh.any():
        group.axes("axes", marks.positions[fresh], wxyzs[fresh], length, radius)
    if not fresh.all():
        ageing = marks.only(~fresh)
        origins = np.repeat(ageing.positions[:, None], 3, axis=1)
        ends = origins + length * np.swapaxes(matrices(wxyzs[~fresh]), 1, 2)
        colors = np.repeat(ageing.colors(_AXES).reshape(-1, 1, 3), 2, axis=1)
        group.lines("ageing axes", np.stack((origins, ends), axis=2), colors, 2 * radius, "m")


def add_arrows(group: Group, marks: Marks, tips: F64, scale: float) -> None:
    """Arrows to `tips` (N, 3), a shaft of one colour and a head of another."""
    ways = tips - marks.positions
    distances = np.linalg.norm(ways, axis=1)
    far = distances > LEAST_DISTANCE
    marks, tips, distances = marks.only(far), tips[far], distances[far, None]
    if not len(tips):
        return
    directions = ways[far] / distances
    is_long = distances[:, 0] >= HEAD_LENGTH * scale
    lengths = np.where(is_long, HEAD_LENGTH, SHORT_HEAD_LENGTH)[:, None] * scale
    necks = tips - np.minimum(lengths, distances) * directions
    shafts = np.stack((marks.positions, necks), axis=1)
    colors = np.repeat(marks.colors(_SHAFT[None]), 2, axis=1)
    group.lines("shafts", shafts, colors, SHAFT_DIAMETER * scale, "m")
    heads = np.stack((necks, tips), axis=1)
    colors = marks.colors(_HEAD[None])[:, 0]
    for key, rows, length in (
        ("heads", is_long, HEAD_LENGTH),
        ("short heads", ~is_long, SHORT_HEAD_LENGTH),
    ):
        if rows.any():
            group.arrows(
                key,
                heads[rows],
                colors[rows],
                shaft_radius=0.5 * SHAFT_DIAMETER * scale,
                head_radius=0.5 * HEAD_DIAMETER * scale,
                head_length=length * scale,
            )


def add_names(group: Group, marks: Marks, names: tuple[str, ...], scale: float) -> None:
    """Names below the origins."""
    height = TEXT_HEIGHT * scale
    group.labels("names", marks.positions - (0.0, 0.0, height), names, height)
