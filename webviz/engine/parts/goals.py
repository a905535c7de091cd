"""The goals that tools and panels sent to actions: all browsers see them; operators can cancel."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from webviz.api.errors import Error
from webviz.api.goal import GoalRequest
from webviz.api.status import Level, Status
from webviz.engine.commands import CancelGoal, Command, DismissGoal, Sender, SendGoal
from webviz.engine.commands.command import ignore
from webviz.engine.parts.part import Core, Handler, Part
from webviz.engine.state import GoalProgress
from webviz.engine.state.goals import RunningGoal
from webviz.sources import Goal

MAX_ACTIVE = 20
SHOWN_S = 10.0
"""Duration for which a goal that ended well is shown; others stay until dismissed."""


class GoalsPart(Part):
    """All goals, the newest last."""

    name = "Goals"

    def __init__(self, core: Core) -> None:
        super().__init__(core)
        self._goals: dict[str, RunningGoal] = {}
        self._made = 0

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {CancelGoal: self._cancel, DismissGoal: self._dismiss, SendGoal: self._send}

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
            action = self.core.player.resolve(request.action)
        except ValueError as error:
            raise Error(f"{error}. Choose another action.") from error
        active = [goal for goal in self._goals.values() if goal.is_active]
        if sum(not goal.is_replaced for goal in active) >= MAX_ACTIVE:
            raise Error(f"{MAX_ACTIVE} goals are active. Cancel one first.")
        before = [goal for goal in active if goal.tool == tool]
        for goal in before:
            if goal.action != action:
                goal.cancel()
        self._made += 1
        frame = self.core.frames.fixed_frame
        shown = GoalProgress(f"goal{self._made}", title, request.label, frame, request.poses)

        def send(hear: Callable[[bytes], object]) -> Goal:
            return self.core.gate.send_goal(action, request.type, request.goal, hear)

        self._goals = {
            id: goal for id, goal in self._goals.items() if goal.is_active or goal.tool != tool
        }
        goal = RunningGoal(tool, action, shown, request, send, before, report, ended)
        self._goals[shown.id] = goal
        self._turn(goal)

    def keep_up(self, commanded: bool) -> None:
        """Follow the goals, and forget those that nobody needs to see any more."""
        for goal in self._goals.values():
            self._turn(goal)
        self._goals = {id: goal for id, goal in self._goals.items() if self._is_worth_keeping(goal)}

    def state(self) -> Mapping[str, Any]:
        """Return the goals as pages show them."""
        goals, now = self._goals.values(), self.core.clock()
        # Those that may have ended because of a new one, which is not accepted yet.
        old = {old for goal in goals for old in goal.before if goal.is_active and not old.is_active}
        shown = [goal for goal in goals if not goal.is_replaced and goal not in old]
        return {"goals": tuple(goal.progress(now) for goal in shown)}

    def _turn(self, goal: RunningGoal) -> None:
        self.core.guard(goal.shown.title, goal.turn, self.core.clock())

    def _is_worth_keeping(self, goal: RunningGoal) -> bool:
        if goal.outcome is None:
            return True
        if goal.is_replaced or not goal.is_accepted:  # of which its sender knows why
            return False
        age = self.core.clock() - goal.ended_s
        return goal.outcome.level is not Level.OK or age < SHOWN_S

    def _find(self, id: str) -> RunningGoal:
        if id not in self._goals:
            raise Error("This goal has ended.")
        return self._goals[id]

    def _send(self, command: SendGoal, sender: Sender) -> None:
        report = command.report
        self.send(command.by, command.title, command.request, report, ended=report)

    def _cancel(self, command: CancelGoal, sender: Sender) -> None:
        self._find(command.goal).cancel()

    def _dismiss(self, command: DismissGoal, sender: Sender) -> None:
        goal, now = self._find(command.goal), self.core.clock()
        if goal.is_stuck(now):
            goal.give_up(now)
        if goal.is_active:
            raise Error("This goal is active. Cancel it first.")
        del self._goals[command.goal]
