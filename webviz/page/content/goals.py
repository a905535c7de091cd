"""The goals that tools sent to actions."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from typing import ClassVar, Literal

import msgspec

from webviz.engine.state import GoalProgress, State
from webviz.engine.store import PageStore
from webviz.page.content.displays import LevelName, level_name
from webviz.page.content.forms import brief

MAX_VALUES = 12
MAX_VALUE = 100
"""Characters of a label or text of the feedback."""
MAX_STATUS = 1000
MAX_POSES = 200


class ShownGoal(msgspec.Struct, frozen=True):
    """A goal of a tool.

    Args:
        title, label, phase: see `webviz.engine.state.GoalProgress`.
        can_dismiss: whether pages may put it away.
        level, text: of its status, "" for none.
        values: labels and texts of its feedback.
    """

    title: str
    label: str
    phase: Literal["sending", "active", "canceling", "ended"]
    can_dismiss: bool
    level: LevelName | Literal[""]
    text: str
    values: Sequence[tuple[str, str]]


class GoalsStore(PageStore, frozen=True):
    """The goals by id, the newest last."""

    spread: ClassVar = {"goals": ""}

    goals: Mapping[str, ShownGoal]


class Route(msgspec.Struct, frozen=True):
    """The poses of a goal.

    Args:
        frame: that they are in.
        poses: x, y, z in metres and yaw in radians.
    """

    frame: str
    poses: Sequence[tuple[float, float, float, float]]


class RoutesStore(PageStore, frozen=True):
    """The poses of goals that have not ended, by id."""

    spread: ClassVar = {"routes": ""}

    routes: Mapping[str, Route]


def goals(state: State, _: str) -> GoalsStore:
    """Return the goals by id."""
    return GoalsStore({goal.id: _goal(goal) for goal in state.goals})


def routes(state: State, _: str) -> RoutesStore:
    """Return the poses of goals that have not ended."""
    return RoutesStore(
        {
            goal.id: Route(goal.frame, list(goal.poses[:MAX_POSES]))
            for goal in state.goals
            if goal.poses and goal.phase != "ended"
        }
    )


def _goal(goal: GoalProgress) -> ShownGoal:
    status = goal.status
    values = itertools.islice(goal.values.items(), MAX_VALUES)
    return ShownGoal(
        title=brief(goal.title),
        label=brief(goal.label),
        phase=goal.phase,
        can_dismiss=goal.phase == "ended" or goal.can_dismiss,
        level=level_name(status.level) if status else "",
        text=brief(status.text, MAX_STATUS) if status else "",
        values=[(brief(label, MAX_VALUE), brief(text, MAX_VALUE)) for label, text in values],
    )
