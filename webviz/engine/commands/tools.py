"""Commands for tools, and for all that is sent to other nodes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from webviz.api.goal import GoalRequest
from webviz.api.status import Status
from webviz.api.tool import Position
from webviz.engine.commands.command import Command, ignore


def unheard(topic: str, type: str, values: Mapping[str, Any]) -> None:
    """Ignore a message that was published."""


class UseTool(Command, frozen=True):
    """Let a tool act on a finished gesture; see `webviz.api.tool.Gesture`.

    Args:
        tool: id of the tool, or its name.
        points, yaw, keys, yaws, several: of the gesture.
        report: called with the result from any thread; must not block.
        published: called with the topic, type and values of each message.
    """

    tool: str
    points: tuple[Position, ...]
    yaw: float = 0.0
    keys: frozenset[str] = frozenset()
    yaws: tuple[float, ...] = ()
    several: str = ""
    report: Callable[[Status], None] = ignore
    published: Callable[[str, str, Mapping[str, Any]], None] = unheard


class SetToolProperty(Command, frozen=True):
    """Change a property of a tool; nested ones have a dotted path, such as `topic.name`."""

    tool: str
    path: str
    value: Any


class CancelGoal(Command, frozen=True):
    """Ask the server of a goal to end it; see `webviz.engine.state.GoalProgress`."""

    goal: str


class DismissGoal(Command, frozen=True):
    """Stop showing a goal that has ended."""

    goal: str


class Publish(Command, frozen=True):
    """Publish a message.

    Args:
        topic: its name; remapped.
        type: such as "std_msgs/msg/String".
        values: of the message by field; missing fields have their defaults.
        report: called with the result from any thread; must not block.
        latched: whether subscriptions that come later get the message, too (transient local).
    """

    topic: str
    type: str
    values: Mapping[str, Any]
    report: Callable[[Status], None] = ignore
    latched: bool = False


class SendGoal(Command, frozen=True):
    """Send a goal to an action instead of the previous one of the same sender.

    Args:
        request: the goal; see `webviz.api.goal.goal_request`.
        by: id of the sender, such as a panel's name.
        title: what pages call it.
        report: called with whether the goal is accepted, and then with its outcome; must not block.
    """

    request: GoalRequest
    by: str
    title: str
    report: Callable[[Status], None] = ignore


class CallService(Command, frozen=True):
    """Call a service.

    Args:
        service: its name; remapped like a topic.
        type: such as "std_srvs/srv/Trigger".
        request: values by field; missing fields have their defaults.
        definition: text of the .srv file, for types unknown to webviz.
        answered: called with the response from another thread; must not block.
        failed: called with a sentence in the same way if there is none.
        timeout_s: for service and response to appear.
    """

    service: str
    type: str
    request: Mapping[str, Any]
    definition: str = ""
    answered: Callable[[Any], object] = ignore
    failed: Callable[[str], object] = ignore
    timeout_s: float = 5.0
