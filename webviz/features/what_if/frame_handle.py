"""The handle of a frame that is tried out: arrows to move it and rings to turn it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from webviz.api.capabilities import Draggable
from webviz.api.connection import GraphConnection
from webviz.api.context import Context
from webviz.api.display import Display
from webviz.api.handles import Control, Drag, Handle, Wxyz
from webviz.api.nodes import Mesh, Pose
from webviz.api.sample import Sample
from webviz.data.rotations import matrices

KEY = "m0"
ARROW_M = 0.5, 0.8
"""Distances of both ends of an arrow from the middle."""
SHAFT_M, HEAD_M, HEAD_LENGTH_M = 0.025, 0.06, 0.12
RING_M = 0.42, 0.025
"""Radius of a ring, and of its tube."""
STEPS, SIDES = 48, 8
HALF = 0.5**0.5
TURNED: Sequence[Wxyz] = (
    (1.0, 0.0, 0.0, 0.0),
    (HALF, 0.0, 0.0, HALF),
    (HALF, 0.0, -HALF, 0.0),
)
"""Turns of the x axis to x, y and z."""
COLORS = (204, 60, 60), (60, 160, 60), (70, 110, 220)


@dataclass(eq=False)
class FrameTrial:
    """A frame that is tried in another pose.

    Args:
        frame, parent: ids.
        published: its pose in the parent before.
        pose: its pose in the parent now.
        moved: called with a pose in the parent when a browser drags it.
    """

    frame: str
    parent: str
    published: Pose
    pose: Pose
    moved: Callable[[Pose], None]
    version: int = 0
    """Changes with the pose."""
    handles: Mapping[str, Handle] = field(init=False)

    def __post_init__(self) -> None:
        """Make its handle, which stays the same."""
        moves = [
            Control(f"move {axis}", "move_axis", "inherit", TURNED[i], True)
            for i, axis in enumerate("xyz")
        ]
        turns = [
            Control(f"rotate {axis}", "rotate_axis", "inherit", TURNED[i], True)
            for i, axis in enumerate("xyz")
        ]
        self.handles = {KEY: Handle(self.frame, self.parent, (*moves, *turns))}


class FrameHandle(Display, Draggable):
    """The handle of a frame that is tried out."""

    reports_only = True

    trial: Any = None

    def handles(self, ctx: Context) -> Mapping[str, Handle]:
        """Return the one handle."""
        return self.trial.handles

    def drag(self, drag: Drag, connection: GraphConnection, ctx: Context) -> None:
        """Try the frame where a browser moves it."""
        if drag.pose is not None:
            self.trial.moved(drag.pose)
            connection.wake()

    def depends(self, ctx: Context) -> object:
        """Draw again when the frame moves."""
        return self.trial.version

    def draw_all(self, samples: Sequence[Sample], ctx: Context) -> None:
        """Three arrows, three rings and the name."""
        trial: FrameTrial = self.trial
        group = ctx.follow(trial.parent, offset=trial.pose, is_rigid=True, key=KEY)
        group.lines(f"place/{KEY}", (), (0, 0, 0))
        begin, end = ARROW_M
        for index, color in enumerate(COLORS):
            axis = matrices(TURNED[index])[:, 0]
            segments = [(sign * begin * axis, sign * end * axis) for sign in (1.0, -1.0)]
            group.arrows(f"c{index}/{KEY}/arrows", segments, color, SHAFT_M, HEAD_M, HEAD_LENGTH_M)
            ring = Mesh(*_ring(TURNED[index]), color)
            group.add(f"c{index + 3}/{KEY}/ring", ring)


def _ring(wxyz: Wxyz) -> tuple[Any, Any]:
    """Return the vertices and faces of a torus about the turned x axis."""
    radius, tube = RING_M
    around = np.arange(STEPS)[:, None] * (2 * np.pi / STEPS)
    about = np.arange(SIDES) * (2 * np.pi / SIDES)
    far = radius + tube * np.cos(about)
    height = np.broadcast_to(tube * np.sin(about), (STEPS, SIDES))
    vertices = np.stack((height, far * np.cos(around), far * np.sin(around)), axis=-1)
    a = np.arange(STEPS * SIDES).reshape(STEPS, SIDES)
    b = np.roll(a, -1, axis=0)
    c, d = np.roll(b, -1, axis=1), np.roll(a, -1, axis=1)
    faces = np.concatenate((np.stack((a, b, c), -1), np.stack((a, c, d), -1))).reshape(-1, 3)
    turned = vertices.reshape(-1, 3) @ matrices(wxyz).T
    return turned.astype(np.float32), faces.astype(np.uint32)
