"""The panel Selector with a real server of Nav2's parameters, and one that comes late."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from typing import Any

import pytest
from waiting import until

from tests.support.panel_facts import show as show_panel

pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")

from nodes import SpunNode
from rclpy.qos import DurabilityPolicy, QoSProfile
from std_msgs.msg import String

import webviz
from webviz.commands import AddPanel, OpenPanels
from webviz.page.recorded_ui import RecordedUi
from webviz.panels import selector
from webviz.panels.selector import Selector


class PlannerServer(SpunNode):
    """A node that spins in a thread, as Nav2's do."""

    def __init__(self, domain: int) -> None:
        super().__init__(domain, "planner_server")
        self.node.declare_parameter("planner_plugins", ["GridBased", "Smac"])
        threading.Thread(target=self.executor.spin, daemon=True).start()


@pytest.fixture
def server(webviz_domain: int) -> Iterator[PlannerServer]:
    server = PlannerServer(webviz_domain)
    yield server
    server.close()


def test_a_behavior_tree_that_comes_later_gets_the_choice(
    server: PlannerServer, webviz_domain: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(selector, "ASK_S", 0.2)
    with webviz.Viewer(port=0, ros_args=[]) as viewer:
        viewer.do(AddPanel("Selector"))
        viewer.do(OpenPanels(frozenset({"Selector"})))
        panel = next(tab.panel for tab in viewer.state.panels if isinstance(tab.panel, Selector))
        ui = RecordedUi()

        def send(command: Any, browser: int | None = None) -> None:
            viewer.do(command)

        panel.build(ui, send)
        choice: Any = next(w for w in ui.widgets.values() if w.values.get("label") == "Planner")

        def is_offered() -> bool:
            show_panel(panel, viewer.state)
            return "Smac" in choice.values["options"]

        until(is_offered)
        choice.use("Smac", None)
        messages: list[Any] = []
        qos = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
        server.node.create_subscription(String, "/planner_selector", messages.append, qos)
        until(lambda: messages)
        assert messages[0].data == "Smac"
