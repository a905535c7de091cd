"""The arrays of markers of the scenes, as nested mappings with gaps for stamps and marks."""

from __future__ import annotations

from typing import Any

import numpy as np

from side_by_side.content import VARIANTS, Values
from side_by_side.marks import FRAME_Z
from side_by_side.streams import NO_MARK, header

CUBE, LINE_LIST, TEXT = 1, 5, 9
ADD, DELETE = 0, 2
BLOCK = 10
"""Cubes that come and go in one message of `churn`."""
BLOCKS = 40
LIVING = 20
"""Blocks that are there at a time."""


def cubes(count: int, variants: int = 2) -> list[Values]:
    """Cubes in rows that all sway; the first is marked."""
    return [
        {"markers": [_mark(), *(_cube(i, 0.05 * variant) for i in range(1, count))]}
        for variant in range(variants)
    ]


def lines(points: int, variants: int = 2) -> list[Values]:
    """A tangle of lines, another one each time; the first point is marked."""
    rng = np.random.default_rng(6)
    made = []
    for _ in range(variants):
        xyz = rng.normal(0, 10, (points, 3))
        xyz[0] = NO_MARK, 0, 0
        made.append({"markers": [_marker(0, LINE_LIST, (0, 0, 0), points=xyz)]})
    return made


def texts(count: int) -> list[Values]:
    """Texts in rows that all change; the first is marked."""
    return [
        {
            "markers": [
                _marker(i, TEXT, _place(i) if i else (NO_MARK, 0, FRAME_Z), text=f"{i}: {variant}")
                for i in range(count)
            ]
        }
        for variant in range(VARIANTS)
    ]


def churn() -> list[Values]:
    """A marked cube, and in each message a block of cubes that come and one of those that go."""
    return [
        {
            "markers": [
                _mark(),
                *(_cube(i) for i in _block(variant)),
                *(_cube(i, action=DELETE) for i in _block(variant - LIVING)),
            ]
        }
        for variant in range(BLOCKS)
    ]


def _block(number: int) -> range:
    first = 1 + number % BLOCKS * BLOCK
    return range(first, first + BLOCK)


def _mark() -> Values:
    return _marker(0, CUBE, (NO_MARK, 0, FRAME_Z))


def _cube(id: int, shift: float = 0.0, action: int = ADD) -> Values:
    x, y, z = _place(id)
    return _marker(id, CUBE, (x + shift, y, z), action)


def _place(id: int) -> tuple[float, float, float]:
    return float(id % 100), float(id // 100), 0.0


def _marker(id: int, type: int, xyz: Any, action: int = ADD, **more: Any) -> Values:
    return {
        "header": header("map"),
        "ns": "bench",
        "id": id,
        "type": type,
        "action": action,
        "pose": {
            "position": dict(zip("xyz", map(float, xyz), strict=True)),
            "orientation": {"w": 1.0},
        },
        "scale": {"x": 0.2, "y": 0.2, "z": 0.2},
        "color": {"r": 1.0, "g": 0.5, "a": 1.0},
        **more,
    }
