"""The panel that moves joints by sliders."""

from __future__ import annotations

import math
from concurrent.futures import Future
from typing import Any

import pytest
from bench import Benches
from waiting import until

from webviz.panels import joints as module
from webviz.panels.joints import Joints
from webviz.shell.testing.harness import OpenedPanel
from webviz.shell.testing.remembering_graph import RememberingGraph

PI = math.pi
HAND = """
<robot name="hand">
  <link name="palm"/><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
  <joint name="bend" type="revolute">
    <parent link="palm"/><child link="a"/>
    <limit lower="0.5" upper="1.5" effort="1" velocity="1"/>
  </joint>
  <joint name="tip" type="revolute">
    <parent link="a"/><child link="b"/><mimic joint="bend" multiplier="2" offset="0.1"/>
    <limit lower="0" upper="4" effort="1" velocity="1"/>
  </joint>
  <joint name="spin" type="continuous"><parent link="palm"/><child link="c"/></joint>
  <joint name="slide" type="prismatic">
    <parent link="palm"/><child link="d"/><limit lower="nan" upper="-1" effort="1" velocity="1"/>
  </joint>
</robot>
"""
ENDLESS = """
<robot name="endless"><link name="a"/><link name="b"/><link name="c"/>
  <joint name="one" type="continuous">
    <parent link="a"/><child link="b"/><mimic joint="two" multiplier="2"/>
  </joint>
  <joint name="two" type="continuous">
    <parent link="b"/><child link="c"/><mimic joint="one" multiplier="2"/>
  </joint>
</robot>
"""


class JointsPanel(OpenedPanel):
    """The panel in a viewer, without a page."""

    def __init__(self, bench: Benches, **options: Any) -> None:
        self.graph = RememberingGraph()
        self.bench = bench(graph=self.graph, **options)
        super().__init__(Joints, self.bench.do, self.bench.viewer)

    @property
    def reading(self) -> Future[Any] | None:
        assert isinstance(self.panel, Joints)
        return self.panel.reading

    def describe(self, text: str) -> None:
        before = self.reading
        self.bench.publish("/robot_description", "std_msgs/msg/String", {"data": text})
        until(lambda: self.reading is not before, turn=self.bench.turn)
        until(lambda: self.reading is None or self.reading.done())
        self.show()

    def slides(self) -> dict[str, tuple[float, float, float]]:
        rows = self.sliders().values["slides"]
        return {each["name"]: (each["low"], each["value"], each["high"]) for each in rows}

    def sliders(self) -> Any:
        return next(w for w in self.ui.widgets.values() if w.values["kind"] == "sliders")

    def move(self, name: str, value: float) -> None:
        self.sliders().use(f"{value} {name}", 1)

    def texts(self) -> str:
        return " ".join(w.values.get("text", "") for w in self.ui.widgets.values())

    def published(self) -> list[dict[str, float]]:
        messages = self.graph.published
        assert all(advertisement.topic == "/joint_states" for advertisement, _ in messages)
        return [dict(zip(each.name, each.position.tolist(), strict=True)) for _, each in messages]


@pytest.fixture
def hand(bench: Benches) -> JointsPanel:
    display_bench = JointsPanel(bench)
    assert "No robot description received on /robot_description" in display_bench.texts()
    display_bench.describe(HAND)
    return display_bench


def test_each_joint_that_leads_has_a_slider_within_its_limits(hand: JointsPanel) -> None:
    assert hand.slides() == {"bend": (0.5, 1.0, 1.5), "spin": (-PI, 0.0, PI), "slide": (-1, 0, 1)}
    assert "3 joints, 1 more follow them." in hand.texts()
    assert hand.published() == [], "nothing before somebody acts"


def test_a_moved_slider_publishes_all_joints_while_a_page_shows_it(
    hand: JointsPanel, monkeypatch: pytest.MonkeyPatch
) -> None:
    hand.move("bend", 0.75)
    assert hand.published() == [{"bend": 0.75, "tip": 1.6, "spin": 0.0, "slide": 0.0}]
    hand.show()
    assert len(hand.published()) == 2
    assert hand.slides()["bend"][1] == 0.75
    _, message = hand.graph.published[-1]
    assert message.header.stamp_ns == hand.bench.viewer.state().clock.ros_ns
    monkeypatch.setattr(module, "PAUSE_S", -1.0)
    monkeypatch.setattr("webviz.page.widgets.SETTLE_S", -1.0)
    hand.show()
    assert len(hand.published()) == 2
    assert hand.widget("Publish").value is False


def test_center_and_randomize_stay_within_the_limits(hand: JointsPanel) -> None:
    for _ in range(20):
        hand.widget("Randomize").use(None, 1)
        newest = hand.published()[-1]
        for name, (low, _, high) in hand.slides().items():
            assert low <= newest[name] <= high
        assert newest["tip"] == pytest.approx(2 * newest["bend"] + 0.1)
    hand.widget("Center").use(None, 1)
    assert hand.published()[-1] == {"bend": 1.0, "tip": 2.1, "spin": 0.0, "slide": 0.0}


def test_a_value_that_no_slider_has_is_refused(hand: JointsPanel) -> None:
    for value in (2.0, math.nan, math.inf):
        with pytest.raises(ValueError, match=r"is not in 0\.5 to 1\.5"):
            hand.move("bend", value)
    with pytest.raises(ValueError, match="is gone"):
        hand.move("toe", 0.0)
    assert hand.published() == []


def test_a_viewer_without_the_right_to_publish_has_a_reason(bench: Benches) -> None:
    display_bench = JointsPanel(bench, publish=("/cmd_vel",))
    display_bench.describe(HAND)
    display_bench.move("bend", 1.0)
    display_bench.show()
    assert display_bench.published() == []
    assert "/joint_states" in display_bench.texts()


def test_joints_that_follow_each_other_have_sliders_of_their_own(hand: JointsPanel) -> None:
    hand.describe(ENDLESS)
    assert list(hand.slides()) == ["one", "two"]
    hand.move("one", PI)
    assert hand.published() == [{"one": PI, "two": 0.0}]
    hand.describe("<robot")
    assert hand.slides() == {}
    assert "robot description" in hand.texts()
