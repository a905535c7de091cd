"""The tree of transforms, and the transform between two frames, while a page shows them."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence, Set
from typing import Any, ClassVar

import msgspec
import numpy as np

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.data.rotations import to_rpy, w_first
from webviz.data.transforms import Diagnosis, FrameReport, TransformException, diagnose, explain
from webviz.data.transforms.layout import lay_out
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.part import PartContext
from webviz.engine.store import PageStore

EVERY_S = 1.0
"""Interval between readings of the tree."""
MAX_BETWEEN = 64
"""Transforms that are read out at once."""


class Between(msgspec.Struct, frozen=True):
    """The transform between two frames, at the newest time that all links between them have.

    Args:
        translation: of the source in the target, in metres; None if there is no transform.
        rotation: (x, y, z, w).
        age_s: how old that time is; None if all links are static, or ROS time is not known.
        problem: why there is no transform, and what to do; a sentence.
    """

    translation: tuple[float, float, float] | None = None
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    age_s: float | None = None
    problem: str = ""


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


class TransformsFeature(Feature):
    """Reports on the transforms."""

    name = "TF"
    module = "transforms.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._has_tree = False
        self._pairs: frozenset[tuple[str, str]] = frozenset()
        self._tree: tuple[float, int, Diagnosis] | None = None

    def watched(self, stores: Set[str]) -> None:
        """Report on what pages show."""
        pairs = (pair_of(each.partition(":")[2]) for each in stores if each.startswith("between:"))
        has_tree = not stores.isdisjoint({"transforms", "frame_tree"})
        self.inspect_transforms(has_tree, frozenset(pair for pair in pairs if pair))

    def reset(self) -> None:
        """Forget the tree: time starts over."""
        self._tree = None

    def state(self) -> Mapping[str, Any]:
        """Return the requested reports."""
        between = {pair: self._between(*pair) for pair in self._requested()}
        return {"transforms": self.tree(), "between": between}

    def tree(self) -> Diagnosis | None:
        """Return the tree, None while no page shows it."""
        return self._diagnosis() if self.context.is_watched() and self._has_tree else None

    def transform_between(self, pair: tuple[str, str]) -> Between | None:
        """Return the transform between two frames, None if it is not requested."""
        return self._between(*pair) if pair in self._requested() else None

    @store()
    def transforms(self, argument: str) -> TransformsStore | None:
        """Return the tree of transforms, None while it is not inspected."""
        tree = self.tree()
        if tree is None:
            return None
        frames = {report.frame: _frame(report) for report in tree.frames}
        # In a loop there is no root; it is shown from somewhere.
        roots = [*tree.roots, *(loop[0] for loop in tree.loops)]
        reported = {problem for report in tree.frames for problem in report.problems}
        problems = [problem for problem in tree.problems if problem not in reported]
        return TransformsStore(frames, roots, problems)

    @store()
    def frame_tree(self, argument: str) -> FrameTreeStore | None:
        """Return the layout of the tree of transforms, None while it is not inspected."""
        tree = self.tree()
        if tree is None:
            return None
        layout = lay_out(tree)
        places = [(frame, place.column, place.row) for frame, place in layout.places.items()]
        edges = [(edge.parent, edge.child, edge.is_extra) for edge in layout.edges]
        return FrameTreeStore(places, edges, layout.rows)

    @store()
    def between(self, pair: str) -> BetweenStore | None:
        """Return the transform between two frames, given as JSON: [target, source]."""
        between = self.transform_between(pair_of(pair) or ("", ""))
        return between and between_store(between)

    @command(None)
    def inspect_transforms(
        self, tree: bool = True, between: frozenset[tuple[str, str]] = frozenset()
    ) -> None:
        """Report on the transforms while they are shown.

        Args:
            tree: whether on the tree of all frames.
            between: pairs of frames, target and source, between which transforms are read out.
        """
        self._has_tree, self._pairs, self._tree = tree, between, None

    @command(Role.WATCHER)
    def look_up_transform(self, target: str, source: str) -> str:
        """Answer with the newest transform between two frames, in words."""
        between = self._between(target, source)
        if between.translation is None:
            raise Error(between.problem)
        x, y, z = between.translation
        turn = ", ".join(f"{each:.5f}" for each in between.rotation)
        age = "static" if between.age_s is None else f"{between.age_s:.2f} s old"
        return (
            f"{source} is at ({x:.4f}, {y:.4f}, {z:.4f}) m in {target}, rotation "
            f"(x, y, z, w) = ({turn}), {age}."
        )

    def _requested(self) -> Sequence[tuple[str, str]]:
        return sorted(self._pairs)[:MAX_BETWEEN] if self.context.is_watched() else ()

    def _diagnosis(self) -> Diagnosis:
        """Return the tree as it was less than a second ago; at once if frames came or moved."""
        now, structure = self.context.clock(), self.context.buffer.structure_version
        tree = self._tree
        if tree is None or tree[1] != structure or not 0.0 <= now - tree[0] < EVERY_S:
            tree = now, structure, diagnose(self.context.buffer, self.context.frames.now_ns)
            self._tree = tree
        return tree[2]

    def _between(self, target: str, source: str) -> Between:
        buffer, now_ns = self.context.buffer, self.context.frames.now_ns
        try:
            transform = buffer.lookup(target, source, 0)
        except TransformException:
            return Between(problem=explain(buffer, target, source, 0, now_ns).sentence)
        age_s = (now_ns - transform.stamp_ns) / 1e9 if transform.stamp_ns and now_ns else None
        return Between(transform.translation, transform.rotation, age_s)


def between_store(between: Between) -> BetweenStore:
    """Return what pages show of a transform."""
    if between.translation is None:
        return BetweenStore(problem=between.problem)
    x, y, z = (_rounded(value, 4) for value in between.translation)
    qx, qy, qz, qw = (_rounded(value, 4) for value in between.rotation)
    roll, pitch, yaw = np.degrees(to_rpy(tuple(w_first(between.rotation))))
    return BetweenStore(
        translation=(x, y, z),
        rotation=(qx, qy, qz, qw),
        rpy=(_rounded(roll, 2), _rounded(pitch, 2), _rounded(yaw, 2)),
        distance=_rounded(np.linalg.norm(between.translation), 4),
        age=None if between.age_s is None else _age(between.age_s),
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
    """Return an age rounded to hundredths up to a second, and then to two digits."""
    return round(seconds, 2) if abs(seconds) < 1 else float(f"{seconds:.2g}")


def _rounded(value: Any, digits: int) -> float:
    return round(float(value), digits) + 0.0
