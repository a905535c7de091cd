"""The transforms that arrive, and what is wrong with them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from webviz.api.errors import Error
from webviz.api.robots import NamespacedRobot
from webviz.api.status import Status
from webviz.data.transforms import Diagnosis, TransformException, diagnose, explain
from webviz.engine.commands import Command, InspectTransforms, LookUpTransform, Sender
from webviz.engine.parts.part import Batches, Core, Handler, Part
from webviz.engine.pipeline.listener import TransformListener
from webviz.engine.state import Between
from webviz.engine.state.statuses import fixed_frame_status
from webviz.sources import Subscription

EVERY_S = 1.0
"""Interval between readings of the tree."""
MAX_BETWEEN = 64
"""Transforms that are read out at once."""


class TransformsPart(Part):
    """Fills the buffer of transforms, and reports on their tree."""

    name = "Transforms"

    def __init__(self, core: Core, robots: Callable[[], Sequence[NamespacedRobot]]) -> None:
        super().__init__(core)
        self._robots = robots
        self._followed: Sequence[NamespacedRobot] = ()
        self._listener = TransformListener(core.buffer, core.clock)
        self._wanted = InspectTransforms(tree=False)
        self._tree: tuple[float, int, Diagnosis] | None = None

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each of its commands."""
        return {InspectTransforms: self._inspect, LookUpTransform: self._look_up}

    def subscriptions(self) -> Mapping[str, Subscription]:
        """Return the topics of tf2."""
        if (robots := self._robots()) != self._followed:
            self._followed = robots
            self._listener.follow(robots)
        return self._listener.subscriptions()

    def insert(self, batches: Batches) -> bool:
        """Insert what arrived, before displays ask for it.

        Returns:
            Whether the transforms started over in the past.
        """
        return self._listener.take(batches, self.core.offers)

    def reset(self) -> None:
        """Forget the moving transforms."""
        self._listener.reset()
        self.core.frames.forget_passed()
        self._tree = None

    def state(self) -> Mapping[str, Any]:
        """Return the frames, and the requested reports on them."""
        buffer = self.core.buffer
        is_watched = self.core.is_watched()
        between = sorted(self._wanted.between)[:MAX_BETWEEN] if is_watched else ()
        return {
            "frames": tuple(sorted(buffer.frames())),
            "transforms": self._diagnosis() if is_watched and self._wanted.tree else None,
            "between": {pair: self._between(*pair) for pair in between},
        }

    def statuses(self) -> Mapping[str, Status]:
        """Return whether anything can be drawn in the fixed frame, and the transforms' problem."""
        core = self.core
        fixed = fixed_frame_status(core.frames.fixed_frame, core.buffer)
        found = self._listener.statuses(core.offers, core.frames.now_ns)
        return {"Fixed Frame": fixed, **found}

    def _inspect(self, command: InspectTransforms, sender: Sender) -> None:
        self._wanted = command
        self._tree = None

    def _look_up(self, command: LookUpTransform, sender: Sender) -> str:
        found = self._between(command.target, command.source)
        if found.translation is None:
            raise Error(found.problem)
        x, y, z = found.translation
        turn = ", ".join(f"{each:.5f}" for each in found.rotation)
        age = "static" if found.age_s is None else f"{found.age_s:.2f} s old"
        return (
            f"{command.source} is at ({x:.4f}, {y:.4f}, {z:.4f}) m in {command.target}, rotation "
            f"(x, y, z, w) = ({turn}), {age}."
        )

    def _diagnosis(self) -> Diagnosis:
        """Return the tree as it was less than a second ago; at once if frames came or moved."""
        now, structure = self.core.clock(), self.core.buffer.structure_version
        tree = self._tree
        if tree is None or tree[1] != structure or not 0.0 <= now - tree[0] < EVERY_S:
            tree = now, structure, diagnose(self.core.buffer, self.core.frames.now_ns)
            self._tree = tree
        return tree[2]

    def _between(self, target: str, source: str) -> Between:
        buffer, now_ns = self.core.buffer, self.core.frames.now_ns
        try:
            found = buffer.lookup(target, source, 0)
        except TransformException:
            return Between(problem=explain(buffer, target, source, 0, now_ns).sentence)
        age_s = (now_ns - found.stamp_ns) / 1e9 if found.stamp_ns and now_ns else None
        return Between(found.translation, found.rotation, age_s)
