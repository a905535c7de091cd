"""The arrays of markers of the scenes, as nested mappings with gaps for stamps and marks."""

from __future__ import annotations

from typing import Any

from side_by_side.content import Values
from side_by_side.marks import FRAME_Z
from side_by_side.streams import NO_MARK, header

CUBE = 1
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
