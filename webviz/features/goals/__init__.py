"""The goals that tools and panels sent to actions: all browsers see them; operators can cancel."""

from __future__ import annotations

import itertools
from collections.abc import Callable, Mapping, Sequence
from typing import Any, ClassVar, Literal

import msgspec

from webviz.api.errors import Error
from webviz.api.goal import GoalRequest
from webviz.api.roles import Role
from webviz.api.status import Level, Status
from webviz.engine.commands import ignore
from webviz.engine.feature import Feature, command, store
from webviz.engine.forms import brief
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.status_lines import LevelName, level_name
from webviz.engine.store import PageStore
from webviz.features.goals.running import GoalProgress, RunningGoal
from webviz.sources import Goal

MAX_ACTIVE = 20
SHOWN_S = 10.0
"""Duration for which a goal that ended well is shown; others stay until dismissed."""
MAX_VALUES = 12
MAX_VALUE = 100
"""Characters of a label or text of the feedback."""
MAX_STATUS = 1000
MAX_POSES = 200


class ShownGoal(msgspec.Struct, frozen=True):
    """A goal of a tool.

    Args:
        title, label, phase: see `webviz.features.goals.running.GoalProgress`.
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


class GoalsFeature(Feature):
    """All goals, the newest last."""

    name = "Goals"
    module = "goals.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._goals: dict[str, RunningGoal] = {}
        self._count = 0

    def send(
        self,
        tool: str,
        title: str,
        request: GoalRequest,
        report: Callable[[Status], None],
        ended: Callable[[Status], None] = ignore,
    ) -> None:
        """Send a goal of a tool instead of its previous one.

        Args:
            tool: its id.
            title: its name.
            request: of the tool.
            report: called with whether the goal is accepted.
            ended: called with the outcome of one that was.

        Raises:
            Error: too many goals are active, or the name of the action is invalid.
        """
        try:
            action = self.context.player.resolve(request.action)
        except ValueError as error:
            raise Error(f"{error}. Choose another action.") from error
        active = [goal for goal in self._goals.values() if goal.is_active]
        if sum(not goal.is_replaced for goal in active) >= MAX_ACTIVE:
            raise Error(f"{MAX_ACTIVE} goals are active. Cancel one first.")
        before = [goal for goal in active if goal.tool == tool]
        for goal in before:
            if goal.action != action:
                goal.cancel()
        self._count += 1
        frame = self.context.frames.fixed_frame
        progress = GoalProgress(f"goal{self._count}", title, request.label, frame, request.poses)

        def send(hear: Callable[[bytes], object]) -> Goal:
            return self.context.graph.send_goal(action, request.type, request.goal, hear)

        self._goals = {
            id: goal for id, goal in self._goals.items() if goal.is_active or goal.tool != tool
        }
        goal = RunningGoal(tool, action, progress, request, send, before, report, ended)
        self._goals[progress.id] = goal
        self._turn(goal)

    def keep_up(self, commanded: bool) -> None:
        """Follow the goals, and forget those that are no longer shown."""
        for goal in self._goals.values():
            self._turn(goal)
        self._goals = {id: goal for id, goal in self._goals.items() if self._is_worth_keeping(goal)}

    def is_attended(self) -> bool:
        """Return whether a goal is active."""
        return any(goal.is_active for goal in self._goals.values())

    def state(self) -> Mapping[str, Any]:
        """Return the goals."""
        return {"goals": self.progress()}

    @store()
    def goals(self, argument: str) -> GoalsStore:
        """Return the goals by id."""
        return GoalsStore({goal.id: _row(goal) for goal in self.progress()})

    @store()
    def routes(self, argument: str) -> RoutesStore:
        """Return the poses of goals that have not ended."""
        return RoutesStore(
            {
                goal.id: Route(goal.frame, list(goal.poses[:MAX_POSES]))
                for goal in self.progress()
                if goal.poses and goal.phase != "ended"
            }
        )

    def progress(self) -> tuple[GoalProgress, ...]:
        """Return the goals that are to be shown, oldest first."""
        goals, now = self._goals.values(), self.context.clock()
        # Those that may have ended because of a new one, which is not accepted yet.
        old = {old for goal in goals for old in goal.before if goal.is_active and not old.is_active}
        visible = [goal for goal in goals if not goal.is_replaced and goal not in old]
        return tuple(goal.progress(now) for goal in visible)

    def _turn(self, goal: RunningGoal) -> None:
        self.context.boundary(goal.initial.title, goal.turn, self.context.clock())

    def _is_worth_keeping(self, goal: RunningGoal) -> bool:
        if goal.outcome is None:
            return True
        if goal.is_replaced or not goal.is_accepted:  # of which its sender knows why
            return False
        age = self.context.clock() - goal.ended_s
        return goal.outcome.level is not Level.OK or age < SHOWN_S

    def _find(self, id: str) -> RunningGoal:
        if id not in self._goals:
            raise Error("This goal has ended.")
        return self._goals[id]

    @command(None)
    def send_goal(
        self, request: GoalRequest, by: str, title: str, report: Callable[[Status], None] = ignore
    ) -> None:
        """Send a goal to an action instead of the previous one of the same sender.

        Args:
            request: the goal; see `webviz.api.goal.goal_request`.
            by: id of the sender, such as a panel's name.
            title: what pages call it.
            report: called with whether the goal is accepted, and then with its outcome; must not
                block.
        """
        self.send(by, title, request, report, ended=report)

    @command(Role.OPERATOR)
    def cancel_goal(self, goal: str) -> None:
        """Ask the server of a goal to end it; see `webviz.features.goals.running.GoalProgress`."""
        self._find(goal).cancel()

    @command(Role.OPERATOR)
    def dismiss_goal(self, goal: str) -> None:
        """Stop showing a goal that has ended."""
        running, now = self._find(goal), self.context.clock()
        if running.is_stuck(now):
            running.give_up(now)
        if running.is_active:
            raise Error("This goal is active. Cancel it first.")
        del self._goals[goal]


def _row(goal: GoalProgress) -> ShownGoal:
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
