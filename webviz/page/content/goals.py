"""The goals that tools sent to actions."""

from __future__ import annotations

import itertools
from collections.abc import Mapping
from typing import Any

from webviz.engine.state import GoalProgress, State
from webviz.page.content.displays import level_name
from webviz.page.content.forms import brief

MAX_VALUES = 12
MAX_VALUE = 100
"""Characters of a label or text of the feedback."""
MAX_STATUS = 1000
MAX_POSES = 200


def goals(state: State, _: str) -> Mapping[str, Any]:
    """By id; the newest last."""
    return {goal.id: _goal(goal) for goal in state.goals}


def routes(state: State, _: str) -> Mapping[str, Any]:
    """By id the poses of goals that have not ended: x, y, z, yaw in a frame."""
    return {
        goal.id: {"frame": goal.frame, "poses": list(goal.poses[:MAX_POSES])}
        for goal in state.goals
        if goal.poses and goal.phase != "ended"
    }


def _goal(goal: GoalProgress) -> Mapping[str, Any]:
    status = goal.status
    values = itertools.islice(goal.values.items(), MAX_VALUES)
    return {
        "title": brief(goal.title),
        "label": brief(goal.label),
        "phase": goal.phase,
        "can_dismiss": goal.phase == "ended" or goal.can_dismiss,
        "level": level_name(status.level) if status else "",
        "text": brief(status.text, MAX_STATUS) if status else "",
        "values": [[brief(label, MAX_VALUE), brief(text, MAX_VALUE)] for label, text in values],
    }
