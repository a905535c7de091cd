"""Worlds of the simulator, drawn as text."""

from __future__ import annotations

import numpy as np

from webviz_sim.pose import Pose2D
from webviz_sim.world import World

MEANING = {"#": 100, ".": 0, "?": -1}


def draw_world(text: str, resolution: float = 1.0, origin: Pose2D = Pose2D()) -> World:  # noqa: B008
    """Return a world of cells: # wall, . free, ? unknown; the first line is topmost."""
    cells = [[MEANING[cell] for cell in line] for line in reversed(text.split())]
    return World(np.array(cells, np.int8), resolution, origin)
