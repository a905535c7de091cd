"""Boxes as solids or edges, with texts above them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from webviz import Context, Display, Pose, Prop, Sample, compose
from webviz.data.rotations import matrices, normalized, w_first
from webviz_displays.shared.colors import Alpha
from webviz_displays.shared.geometry import BOX_EDGES, LONGEST, is_drawable, origin_near
from webviz_displays.shared.properties import opaque

F64 = NDArray[np.float64]

MAX_BOXES = 10_000
"""Boxes drawn per message."""
TEXT_HEIGHT = 0.5
"""Metres (that of vision_msgs_rviz_plugins)."""
ABOVE = 0.6
"""Height of texts over the centre, as a share of that of the box."""

CORNERS = np.array(
    [
        (x, y, z)
        for z in (0.5, -0.5)
        for x, y in ((0.5, 0.5), (-0.5, 0.5), (-0.5, -0.5), (0.5, -0.5))
    ]
)
"""(8, 3), of a box with edges of 1."""


class BoxesDisplay(Display):
    """Base of displays that draw boxes."""

    only_edge: Annotated[bool, Prop(help="Draw the edges only.")] = False
    line_width: Annotated[
        float, Prop(ge=0.01, le=0.1, unit="m", when=("only_edge", True), help="Width of the edges.")
    ] = 0.05
    alpha: Annotated[Alpha, Prop(help="Opacity of the boxes; 0 is invisible.")] = 1.0

    def draw_boxes(
        self,
        boxes: Sequence[Any],
        colors: Sequence[tuple[int, int, int]],
        texts: Sequence[str],
        sample: Sample,
        ctx: Context,
    ) -> None:
        """Draw boxes in the frame and at the stamp of a message.

        Args:
            boxes: each a vision_msgs/BoundingBox3D.
            colors: of each.
            texts: above each, "" for none.
            sample: of the message.
            ctx: to draw in.
        """
        if not boxes:
            ctx.warn("Boxes", "The newest message has no boxes.")
            return
        if self.alpha == 0:
            ctx.warn("Boxes", "Invisible: alpha is 0. Increase it to show the boxes.", opaque())
            return
        drawn_boxes = boxes[:MAX_BOXES]
        centers = np.array([(*_xyz(box.center.position),) for box in drawn_boxes], np.float64)
        sizes = np.array([_xyz(box.size) for box in drawn_boxes], np.float64)
        turns = np.array([_xyzw(box.center.orientation) for box in drawn_boxes], np.float64)
        turns, is_turn = normalized(turns)
        is_valid = is_drawable(centers) & is_turn
        with np.errstate(invalid="ignore"):
            is_valid &= ((sizes >= 0) & (sizes <= LONGEST)).all(axis=1) & (sizes > 0).any(axis=1)
        rows = np.flatnonzero(is_valid)
        self._report(len(boxes), len(drawn_boxes), len(rows), ctx)
        if not len(rows):
            return
        centers, sizes, wxyzs = centers[rows], sizes[rows], w_first(turns[rows])
        origin = np.array(origin_near(centers))
        group = ctx.follow(None, offset=compose(sample.pose, Pose(tuple(origin.tolist()))))
        palette = np.array(colors, np.uint8)[rows]
        if self.only_edge:
            corners = np.einsum("nij,nkj->nki", matrices(wxyzs), CORNERS * sizes[:, None])
            segments = (corners + (centers - origin)[:, None])[:, BOX_EDGES].reshape(-1, 2, 3)
            ends = np.repeat(palette, 2 * len(BOX_EDGES), axis=0).reshape(-1, 2, 3)
            ids = np.repeat(rows, len(BOX_EDGES))
            group.lines("edges", segments, ends, self.line_width, "m", ids, self.alpha)
        else:
            group.instances(
                "boxes", "box", centers - origin, sizes, palette, wxyzs, self.alpha, ids=rows
            )
        above = [(row, texts[row]) for row in rows.tolist() if texts[row]]
        if above:
            labelled = np.searchsorted(rows, [row for row, _ in above])
            places = centers[labelled] - origin
            places[:, 2] += ABOVE * sizes[labelled, 2]
            written = tuple(text for _, text in above)
            group.labels("texts", places, written, TEXT_HEIGHT, ids=rows[labelled])

    def _report(self, count: int, limit: int, valid: int, ctx: Context) -> None:
        if valid < limit:
            ctx.error(
                "Boxes",
                f"Boxes with an invalid size, position or orientation: {limit - valid} of {limit}. "
                "Fix the publisher.",
            )
        elif limit < count:
            ctx.warn("Boxes", f"Showing the first {MAX_BOXES} of {count} boxes.")
        else:
            ctx.ok("Boxes", "Showing 1 box." if count == 1 else f"Showing {count} boxes.")


def _xyz(vector: Any) -> tuple[float, float, float]:
    return vector.x, vector.y, vector.z


def _xyzw(turn: Any) -> tuple[float, float, float, float]:
    return turn.x, turn.y, turn.z, turn.w
