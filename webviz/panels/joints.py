"""The panel Joints: moves the joints of a robot by sliders, as joint_state_publisher_gui does."""

from __future__ import annotations

import math
import random
import threading
import time
from collections.abc import Mapping
from concurrent.futures import Future
from typing import Annotated, Any

import webviz_urdf
from webviz.api.declared import Prop
from webviz.api.panel import Panel, Send, Slide, Ui
from webviz.api.status import Level, Status
from webviz.commands import Publish
from webviz.data.words import counted
from webviz.engine.state import PanelTimes
from webviz_urdf import Joint, RobotDescriptionError, leader_of

STATE = "sensor_msgs/msg/JointState"
PAUSE_S = 2.0
"""A panel that no page has shown for this long stops publishing."""
FARTHEST = 1e6
"""Limits beyond are no limits."""


class Joints(Panel):
    """Sliders for the joints of a robot, whose positions are published."""

    title = "Joints"
    opens = "side"
    icon = "robot"

    robot_description: Annotated[str, Prop(help="Topic of the robot's URDF.")] = (
        "/robot_description"
    )
    topic: Annotated[str, Prop(help="Topic of the positions.")] = "/joint_states"

    def build(self, ui: Ui, send: Send) -> None:
        """Show a check box, two buttons and the sliders."""
        self.send = send
        self.lock = threading.RLock()
        self.joints: Mapping[str, Joint] = {}
        self.positions: dict[str, float] = {}
        self.reading: Future[Mapping[str, Joint]] | None = None
        self.text = ""
        self.shown_s = 0.0
        self.sender: int | None = None
        self.outcome = Status(Level.OK, "")
        self.now_ns = 0
        self.about = ui.area()
        self.switch = ui.checkbox(
            "Publish",
            False,
            self._switch,
            "Publish the positions while this tab is open; moving a slider does so, too.",
        )
        ui.button(
            "Center",
            self._center,
            "Set all joints to 0, or to the middle of their range.",
            width=0.5,
        )
        ui.button("Randomize", self._randomize, "Set all joints to random positions.", width=0.5)
        self.sliders = ui.sliders(self._move)
        self.result = ui.area()

    def subscriptions(self) -> Mapping[str, str]:
        """Return the description."""
        return {self.robot_description: "std_msgs/msg/String"}

    def publications(self) -> Mapping[str, str]:
        """Return the positions."""
        return {self.topic: STATE}

    def take(self, topic: str, message: Any) -> None:
        """Read a new description in a thread, as it may be long."""
        if message.data == self.text:
            return
        self.text = message.data
        reading: Future[Mapping[str, Joint]] = Future()
        self.reading = reading

        def read() -> None:
            try:
                reading.set_result(webviz_urdf.moving_joints(message.data))
            except Exception as error:  # shown in the tab
                reading.set_exception(error)

        threading.Thread(target=read, name="webviz-joints", daemon=True).start()

    def show(self, clock: PanelTimes) -> None:
        """Show the joints, and publish their positions again."""
        now_s = time.monotonic()
        with self.lock:
            self.now_ns = clock.ros_ns
            if now_s - self.shown_s > PAUSE_S:
                self.switch.show(False)
                self.sender = None
            self.shown_s = now_s
            self._take_description()
            self.sliders.show([self._slide(self.joints[name]) for name in self._leaders()])
            if self.switch.value:
                self._publish()
            self.result.text(self.outcome.text if self.outcome.level > Level.OK else "")

    def _take_description(self) -> None:
        if self.reading is None:
            self.about.text(
                f"No robot description received on {self.robot_description}. "
                "Start robot_state_publisher."
            )
            return
        if not self.reading.done():
            return
        try:
            joints = self.reading.result()
        except RobotDescriptionError as error:
            self.joints = {}
            self.about.text(str(error))
            return
        if joints is not self.joints:
            self.joints = joints
            before = self.positions
            self.positions = {name: _middle(joint) for name, joint in joints.items()}
            self.positions |= {
                name: min(max(value, _limits(joints[name])[0]), _limits(joints[name])[1])
                for name, value in before.items()
                if name in joints
            }
        leaders = len(self._leaders())
        following = len(joints) - leaders
        more = f", {following} more follow them" if following else ""
        text = (
            f"{counted(leaders, 'joint')}{more}." if joints else "The robot has no movable joints."
        )
        self.about.text(text)

    def _leaders(self) -> list[str]:
        return [
            name for name, each in self.joints.items() if leader_of(each, self.joints)[0] == name
        ]

    def _slide(self, joint: Joint) -> Slide:
        unit = "m" if joint.type == "prismatic" else "rad"
        return Slide(joint.name, self.positions[joint.name], *_limits(joint), unit)

    def _switch(self, value: bool, browser: int | None) -> None:
        self.sender = browser
        if value:
            self._publish()

    def _move(self, name: str, value: float, browser: int | None) -> None:
        with self.lock:
            if name in self.joints:
                self.positions[name] = value
                self._begin(browser)

    def _center(self, browser: int | None) -> None:
        with self.lock:
            self.positions = {name: _middle(joint) for name, joint in self.joints.items()}
            self._begin(browser)

    def _randomize(self, browser: int | None) -> None:
        with self.lock:
            self.positions = {
                name: random.uniform(*_limits(joint)) for name, joint in self.joints.items()
            }
            self._begin(browser)

    def _begin(self, browser: int | None) -> None:
        self.sender = browser
        self.switch.show(True)
        self._publish()

    def _publish(self) -> None:
        """Publish the positions of all joints, also of those that follow others."""
        with self.lock:
            if not self.joints:
                return
            leaders = {name: leader_of(joint, self.joints) for name, joint in self.joints.items()}
            values = {
                name: self.positions[leader] * factor + offset
                for name, (leader, factor, offset) in leaders.items()
            }
            sec, nanosec = divmod(self.now_ns, 1_000_000_000)
            message = {
                "header": {"stamp": {"sec": sec, "nanosec": nanosec}},
                "name": list(values),
                "position": [value if math.isfinite(value) else 0.0 for value in values.values()],
            }
        self.send(Publish(self.topic, STATE, message, report=self._report), self.sender)

    def _report(self, outcome: Status) -> None:
        self.outcome = outcome


def _limits(joint: Joint) -> tuple[float, float]:
    """Return the ends of a slider: the joint's limits, else half a turn or a metre each way."""
    if joint.limits is not None and max(map(abs, joint.limits)) < FARTHEST:
        return joint.limits
    return (-1.0, 1.0) if joint.type == "prismatic" else (-math.pi, math.pi)


def _middle(joint: Joint) -> float:
    """0, or the middle if that is outside the limits."""
    low, high = _limits(joint)
    return 0.0 if low <= 0.0 <= high else (low + high) / 2.0
