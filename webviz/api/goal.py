"""Goals of tools for actions, and the text of their progress."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from webviz.data.messages import encode, interfaces


def nothing(result: Any) -> str:
    """Find no fault with a result."""
    return ""


@dataclass(frozen=True)
class GoalRequest:
    """A goal for an action server; see `webviz.api.tool.ToolContext.send_goal`.

    Args:
        action: its name, before remapping.
        type: such as "nav2_msgs/action/NavigateToPose".
        goal: serialised `<type>_Goal`.
        feedback_type, result_type: of the messages with feedback and result.
        label: what the goal is, in a few words.
        poses: x, y, z in metres and yaw in radians in the fixed frame, for pages to show.
        remedy: what to do if no node offers the action; a sentence.
        success: what to report of a goal that succeeded without a fault; a sentence.
        read: what to show of feedback, texts by label.
        fault: what went wrong according to a result, "" for nothing; a sentence.
    """

    action: str
    type: str
    goal: bytes
    feedback_type: str
    result_type: str
    label: str
    poses: Sequence[tuple[float, float, float, float]]
    remedy: str
    success: str
    read: Callable[[Any], Mapping[str, str]] | None
    fault: Callable[[Any], str]


def goal_request(
    action: str,
    type: str,
    goal: Mapping[str, Any],
    *,
    definition: str = "",
    label: str = "",
    poses: Sequence[tuple[float, float, float, float]] = (),
    remedy: str = "Start its node, or choose another name.",
    success: str = "Succeeded.",
    feedback: Callable[[Any], Mapping[str, str]] | None = None,
    fault: Callable[[Any], str] = nothing,
) -> GoalRequest:
    """Return a goal from values by field.

    See `GoalRequest` and `webviz.api.tool.ToolContext.send_goal`.

    Raises:
        EncodeError: a value does not fit the goal.
        UnknownTypeError: the message type has no known definition.
    """
    parts = interfaces.action(type, definition)
    return GoalRequest(
        action=action,
        type=type,
        goal=encode(parts.goal, goal),
        feedback_type=parts.feedback,
        result_type=f"{parts.get_result}_Response",
        label=label,
        poses=poses,
        remedy=remedy,
        success=success,
        read=feedback,
        fault=fault,
    )
