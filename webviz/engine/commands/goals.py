"""Commands for the goals that tools sent to actions."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class CancelGoal(Command):
    """Ask the server of a goal to end it; see `webviz.engine.state.GoalProgress`."""

    goal: str


@dataclass(frozen=True)
class DismissGoal(Command):
    """Stop showing a goal that has ended."""

    goal: str
