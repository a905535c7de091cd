"""Appearance of frames in the TF display. All sizes and colours are RViz's, at a marker scale of 1.

Frames are drawn in at most three batches: fresh, grey and faint. Transparent solids have to be
sorted by a browser, and made anew for each new opacity, so they are kept apart from the others.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Group, Rgb, Solid
from webviz.data.rotations import matrices
from webviz_displays.shared.rods import Rods, from_z, rods, turned_rods

GREY = 178.5
"""RViz's 0.7 of white."""

STILL_S = 1.0
"""Age from which a frame that has stopped ages from the reception of its transform."""

STEPS = 10
"""Levels of opacity: the browser rebuilds a batch of transparent solids for each new one."""


class Ages:
    """Time since the transform of each frame last changed, in ROS time.

    A stamp is not enough: that of a bag played without its clock, or of a machine whose clock is
    wrong, may be of another day, yet its frames move. A frame therefore ages from when its newest
    stamp was received, whether that was seen in passing or not.
    """

    def __init__(self) -> None:
        self._stamps_ns = np.zeros(0, np.int64)
        self._changed_ns = np.zeros(0, np.int64)
        self._is_exact = np.zeros(0, np.bool_)
        """True if a time is that of reception, instead of the tick that noticed it."""

    def update(
        self,
        stamps_ns: NDArray[np.int64],
        now_ns: int,
        seen_ns: Callable[[], Mapping[int, int]],
    ) -> F64:
        """Ages in seconds, float64 (N,); 0 for frames with static transforms only.

        Args:
            stamps_ns: int64 (N,), the newest stamp of each frame, 0 for static ones. Frames keep
                their places from call to call; new ones are appended.
            now_ns: ROS time.
            seen_ns: the times of reception by stamp, both in nanoseconds; asked only for frames
                that are new or that have stopped.
        """
        known_count, count = len(self._stamps_ns), len(stamps_ns)
        same = np.zeros(count, np.bool_)
        same[:known_count] = stamps_ns[:known_count] == self._stamps_ns
        changed_ns = np.full(count, now_ns)
        changed_ns[:known_count] = np.where(same[:known_count], self._changed_ns, now_ns)
        is_exact = stamps_ns == 0
        is_exact[:known_count] |= same[:known_count] & self._is_exact
        is_asked = ~is_exact & (now_ns - changed_ns > STILL_S * 1e9)
        is_asked[known_count:] |= ~is_exact[known_count:]
        if is_asked.any():
            received_ns = seen_ns()
            for place in np.flatnonzero(is_asked).tolist():
                stamp_ns = int(stamps_ns[place])
                noticed_ns = int(changed_ns[place]) if place < known_count else stamp_ns
                changed_ns[place] = min(received_ns.get(stamp_ns, noticed_ns), now_ns)
            is_exact |= is_asked
        self._stamps_ns, self._changed_ns, self._is_exact = stamps_ns, changed_ns, is_exact
        return np.where(stamps_ns == 0, 0.0, (now_ns - changed_ns) / 1e9)


def fade(ages: F64, timeout: float) -> tuple[F64, F64]:
    """Greyness and opacity of frames by age, each 0 to 1, as in RViz.

    Up to a third of the timeout a frame has its colours, up to two thirds it turns grey, then it
    becomes transparent, in `STEPS` steps.
    """
    thirds = 3.0 * ages / timeout
    opacity = np.ceil(np.clip(3.0 - thirds, 0.0, 1.0) * STEPS) / STEPS
    return np.clip(thirds - 1.0, 0.0, 1.0), opacity


def faded(colors: F64, greyness: F64) -> U8:
    """Colours (M, 3), 0 to 255, for N frames of this greyness (N,); uint8 (N, M, 3)."""
    return np.rint(colors + greyness[:, None, None] * (GREY - colors)).astype(np.uint8)


F64 = NDArray[np.float64]
U8 = NDArray[np.uint8]

AXIS_LENGTH, AXIS_DIAMETER = 0.2, 0.02
SHAFT_DIAMETER, HEAD_DIAMETER, HEAD_LENGTH = 0.01, 0.04, 0.1
TEXT_HEIGHT = 0.1
LEAST_DISTANCE = 0.001
"""Metres to the parent above which an arrow is drawn."""

_AXES = np.array(((255.0, 0.0, 0.0), (0.0, 255.0, 0.0), (0.0, 0.0, 255.0)))
_ARROW = np.array(((204.0, 204.0, 76.5), (255.0, 25.5, 153.0)))
"""Shaft and head."""
_FRESH_ARROW: tuple[Rgb, Rgb] = ((204, 204, 76), (255, 26, 153))
"""The same as they are drawn."""


class Marks(msgspec.Struct, frozen=True, eq=False):
    """The frames to draw.

    Args:
        positions: (N, 3), metres.
        greyness, opacity: (N,), 0 to 1.
        names: (N,), frame ids.
    """

    positions: F64
    greyness: F64
    opacity: F64
    names: NDArray[np.object_]

    def only(self, rows: NDArray[np.bool_]) -> Marks:
        """Return a subset of the frames."""
        if rows.all():
            return self
        return Marks(
            self.positions[rows], self.greyness[rows], self.opacity[rows], self.names[rows]
        )


def add_axes(group: Group, marks: Marks, wxyzs: F64, scale: float) -> None:
    """Axes; a batch of axes has fixed colours, so those of ageing frames are solids."""
    length, diameter = AXIS_LENGTH * scale, AXIS_DIAMETER * scale
    fresh = marks.greyness == 0.0
    if fresh.any():
        names = marks.names[fresh]
        group.axes("axes", marks.positions[fresh], wxyzs[fresh], length, diameter / 2, names)
    if fresh.all():
        return
    ageing = marks.only(~fresh)
    tails = np.repeat(ageing.positions, 3, axis=0)
    ways = length * np.swapaxes(matrices(wxyzs[~fresh]), 1, 2).reshape(-1, 3)
    colors = faded(_AXES, ageing.greyness).reshape(-1, 3)
    opacity, names = np.repeat(ageing.opacity, 3), np.repeat(ageing.names, 3)
    solids = rods(tails, tails + ways, diameter)
    _add(group, "cylinder", "old axes", solids, colors, opacity, names)


def add_arrows(group: Group, marks: Marks, tips: F64, scale: float) -> None:
    """Arrows to `tips` (N, 3), a shaft of one colour and a head of another."""
    ways = tips - marks.positions
    distances = np.linalg.norm(ways, axis=1)
    far = distances > LEAST_DISTANCE
    marks, tips, ways, distances = marks.only(far), tips[far], ways[far], distances[far]
    if not len(tips):
        return
    # As in RViz an arrow shorter than a head has a head of that share of its length.
    full = HEAD_LENGTH * scale
    lengths = np.minimum(np.where(distances < full, full * distances, full), distances)
    necks = tips - (lengths / distances)[:, None] * ways
    turns = from_z(ways / distances[:, None])
    shafts = turned_rods(marks.positions, necks, SHAFT_DIAMETER * scale, distances - lengths, turns)
    heads = turned_rods(necks, tips, HEAD_DIAMETER * scale, lengths, turns)
    shaft_colors, head_colors = _arrow_colors(marks.greyness)
    _add(group, "cylinder", "shafts", shafts, shaft_colors, marks.opacity, marks.names)
    _add(group, "cone", "heads", heads, head_colors, marks.opacity, marks.names)


def _arrow_colors(greyness: F64) -> tuple[U8 | Rgb, U8 | Rgb]:
    """Return the colours of shafts and heads, one for all if they are fresh."""
    if not greyness.any():
        return _FRESH_ARROW
    shafts, heads = np.moveaxis(faded(_ARROW, greyness), 1, 0)
    return shafts, heads


def add_names(group: Group, marks: Marks, scale: float) -> None:
    """Names below the origins, from any viewpoint."""
    texts = tuple(marks.names.tolist())
    height = TEXT_HEIGHT * scale
    group.labels("names", marks.positions, texts, height, below=True, ids=marks.names)


def _add(
    group: Group,
    shape: Solid,
    key: str,
    solids: Rods,
    colors: U8 | Rgb,
    opacity: F64,
    names: NDArray[np.object_],
) -> None:
    """Draw opaque solids as `key`, transparent ones separately; one colour is of opaque ones."""
    faint = opacity < 1.0
    if not faint.any():
        group.instances(key, shape, *solids[:2], colors, solids.wxyzs, ids=names)
        return
    colors = np.asarray(colors, np.uint8)
    if not faint.all():
        positions, scales, wxyzs = (array[~faint] for array in solids)
        group.instances(key, shape, positions, scales, colors[~faint], wxyzs, ids=names[~faint])
    positions, scales, wxyzs = (array[faint] for array in solids)
    each = opacity[faint].astype(np.float32)
    group.instances(
        f"faint {key}", shape, positions, scales, colors[faint], wxyzs, each, ids=names[faint]
    )
