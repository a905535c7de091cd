"""Solutions of MoveIt Task Constructor: one path, the scene of each of its parts, and markers."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Sequence
from concurrent.futures import CancelledError, Future
from typing import Any

import msgspec

from webviz import Context, Details, Error, Hit
from webviz.api.connection import GraphConnection
from webviz.data.messages import decode
from webviz.data.messages.markers import MarkerSequence
from webviz_displays.markers.assets import Assets
from webviz_displays.markers.blocks import Blocks
from webviz_displays.markers.details import marker_details, serial_of
from webviz_displays.markers.report import report_waiting
from webviz_displays.markers.store import Store
from webviz_displays.moveit.scene import KnownScene, updated

SERVICE = "moveit_task_constructor_msgs/srv/GetSolution"
ANSWER_S = 5.0
"""Time in seconds for the program that plans to answer."""
MAX_PARTS = 1000
"""Trajectories of a solution; further ones are left out."""


class SolutionPath(msgspec.Struct, frozen=True, eq=False):
    """The trajectories of a solution, with the fields of a moveit_msgs/DisplayTrajectory."""

    model_id: str
    trajectory_start: Any
    trajectory: Sequence[Any]


class KnownSolution(msgspec.Struct, frozen=True, eq=False):
    """A solution that can be played.

    Args:
        message: moveit_task_constructor_msgs/Solution.
        path: its trajectories.
        starts: number of the first point of each.
        scenes: before each of them, and after the last.
    """

    message: Any
    path: SolutionPath
    starts: Sequence[int]
    scenes: Sequence[KnownScene]

    def part_at(self, point: int) -> int:
        """Return the trajectory that a point belongs to, the last one of those that begin there."""
        return max(bisect_right(self.starts, point) - 1, 0)

    @property
    def info(self) -> Any:
        """The moveit_task_constructor_msgs/SolutionInfo of the whole; None without one."""
        several, single = self.message.sub_solution, self.message.sub_trajectory
        first = next(iter(several), None) or next(iter(single), None)
        return first and first.info

    def markers(self, part: int | None) -> list[MarkerSequence]:
        """Return the markers of the whole solution, and of one of its trajectories.

        None for all.
        """
        parts = self.message.sub_trajectory[:MAX_PARTS]
        chosen = parts if part is None else parts[part : part + 1]
        return [each.info.markers for each in (*self.message.sub_solution, *chosen)]


def known_solution(message: Any) -> KnownSolution:
    """Return a solution with the scenes that its parts lead to."""
    scene = updated(KnownScene(), message.start_scene)
    parts = message.sub_trajectory[:MAX_PARTS]
    starts, scenes, count = [], [scene], 0
    for part in parts:
        starts.append(count)
        single = part.trajectory.joint_trajectory.points
        several = part.trajectory.multi_dof_joint_trajectory.points
        count += max(len(single), len(several))
        scenes.append(updated(scenes[-1], part.scene_diff))
    start = message.start_scene
    path = SolutionPath(
        start.robot_model_name, start.robot_state, [part.trajectory for part in parts]
    )
    return KnownSolution(message, path, starts, scenes)


class SolutionRequest(msgspec.Struct):
    """Asks the program that plans for a solution.

    Args:
        request: service and id, None for none.
        solution: the answer, None before.
        problem: why there is none, a sentence.
    """

    request: tuple[str, int] | None = None
    solution: Any = None
    problem: str = ""
    _answer: Future[bytes] | None = None
    _reading: Future[Any] | None = None

    def step(self, request: tuple[str, int] | None, connection: GraphConnection) -> None:
        """Ask once, and take the answer."""
        if request != self.request:
            self.request, self.solution, self.problem = request, None, ""
            self._answer = self._reading = None
            if request is not None:
                self._ask(*request, connection)
        try:
            if self._answer is not None and self._answer.done():
                answer, self._answer = self._answer, None
                self._reading = connection.run(_solution_of, answer.result())
            if self._reading is not None and self._reading.done():
                reading, self._reading = self._reading, None
                self.solution = reading.result()
                if not self.solution.task_id:
                    self.solution, self.problem = (
                        None,
                        "The task no longer has it. Choose another.",
                    )
                connection.wake()
        except (Error, CancelledError) as error:
            self.problem = str(error)
            connection.wake()

    def _ask(self, service: str, solution: int, connection: GraphConnection) -> None:
        try:
            self._answer = connection.query(service, SERVICE, ANSWER_S, {"solution_id": solution})
        except ValueError as error:
            self.problem = str(error)


def _solution_of(answer: bytes) -> Any:
    return decode(f"{SERVICE}_Response", answer).solution


class ShownMarkers(msgspec.Struct):
    """Markers of a solution.

    Args:
        key: changes with the markers that are shown.
    """

    key: object = None
    _store: Store = msgspec.field(default_factory=Store)
    _blocks: Blocks = msgspec.field(default_factory=Blocks)
    _assets: Assets = msgspec.field(default_factory=Assets)

    def version(self, ctx: Context) -> object:
        """Return what changes when something else is to be drawn."""
        self._store.place(ctx.frames)
        return self._store.version, self._assets.version()

    def draw(self, key: object, markers: Sequence[MarkerSequence], ctx: Context) -> None:
        """Draw these markers; a key that is the same stands for the same ones."""
        arrived = self._assets.load(ctx, self._blocks.requests())
        if key != self.key:
            self.key, self._store = key, Store()
            self._blocks.clear()
            for each in markers:
                self._store.apply(each, ctx.frames.now_ns)
        self._store.place(ctx.frames)
        changed, self._store.changed = self._store.changed, set()
        self._blocks.renew(self._store.table, changed, arrived, frozenset(), self._assets)
        self._assets.start(ctx)
        self._blocks.draw(ctx)
        report_waiting(self._store, ctx)

    def inspect(self, hit: Hit, ctx: Context) -> Details | None:
        """Return a marker."""
        serial = serial_of(hit)
        return None if serial is None else marker_details(self._store, serial, ctx.frames.now_ns)
