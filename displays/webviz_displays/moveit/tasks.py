"""Tasks of MoveIt Task Constructor: their stages, and how many solutions each has."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

import msgspec
from msgspec.structs import replace

MAX_TASKS = 20
"""Largest number of tasks of programs that plan; the oldest are forgotten."""
MAX_STAGES = 1000
"""Largest number of stages of a task; further ones are left out."""
MAX_DEPTH = 20
"""Largest depth of stages in stages; deeper ones are listed at this depth."""
LONGEST_NAME = 80


class TaskStage(NamedTuple):
    """A stage of a task.

    Attributes:
        number: of the stage among its siblings and theirs, such as "1.2".
        name: from the program.
        solved: ids of solutions, cheapest first.
        failed: how many attempts failed.
        time_s: computation time.
    """

    number: str
    name: str
    solved: tuple[int, ...] = ()
    failed: int = 0
    time_s: float = 0.0


class KnownTasks(msgspec.Struct, frozen=True, eq=False):
    """Messages received about tasks.

    Args:
        description: the URDF, None before it came.
        plans: moveit_task_constructor_msgs/TaskDescription by task, the newest last.
        statistics: TaskStatistics by task.
        solution: the newest Solution.
    """

    description: str | None = None
    plans: Mapping[str, Any] = msgspec.field(default_factory=dict)
    statistics: Mapping[str, Any] = msgspec.field(default_factory=dict)
    solution: Any = None

    def with_message(self, name: str, message: Any) -> KnownTasks:
        """Return these after a message for one of the inputs of the display."""
        if name == "robot_description":
            return replace(self, description=message.data)
        if name == "task_solution_topic":
            return replace(self, solution=message)
        if name == "statistics_topic":
            return replace(self, statistics=_newest(self.statistics, message))
        if message.stages:
            return replace(self, plans=_newest(self.plans, message))
        # A description without stages says that the task begins again or is gone.
        key = message.task_id
        plans = {id: each for id, each in self.plans.items() if id != key}
        statistics = {id: each for id, each in self.statistics.items() if id != key}
        is_gone = self.solution is not None and self.solution.task_id == key
        return KnownTasks(self.description, plans, statistics, None if is_gone else self.solution)

    def stages(self, task: str) -> list[TaskStage]:
        """Return the stages of a task, each before those within it."""
        plan, statistics = self.plans.get(task), self.statistics.get(task)
        if plan is None:
            return []
        counts = {each.id: each for each in statistics.stages} if statistics is not None else {}
        return list(_ordered(plan.stages[:MAX_STAGES], counts))

    def task_of(self, solution: int) -> str:
        """Return the newest task with a solution of this id, else the newest of all.

        "" without one.
        """
        for task in reversed(list(self.plans)):
            statistics = self.statistics.get(task)
            for stage in statistics.stages if statistics is not None else ():
                if solution in stage.solved or solution in stage.failed:
                    return task
        return next(reversed(list(self.plans)), "")


def _newest(statistics: Mapping[str, Any], message: Any) -> dict[str, Any]:
    newest = {key: each for key, each in statistics.items() if key != message.task_id}
    newest[message.task_id] = message
    return dict(list(newest.items())[-MAX_TASKS:])


def _ordered(stages: Any, counts: Mapping[int, Any]) -> Iterator[TaskStage]:
    """Stages with their numbers; those whose parent is missing are on top."""
    ids = {stage.id for stage in stages}
    inner: dict[int | None, list[Any]] = {}
    for stage in stages:
        is_top = stage.parent_id == stage.id or stage.parent_id not in ids
        inner.setdefault(None if is_top else stage.parent_id, []).append(stage)
    waiting = _numbered("", inner.pop(None, []))
    while waiting:
        number, stage = waiting.pop(0)
        yield _stage(number, stage, counts.get(stage.id))
        waiting[:0] = _numbered(number, inner.pop(stage.id, []))


def _numbered(above: str, stages: list[Any]) -> list[tuple[str, Any]]:
    parent = ".".join(above.split(".")[: MAX_DEPTH - 1])
    return [
        (f"{parent}.{index}" if parent else str(index), stage)
        for index, stage in enumerate(stages, start=1)
    ]


def _stage(number: str, stage: Any, former: Any) -> TaskStage:
    name = stage.name[:LONGEST_NAME]
    if former is None:
        return TaskStage(number, name)
    failed = max(len(former.failed), former.num_failed)
    solved = tuple(map(int, former.solved))
    return TaskStage(number, name, solved, failed, former.total_compute_time)
