"""Fields of markers from tuples."""

from __future__ import annotations

from collections.abc import Sequence


def named(names: str, values: Sequence[float]) -> dict[str, float]:
    """Values by names of one letter."""
    return dict(zip(names, map(float, values), strict=True))


def points(*xyz: tuple[float, float, float]) -> list[dict[str, float]]:
    return [named("xyz", each) for each in xyz]


def colors(*rgba: tuple[float, float, float, float]) -> list[dict[str, float]]:
    return [named("rgba", each) for each in rgba]
