"""Displays at work: their benches, messages of one pose, and what they tell of an item of them."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from typing import Any

import numpy as np

from webviz import Frames
from webviz.api.picking import Column
from webviz.engine.pipeline.details import details_tree

Benches = Callable[..., Any]
"""The fixtures `bench`, `shown` and `turned`, which make the bench of a display."""
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


def check_columns(at: Any, key: str) -> None:
    """Check that the columns of a node have what `inspect` returns for each of its items.

    Args:
        at: a bench that has drawn one message.
        key: of the node.
    """
    node = at.nodes()[key]
    sample = next(shot.samples[-1] for *_, shot in at.runner.shots() if shot.samples)
    columns = at.runner.columns(node, sample, Frames(at.buffer, at.fixed_frame, at.now_ns))
    ids = range(len(node.xyz)) if node.ids is None else node.ids
    for number, id in enumerate(ids):
        details = at.pick(key, number)
        assert details.title == columns.title.replace("{}", str(id))
        wanted = details_tree(details.values)["fields"]
        found = {
            name: value.text.format(*map(str, np.atleast_1d(value.values[number])))
            if isinstance(value, Column)
            else value
            for name, value in columns.values.items()
        }
        wanted.pop(columns.position, None)  # which the page knows
        assert found.keys() == wanted.keys()
        for name, text in wanted.items():
            assert NUMBER.sub("#", found[name]) == NUMBER.sub("#", text)
            assert [*map(float, NUMBER.findall(found[name]))] == [*map(float, NUMBER.findall(text))]
