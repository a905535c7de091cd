"""Figures of runs: medians over rounds, their spread, and ratios."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from side_by_side.case import CaseResult, Result


@dataclass(frozen=True)
class Figure:
    """One figure over all rounds."""

    median: float
    least: float
    most: float

    @classmethod
    def of(cls, values: Iterable[float | None]) -> Figure | None:
        """Return the figure of the rounds that have a value; None if none has."""
        numbers = [value for value in values if value is not None]
        return cls(float(np.median(numbers)), min(numbers), max(numbers)) if numbers else None


@dataclass(frozen=True)
class Row:
    """One system on one scene under one load."""

    scene: str
    system: str
    load: str
    figures: Mapping[str, Figure | None]


def rows(cases: Sequence[tuple[str, str, CaseResult]]) -> list[Row]:
    """A row for each scene, system and load of all rounds."""
    table: dict[tuple[str, str, str], list[dict[str, float | None]]] = defaultdict(list)
    for scene, system, result in cases:
        for load, each in result.loads.items():
            table[scene, system, load].append(_figures(result, each))
    return [
        Row(*key, {name: Figure.of(each[name] for each in rounds) for name in rounds[0]})
        for key, rounds in table.items()
    ]


def _figures(case: CaseResult, result: Result) -> dict[str, float | None]:
    late = result.latency
    published, drawn_per_s = sum(result.published.values()), sum(result.drawn_per_s.values())
    is_watched = bool(result.drawn_per_s) or result.bytes > 0
    return {
        "p50_ms": float(np.percentile(late, 50)) if late else None,
        "p99_ms": float(np.percentile(late, 99)) if late else None,
        "published_per_s": published,
        "shown_per_s": drawn_per_s if is_watched else None,
        "left_out_per_s": published - drawn_per_s if is_watched else None,
        "cpu_percent": 100 * result.cpu,
        "megabytes_per_s": result.bytes / 1e6 if is_watched else None,
        "resident_mb": result.rss,
        "resident_mb_per_min": result.rss_slope,
        "join_s": result.join_s,
        "start_s": case.start_s,
        "start_cpu_s": case.start_cpu if case.start_s is not None else None,
        "others_percent": 100 * result.others,
    }
