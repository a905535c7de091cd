"""The tree of transforms, and the transform between two frames."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

import numpy as np

from webviz.data.rotations import to_rpy, w_first
from webviz.data.transforms import FrameReport
from webviz.engine.state import State


def transforms(state: State, _: str) -> Mapping[str, Any]:
    """Every frame by id, "/roots", and "/problems" of the tree as a whole.

    The keys that begin with a slash are no frames: tf2 has none of such names.
    """
    tree = state.transforms
    if tree is None:
        return {}
    frames = {report.frame: _frame(report) for report in tree.frames}
    # In a loop there is no root; it is shown from somewhere.
    roots = [*tree.roots, *(loop[0] for loop in tree.loops)]
    told = {problem for report in tree.frames for problem in report.problems}
    problems = [problem for problem in tree.problems if problem not in told]
    return {**frames, "/roots": roots, "/problems": problems}


def between(state: State, pair: str) -> Mapping[str, Any]:
    """The transform between two frames, given as JSON: [target, source]."""
    found = state.between.get(pair_of(pair) or ("", ""))
    if found is None:
        return {}
    if found.translation is None:
        return {"problem": found.problem}
    translation = np.array(found.translation)
    return {
        "translation": [_rounded(value, 4) for value in found.translation],
        "rotation": [_rounded(value, 4) for value in found.rotation],
        "rpy": [_rounded(value, 2) for value in np.degrees(to_rpy(tuple(w_first(found.rotation))))],
        "distance": _rounded(np.linalg.norm(translation), 4),
        "age": None if found.age_s is None else _age(found.age_s),
    }


def pair_of(argument: str) -> tuple[str, str] | None:
    """Target and source frame of a store's argument, None unless there are two."""
    try:
        pair = json.loads(argument)
    except (ValueError, RecursionError):
        return None
    if not isinstance(pair, list) or len(pair) != 2 or not all(isinstance(f, str) for f in pair):
        return None
    return pair[0], pair[1]


def _frame(report: FrameReport) -> Mapping[str, Any]:
    return {
        "parent": report.parent,
        "is_static": report.is_static,
        "nodes": report.publishers,
        "hz": float(f"{report.rate_hz:.3g}"),
        "age": None if report.age_ns is None else _age(report.age_ns / 1e9),
        "samples": report.samples,
        "problems": [*report.problems, *_gaps(report)],
    }


def _gaps(report: FrameReport) -> list[str]:
    if not report.gap_ns:
        return []
    gap = f"{report.gap_ns / 1e9:.1f} s"
    return [f"A recent gap of {gap}. Check the publisher and the network."]


def _age(seconds: float) -> float:
    """To hundredths up to a second, and then to two digits."""
    return round(seconds, 2) if abs(seconds) < 1 else float(f"{seconds:.2g}")


def _rounded(value: Any, digits: int) -> float:
    return round(float(value), digits) + 0.0
