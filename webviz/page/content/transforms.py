"""The tree of transforms, and the transform between two frames."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar

import msgspec
import numpy as np

from webviz.data.rotations import to_rpy, w_first
from webviz.data.transforms import FrameReport
from webviz.data.transforms.layout import lay_out
from webviz.engine.state import State
from webviz.engine.store import PageStore


class Frame(msgspec.Struct, frozen=True):
    """A frame, see `webviz.data.transforms.FrameReport`.

    Args:
        nodes: its publishers.
        hz: of its samples, to three digits.
        age: of the newest sample in seconds; None for a static frame.
    """

    parent: str
    is_static: bool
    nodes: Sequence[str]
    hz: float
    age: float | None
    samples: int
    problems: Sequence[str]


class TransformsStore(PageStore, frozen=True):
    """The tree of transforms: every frame by id, its roots, and problems of the tree as a whole.

    The keys that begin with a slash are no frames: tf2 has none of such names.
    """

    spread: ClassVar = {"frames": ""}

    frames: Mapping[str, Frame]
    roots: Sequence[str] = msgspec.field(name="/roots")
    problems: Sequence[str] = msgspec.field(name="/problems")


class FrameTreeStore(PageStore, frozen=True):
    """The layout of the tree of transforms as a picture, see `webviz.data.transforms.layout`.

    Args:
        places: name, column and row of each frame.
        edges: parent, child, and whether the child has its place elsewhere.
        rows: how many the picture has.
    """

    places: Sequence[tuple[str, int, float]]
    edges: Sequence[tuple[str, str, bool]]
    rows: int


class BetweenStore(PageStore, frozen=True):
    """The transform of a source frame in a target frame; without one, the problem alone.

    Args:
        problem: why there is none, a sentence.
        translation: in metres.
        rotation: x, y, z, w.
        rpy: in degrees.
        distance: in metres.
        age: in seconds; None if all links are static.
    """

    problem: str | msgspec.UnsetType = msgspec.UNSET
    translation: tuple[float, float, float] | msgspec.UnsetType = msgspec.UNSET
    rotation: tuple[float, float, float, float] | msgspec.UnsetType = msgspec.UNSET
    rpy: tuple[float, float, float] | msgspec.UnsetType = msgspec.UNSET
    distance: float | msgspec.UnsetType = msgspec.UNSET
    age: float | msgspec.UnsetType | None = msgspec.UNSET


def transforms(state: State, _: str) -> TransformsStore | None:
    """Return the tree of transforms, None while it is not inspected."""
    tree = state.transforms
    if tree is None:
        return None
    frames = {report.frame: _frame(report) for report in tree.frames}
    # In a loop there is no root; it is shown from somewhere.
    roots = [*tree.roots, *(loop[0] for loop in tree.loops)]
    told = {problem for report in tree.frames for problem in report.problems}
    problems = [problem for problem in tree.problems if problem not in told]
    return TransformsStore(frames, roots, problems)


def frame_tree(state: State, _: str) -> FrameTreeStore | None:
    """Return the layout of the tree of transforms, None while it is not inspected."""
    if state.transforms is None:
        return None
    layout = lay_out(state.transforms)
    places = [(frame, place.column, place.row) for frame, place in layout.places.items()]
    edges = [(edge.parent, edge.child, edge.is_extra) for edge in layout.edges]
    return FrameTreeStore(places, edges, layout.rows)


def between(state: State, pair: str) -> BetweenStore | None:
    """Return the transform between two frames, given as JSON: [target, source]."""
    found = state.between.get(pair_of(pair) or ("", ""))
    if found is None:
        return None
    if found.translation is None:
        return BetweenStore(problem=found.problem)
    x, y, z = (_rounded(value, 4) for value in found.translation)
    qx, qy, qz, qw = (_rounded(value, 4) for value in found.rotation)
    roll, pitch, yaw = np.degrees(to_rpy(tuple(w_first(found.rotation))))
    return BetweenStore(
        translation=(x, y, z),
        rotation=(qx, qy, qz, qw),
        rpy=(_rounded(roll, 2), _rounded(pitch, 2), _rounded(yaw, 2)),
        distance=_rounded(np.linalg.norm(found.translation), 4),
        age=None if found.age_s is None else _age(found.age_s),
    )


def pair_of(argument: str) -> tuple[str, str] | None:
    """Target and source frame of a store's argument, None unless there are two."""
    try:
        pair = json.loads(argument)
    except (ValueError, RecursionError):
        return None
    if not isinstance(pair, list) or len(pair) != 2 or not all(isinstance(f, str) for f in pair):
        return None
    return pair[0], pair[1]


def _frame(report: FrameReport) -> Frame:
    return Frame(
        parent=report.parent,
        is_static=report.is_static,
        nodes=report.publishers,
        hz=float(f"{report.rate_hz:.3g}"),
        age=None if report.age_ns is None else _age(report.age_ns / 1e9),
        samples=report.samples,
        problems=[*report.problems, *_gaps(report)],
    )


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
