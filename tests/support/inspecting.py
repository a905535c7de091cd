"""Displays at work: their benches, messages of one pose, and what they tell of an item of them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

import numpy as np

from webviz.api.nodes import Instances, Points, has_content
from webviz.shell.testing import DisplayBench

Benches = Callable[..., DisplayBench]
"""The fixtures `bench`, `display_bench`, `turned` and `sensed`, each of which makes a bench."""
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
QUARTER = (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5))
POSE = {"position": {"x": 1.0, "y": 2.0}, "orientation": {"w": 1.0}}
POSE_TOLD = {
    "fields": {
        "Position": "1.0000, 2.0000, 0.0000 m",
        "Orientation": "x 0.0000, y 0.0000, z 0.0000, w 1.0000",
        "Roll, pitch, yaw": "0.00, 0.00, 0.00 °",
    }
}


def colors(bench: DisplayBench) -> list[list[int]]:
    """The colours of the points that a display draws."""
    node = bench.nodes()["points"]
    assert isinstance(node, Points | Instances)
    return np.asarray(node.colors).tolist()


def check_empty(bench: DisplayBench, level: str, words: str) -> None:
    """Check that a display of points draws none, and that its status has these words."""
    statuses = bench.statuses()["Points"]
    assert (statuses[0], words in statuses[1]) == (level, True), statuses
    assert not any(map(has_content, bench.nodes().values()))
