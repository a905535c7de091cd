"""The panel Docking: docks and undocks a robot with Nav2's docking server."""

from __future__ import annotations

import math
import time
from typing import Annotated, Any

from webviz import commands
from webviz.api.declared import Prop
from webviz.api.errors import Error
from webviz.api.goal import GoalRequest, goal_request
from webviz.api.panel import Panel, Send, Ui
from webviz.api.status import Level, Status
from webviz.commands import CallService
from webviz.panels.fields import finite, keep

NO_NUMBER = "Enter the pose of the dock, or use an id."

DOCK, UNDOCK = "dock_robot", "undock_robot"
ASK_S = 5.0
"""Interval between requests for the types of the docking server, until it answers."""
STAGING_S, UNDOCKING_S = 1000.0, 30.0
"""Times allowed for the way to the staging pose, and for undocking; the actions' defaults."""
DEFAULT = "Default"
"""The type of dock that the server finds out itself."""
STRING_ARRAY = 9
"""Constant of rcl_interfaces/msg/ParameterType."""
STATES = {
    0: "none",
    1: "driving to the staging pose",
    2: "looking for the dock",
    3: "controlling",
    4: "waiting for the charge",
    5: "retrying",
}
"""States of the feedback of nav2_msgs/action/DockRobot."""
ERRORS = {
    901: "the dock is not in the database",
    902: "the dock is not valid",
    903: "the staging pose was not reached",
    904: "the dock was not detected",
    905: "the controller failed",
    906: "the robot does not charge",
    907: "it took too long",
    999: "unknown error",
}
"""Errors of the results of both actions."""
REMEDY = "Start Nav2's docking_server, or set the namespace of this panel."


class Docking(Panel):
    """Docks a robot, at a dock by its id or at a pose, and undocks it.

    All pages show the progress, and every operator can cancel it.
    """

    title = "Docking"
    rviz = "nav2_rviz_plugins/Docking"
    opens = "side"
    icon = "plug"

    namespace: Annotated[str, Prop(help="Namespace of Nav2's nodes; empty for none.")] = ""
    frame_id: Annotated[str, Prop(widget="frame", help="Frame of the dock's pose.")] = "map"

    def build(self, ui: Ui, send: Send) -> None:
        """Build the text of the goal and two buttons."""
        self.send = send
        self.asked_s = 0.0
        self.types: list[str] | None = None
        self.type = DEFAULT
        self.answer = Status(Level.OK, "")
        self.staging = ui.checkbox(
            "Drive to the staging pose",
            True,
            keep,
            "Drive there before docking; otherwise the robot must be there already.",
        )
        self.by_id = ui.checkbox(
            "By id", True, keep, "Dock at the dock with this id; otherwise at the pose."
        )
        self.id = ui.field(
            "Dock id", "", keep, "Id of the dock in the database of the docking server."
        )
        self.pose = [
            ui.field(label, "", keep, "Used without an id of the dock.")
            for label in ("x (m)", "y (m)", "yaw (rad)")
        ]
        self.choice = ui.choice("Dock type", DEFAULT, self._choose, "Plug-ins of docking_server.")
        ui.button("Dock", self._dock, "Dock the robot.", width=0.5)
        ui.button("Undock", self._undock, "Undock the robot.", width=0.5)
        self.result = ui.area()

    @property
    def uses(self) -> tuple[str, ...]:
        """Its actions, and the service of the parameters."""
        return self._full(DOCK), self._full(UNDOCK), self._parameters

    def show(self) -> None:
        """Ask the server for its types until it answers, and show the newest outcome."""
        if self.types is None and time.monotonic() - self.asked_s > ASK_S:
            self.asked_s = time.monotonic()
            self.send(
                CallService(
                    self._parameters,
                    "rcl_interfaces/srv/GetParameters",
                    {"names": ["dock_plugins"]},
                    answered=self._take_types,
                    timeout_s=2.0,
                )
            )
        self.choice.offer([DEFAULT, *(self.types or ())], self.type)
        self.result.text(self.answer.text if self.answer.level > Level.OK else "")

    @property
    def _parameters(self) -> str:
        return f"{self._full('docking_server')}/get_parameters"

    def _take_types(self, response: Any) -> None:
        values = [each for each in response.values if each.type == STRING_ARRAY]
        self.types = list(values[0].string_array_value) if values else []

    def _choose(self, name: str, browser: int | None) -> None:
        self.type = name

    def _dock(self, browser: int | None) -> None:
        goal: dict[str, Any] = {
            "use_dock_id": self.by_id.value,
            "max_staging_time": STAGING_S,
            "navigate_to_staging_pose": self.staging.value,
        }
        if self.by_id.value:
            goal["dock_id"] = label = self.id.value.strip()
            if not label:
                raise Error("No dock id. Enter one, or switch off By id.")
        else:
            x, y, yaw = (finite(field.value, NO_NUMBER) for field in self.pose)
            turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
            pose = {"position": {"x": x, "y": y}, "orientation": turn}
            goal["dock_pose"] = {"header": {"frame_id": self.frame_id}, "pose": pose}
            goal["dock_type"] = self._type()
            label = f"x {x:.2f} y {y:.2f} m"
        request = goal_request(
            self._full(DOCK),
            "nav2_msgs/action/DockRobot",
            goal,
            label=label,
            remedy=REMEDY,
            success="Docked.",
            feedback=progress,
            fault=fault,
        )
        self._send_goal(request, browser)

    def _undock(self, browser: int | None) -> None:
        request = goal_request(
            self._full(UNDOCK),
            "nav2_msgs/action/UndockRobot",
            {"dock_type": self._type(), "max_undocking_time": UNDOCKING_S},
            label="undock",
            remedy=REMEDY,
            success="Undocked.",
            fault=fault,
        )
        self._send_goal(request, browser)

    def _send_goal(self, request: GoalRequest, browser: int | None) -> None:
        self.send(
            commands.SendGoal(request, f"panel {self.name}", self.name, self._report), browser
        )

    def _type(self) -> str:
        return "" if self.type == DEFAULT else self.type

    def _report(self, outcome: Status) -> None:
        self.answer = outcome

    def _full(self, name: str) -> str:
        return "/".join(["", *filter(None, [self.namespace.strip("/")]), name])


def progress(feedback: Any) -> dict[str, str]:
    """Return the progress in the feedback of DockRobot."""
    return {
        "State": STATES.get(feedback.state, "unknown"),
        "Time taken": f"{feedback.docking_time.sec} s",
        "Retries": str(feedback.num_retries),
    }


def fault(result: Any) -> str:
    """Return the fault in a result; "" for none."""
    if result.success:
        return ""
    reason = result.error_msg or ERRORS.get(result.error_code, "no reason given")
    return f"Failed ({result.error_code}): {reason}"
