"""The panel Navigation 2: state of Nav2, its start and stop, and the goals of all clients."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Mapping
from typing import Annotated, Any

from webviz.api.declared import Prop
from webviz.api.panel import Panel, Send, Ui
from webviz.commands import CallService
from webviz.data.messages import interfaces
from webviz.tools.nav2_goal import progress

ASK_S = 1.0
"""Interval between requests to the lifecycle managers."""
STARTUP, PAUSE, RESUME, RESET, SHUTDOWN = range(5)
"""Commands of nav2_msgs/srv/ManageLifecycleNodes."""
BUTTONS = (
    ("Startup", STARTUP, "Configure and activate all nodes."),
    ("Pause", PAUSE, "Deactivate all nodes."),
    ("Resume", RESUME, "Activate the nodes that are paused."),
    ("Reset", RESET, "Deactivate and clean up all nodes."),
    ("Shutdown", SHUTDOWN, "Shut down all nodes."),
)
STATES = {1: "accepted", 2: "active", 3: "cancelling", 4: "succeeded", 5: "cancelled", 6: "aborted"}
"""States of action_msgs/msg/GoalStatus."""
UNDER_WAY = (1, 2, 3)
STATUS = "action_msgs/msg/GoalStatusArray"
CANCEL = "action_msgs/srv/CancelGoal"
RETURN_CODES = {
    0: "no goal is active",
    1: "rejected",
    2: "unknown goal",
    3: "the goal has ended already",
}
ACTIONS: Mapping[str, tuple[str, Callable[[Any], Mapping[str, str]]]] = {
    "navigate_to_pose": ("nav2_msgs/action/NavigateToPose", progress),
    "navigate_through_poses": ("nav2_msgs/action/NavigateThroughPoses", progress),
    "follow_waypoints": (
        "nav2_msgs/action/FollowWaypoints",
        lambda feedback: {"Waypoint": str(feedback.current_waypoint + 1)},
    ),
}
"""Type of each action, and what its feedback says."""


class Nav2(Panel):
    """State of Nav2, its start and stop, and the goals of all clients."""

    title = "Navigation 2"
    rviz = "nav2_rviz_plugins/Navigation 2"
    opens = "side"
    icon = "flag"

    namespace: Annotated[str, Prop(help="Namespace of Nav2's nodes; empty for none.")] = ""
    navigation_manager: Annotated[str, Prop(help="Lifecycle manager of the navigation.")] = (
        "lifecycle_manager_navigation"
    )
    localization_manager: Annotated[str, Prop(help="Lifecycle manager of the localisation.")] = (
        "lifecycle_manager_localization"
    )

    def build(self, ui: Ui, send: Send) -> None:
        """Two tables and the buttons."""
        self.states: dict[str, str] = {}
        self.goals: dict[str, Mapping[str, str]] = {}
        self.answers: dict[str, str] = {}
        self.send = send
        self.asked_s = 0.0
        self.managers = ui.area()
        for label, command, hint in BUTTONS:
            ui.button(label, functools.partial(self._manage, command), hint, width=1 / 3)
        ui.button("Cancel all goals", self._cancel, "Cancel the goals of all clients.", width=1 / 3)
        self.answer = ui.area()
        self.progress = ui.area()

    @property
    def uses(self) -> tuple[str, ...]:
        """Services of the managers, and the actions whose goals it cancels."""
        services = ("is_active", "manage_nodes")
        return (
            *(f"{name}/{service}" for name in self._managers().values() for service in services),
            *map(self._full, ACTIONS),
        )

    def subscriptions(self) -> Mapping[str, str]:
        """Status and feedback of the actions."""
        subscriptions = {}
        for name, (action, _) in ACTIONS.items():
            base = f"{self._full(name)}/_action"
            subscriptions[f"{base}/status"] = STATUS
            subscriptions[f"{base}/feedback"] = interfaces.action(action).feedback
        return subscriptions

    def take(self, topic: str, message: Any) -> None:
        """Note how a goal is going."""
        name, _, kind = topic.rpartition("/_action/")
        if kind == "feedback":
            _, read = ACTIONS[name.rpartition("/")[2]]
            self.goals[name] = {**self.goals.get(name, {}), **read(message.feedback)}
        elif len(message.status_list):
            newest = message.status_list[-1].status
            state = STATES.get(newest, "unknown")
            feedback = self.goals.get(name, {}) if newest in UNDER_WAY else {}
            self.goals[name] = {**feedback, "State": state}

    def show(self) -> None:
        """Ask the managers now and then, and show what is known."""
        if time.monotonic() - self.asked_s > ASK_S:
            self.asked_s = time.monotonic()
            for label, name in self._managers().items():
                self._ask(label, name)
        labels = self._managers()
        self.managers.table([(label, self.states.get(label, "unknown")) for label in labels])
        goals = [
            (name.rpartition("/")[2] if key == "State" else "", key, value)
            for name, values in sorted(self.goals.items())
            for key, value in {"State": values.get("State", ""), **values}.items()
        ]
        if goals:
            self.progress.table(goals)
        else:
            self.progress.text("No goal of any client so far.")

    def _full(self, name: str) -> str:
        """Return a name in the namespace, unless it is absolute."""
        if name.startswith("/"):
            return name
        return "/".join(["", *filter(None, [self.namespace.strip("/")]), name])

    def _managers(self) -> dict[str, str]:
        return {
            "Navigation": self._full(self.navigation_manager),
            "Localization": self._full(self.localization_manager),
        }

    def _ask(self, label: str, manager: str) -> None:
        def answered(response: Any) -> None:
            self.states[label] = "active" if response.success else "inactive"

        def failed(reason: str) -> None:
            self.states[label] = f"unknown: {reason}"

        self.send(
            CallService(
                f"{manager}/is_active",
                "std_srvs/srv/Trigger",
                {},
                answered=answered,
                failed=failed,
                timeout_s=2.0,
            )
        )

    def _manage(self, command: int, browser: int | None) -> None:
        """Send a command to both managers."""
        for label, manager in self._managers().items():

            def answered(response: Any, label: str = label) -> None:
                failure = "Failed. See the log of the lifecycle manager."
                self._say(label, "Done." if response.success else failure)

            self.send(
                CallService(
                    f"{manager}/manage_nodes",
                    "nav2_msgs/srv/ManageLifecycleNodes",
                    {"command": command},
                    answered=answered,
                    failed=functools.partial(self._say, label),
                    timeout_s=60.0,
                ),
                browser,
            )
            self._say(label, "Waiting ...")

    def _cancel(self, browser: int | None) -> None:
        """Cancel the goals of all clients: those with id 0 at stamp 0 are all."""
        for name in ACTIONS:

            def answered(response: Any, name: str = name) -> None:
                count = len(response.goals_canceling)
                reason = RETURN_CODES.get(response.return_code, "unknown reason")
                self._say(name, f"{count} cancelled." if count else f"Nothing cancelled: {reason}.")

            self.send(
                CallService(
                    f"{self._full(name)}/_action/cancel_goal",
                    CANCEL,
                    {},
                    answered=answered,
                    failed=functools.partial(self._say, name),
                ),
                browser,
            )

    def _say(self, of: str, text: str) -> None:
        """Show the newest answer of a manager or action."""
        self.answers[of] = text
        self.answer.table(sorted(self.answers.items()))
