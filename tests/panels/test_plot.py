"""The panel Plot: what it reads and keeps, without a browser."""

from __future__ import annotations

import math
import tracemalloc
from typing import Any

import numpy as np
import pytest
from bench import Benches

from tests.support.panel_facts import LonePanel
from tests.support.panel_facts import show as show_panel
from webviz.api.errors import Error
from webviz.commands import AddPanel, OpenPanels, Reset, Seek, SetPanelProperty
from webviz.data.messages import (
    Header,
    JointState,
    String,
    Time,
    decode,
    defined,
    encode,
    register,
)
from webviz.engine.state import PanelTimes
from webviz.page.recorded_ui import ChartWidget, RecordedUi
from webviz.panels.plot import Plot
from webviz.panels.plot.series import MAX_POINTS, CurveHistory
from webviz.sources import Offer, Publisher
from webviz.sources.past_state import PlaybackState

JOINTS = "sensor_msgs/msg/JointState"
TWIST = "geometry_msgs/msg/Twist"
SECOND = 10**9


class LonePlot(LonePanel[Plot]):
    """A plot with curves of a topic."""

    def __init__(self, *curves: str, **values: Any) -> None:
        publisher = Publisher("/robot", JOINTS, "reliable", "volatile")
        clock = PanelTimes(ros_ns=100 * SECOND)
        panel = Plot(curves=list(curves), **values)
        super().__init__(panel, offers={"/joints": Offer((publisher,))}, clock=clock)

    def send(self, value: float, at_s: float, stamp_s: float = 0.0) -> None:
        header = Header(Time(int(stamp_s), round(stamp_s % 1 * SECOND)))
        message = JointState(header, ["left"], np.array([value]))
        self.panel.take("/joints", message, round(at_s * SECOND))

    @property
    def chart(self) -> ChartWidget:
        return next(each for each in self.ui.widgets.values() if isinstance(each, ChartWidget))

    def curve(self, index: int = 0) -> dict[str, Any]:
        self.show()
        return self.chart.values["curves"][index]

    def points(self) -> list[tuple[float, float | None]]:
        """Return the points of the first curve, as a page puts them together."""
        first, end = self.curve()["chunks"]
        parts = [self.chart.parts[f"0.{number}"] for number in range(first, end)]
        return [
            (part["start"] + time, value)
            for part in parts
            for time, value in zip(part["times"], part["values"], strict=True)
        ]


def test_a_number_of_each_message_is_a_point_of_its_curve() -> None:
    bench = LonePlot("/joints.position[left]", "/joints.position[0]")
    assert bench.panel.subscriptions() == {"/joints": JOINTS}
    for i in range(3):
        bench.send(0.1 * i, 99.0 + 0.02 * i)
    assert bench.points() == pytest.approx(np.array([(99.0, 0.0), (99.02, 0.1), (99.04, 0.2)]))
    assert [curve["name"] for curve in bench.chart.values["curves"]] == bench.panel.curves
    assert (bench.chart.values["window"], bench.chart.values["now"]) == (30.0, 100.0)


def test_times_may_be_those_of_the_headers() -> None:
    bench = LonePlot("/joints.position[0]", time="Header Stamp")
    bench.send(1.0, 99.0, stamp_s=50.25)
    assert bench.points() == [(50.25, 1.0)]
    assert bench.chart.values["now"] == 50.25
    bench.panel.time = "Received"
    assert bench.points() == [], "times of another kind cannot be mixed"


@pytest.mark.parametrize(
    ("curve", "message", "reason"),
    [
        ("/nobody.data", None, "No publisher on /nobody."),
        (
            "joints.position[0]",
            None,
            "`joints.position[0]` has no topic. Start it with one, such as /odom.",
        ),
        ("/joints", None, "`/joints` has no field."),
        ("/joints.position[0]", None, "No message yet."),
        ("/joints.position[7]", JointState(), "No element 7 for `position[7]`; there are 0."),
        ("/joints.data", String("text"), "`/joints.data` is not a number."),
    ],
)
def test_a_curve_without_values_has_a_reason(curve: str, message: Any, reason: str) -> None:
    bench = LonePlot(curve)
    if message is not None:
        bench.panel.take("/joints", message, SECOND)
    assert bench.curve()["problem"].startswith(reason)
    assert bench.points() == []


def test_a_curve_may_have_functions_over_time_and_elements_that_come_and_go() -> None:
    bench = LonePlot("/joints{header.stamp>=10}.position[0].@derivative")
    for i in range(4):
        bench.send(0.5 * i * i, 90.0 + i, stamp_s=9.0 + i)
    assert bench.points() == [(92.0, 1.5), (93.0, 2.5)]
    assert bench.curve()["problem"] == ""


def test_bytes_that_do_not_decode_are_named() -> None:
    bench = LonePlot("/joints.position[0]")
    bench.panel.refuse("/joints", "Not a JointState.")
    assert bench.curve()["problem"] == "Not a JointState."
    bench.send(1.0, 99.0)
    assert bench.curve()["problem"] == ""


def test_values_that_are_not_finite_end_a_line_and_large_ones_do_not() -> None:
    bench = LonePlot("/joints.position[0]")
    values = [math.nan, 1.0, math.nan, math.inf, 1e308, -1e308]
    for i, value in enumerate(values):
        bench.send(value, 99.0 + 0.1 * i)
    assert [value for _, value in bench.points()] == [1.0, None, 1e308, -1e308]


def test_time_that_goes_back_starts_over_and_a_little_is_left_out() -> None:
    bench = LonePlot("/joints.position[0]")
    for at_s in (98.0, 99.0, 98.95):
        bench.send(1.0, at_s)
    assert len(bench.points()) == 2
    assert bench.curve()["problem"] == "1 values were left out: their times go back."
    bench.send(2.0, 50.0)
    assert bench.points() == [(50.0, 2.0)]
    bench.panel.start_over()
    assert bench.points() == []


def test_a_fast_topic_keeps_the_extremes_of_each_interval_and_no_more_than_promised() -> None:
    history = CurveHistory(window_s=4.0)
    times = np.arange(0.0, 10.0, 1e-4)  # 10 kHz
    values = np.sin(40 * times)
    values[87_654] = 99.0
    tracemalloc.start()
    for time, value in zip(times.tolist(), values.tolist(), strict=True):
        history.add(time, value)
    size, _ = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    points = np.array(history.points())
    assert len(points) <= MAX_POINTS
    assert size < 2_000_000
    assert points[0, 0] == pytest.approx(6.0, abs=0.2)
    assert (np.diff(points[:, 0]) >= 0).all()
    window = values[times >= points[0, 0]]
    assert (points[:, 1].min(), points[:, 1].max()) == (window.min(), 99.0)


def test_alternating_values_and_gaps_stay_within_the_bound() -> None:
    history = CurveHistory(window_s=1.0)
    for i in range(100_000):
        history.add(i * 1e-5 * 5, math.nan if i % 2 else 1.0)
    assert len(history.points()) <= MAX_POINTS


def test_a_new_point_replaces_only_the_last_part_of_a_curve() -> None:
    bench = LonePlot("/joints.position[0]", window=4.0)
    for i in range(200):
        bench.send(1.0, 90.0 + 0.02 * i)
    bench.show()
    before = dict(bench.chart.parts)
    bench.send(1.0, 94.01)
    bench.show()
    again = [key for key, part in bench.chart.parts.items() if before.get(key) is not part]
    assert len(before) > 30
    assert len(again) <= 2


def test_another_window_keeps_the_values_and_a_pause_of_the_panel_is_a_gap(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    bench = LonePlot("/joints.position[0]")
    bench.send(1.0, 98.0)
    bench.panel.window = 60.0
    assert bench.points() == [(98.0, 1.0)]
    monkeypatch.setattr("webviz.panels.plot.CLOSED_S", -1.0)
    bench.show()
    bench.send(2.0, 99.0)
    assert [value for _, value in bench.points()][:3] == [1.0, None, 2.0]


def test_a_curve_is_added_by_topic_and_field_and_removed_in_the_legend() -> None:
    bench = LonePlot("/joints.position[0]")
    chooser = bench.ui.widgets["1"]
    assert chooser.values["values"]["topics"] == ["/joints"]
    chooser.use('{"topic": "/joints"}', 7)
    bench.panel.take("/joints", JointState(name=["left"], position=np.array([0.5])), SECOND)
    bench.show()
    assert chooser.values["values"]["fields"] == ["header.stamp", "position[left]"]
    chooser.use('{"add": "/joints.position[left]"}', 7)
    curves = ["/joints.position[0]", "/joints.position[left]"]
    assert bench.commands.pop() == SetPanelProperty("id", "curves", curves)
    bench.chart.use("/joints.position[0]", 7)
    assert bench.commands.pop() == SetPanelProperty("id", "curves", [])
    with pytest.raises(ValueError, match="removed already"):
        bench.chart.use("/other.x", 7)


def test_a_curve_may_be_on_the_right_or_stand_in_place_of_time() -> None:
    left, right = "/joints.position[left]", "/joints.position[0]"
    bench = LonePlot(left, right=[left, "/other.x"], across=right)
    assert bench.curve(0)["name"] == right
    assert [each["axis"] for each in bench.chart.values["curves"]] == [0, 1]
    assert bench.chart.values["across"] == bench.curve(0)["key"]
    bench.chart.use(right, 7)
    assert bench.commands.pop() == SetPanelProperty("id", "across", "")
    assert bench.commands == []
    bench.panel.across = ""
    bench.show()
    assert bench.chart.values["across"] == -1


def test_curves_may_have_axes_of_their_own() -> None:
    curves = [f"/joints.position[{i}]" for i in range(8)]
    bench = LonePlot(*curves, right=[curves[0], curves[2]], own_axis=[*curves[2:], "/other.x"])
    axes = [each["axis"] for each in bench.chart.values["curves"]]
    assert axes == [1, 0, 2, 3, 4, 5, 0, 0]


def test_a_click_on_a_chart_seeks_within_the_recording() -> None:
    bench = LonePlot("/joints.position[0]")
    with pytest.raises(Error, match="no recording"):
        bench.chart.use("95", 7)
    past = PlaybackState(
        names=("run.mcap",),
        start_ns=90 * SECOND,
        end_ns=100 * SECOND,
        position_s=0.0,
        rate=1.0,
        is_playing=False,
        is_seeking=False,
        loop=False,
        selected=None,
        first_s=2.0,
    )
    bench.show(playback=past)
    for place, at_s in (("95.5", 5.5), ("-7", 2.0), ("1e9", 10.0)):
        bench.chart.use(place, 7)
        seek = bench.commands.pop()
        assert isinstance(seek, Seek)
        assert seek.at_s == pytest.approx(at_s)
    for hostile in ("nan", "inf", "-1e308", "", None, True, "9" * 400):
        with pytest.raises(ValueError, match=r"removed already|outside of the chart"):
            bench.chart.use(hostile, 7)
    assert bench.commands == []


def test_units_are_those_of_the_types_that_a_bag_defines() -> None:
    """Its topics, live ones and other bags may define the type differently."""
    name = "plotted_msgs/msg/Thing"
    register(name, "float64 motion\n")
    part = f"{'=' * 80}\nMSG: geometry_msgs/Twist\nVector3 linear\nVector3 angular\n"
    part += f"{'=' * 80}\nMSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z\n"
    types = defined(name, f"geometry_msgs/Twist motion\n{part}")
    bench = LonePlot("/thing.motion.linear.x", "/thing.motion.angular.z.@degrees")
    publisher = Publisher("the bag", name, "reliable", "volatile")
    bench.show(offers={"/thing": Offer((publisher,))})
    cdr = encode(name, {"motion": {"linear": {"x": 0.5}}}, types)
    bench.panel.take("/thing", decode(name, cdr, types), SECOND)
    assert [bench.curve(index)["unit"] for index in (0, 1)] == ["m/s", "°"]


def test_topics_are_read_while_the_panel_is_open_and_time_can_start_over(bench: Benches) -> None:
    b = bench()
    b.do(AddPanel("Plot", {"curves": ["/cmd_vel.linear.x"]}))
    (tab,) = b.viewer.state().panels
    plot = tab.panel
    assert isinstance(plot, Plot)
    plot.build(RecordedUi(), lambda command, browser=None: None)
    publisher = Publisher("/driver", TWIST, "reliable", "volatile")
    b.source.topics["/cmd_vel"] = Offer((publisher,))
    b.do(OpenPanels(frozenset({"Plot"})))
    show_panel(plot, b.viewer.state())
    b.turn()
    assert b.source.subscriptions["/cmd_vel"].type == TWIST
    for speed in (0.5, 0.7):
        b.publish("/cmd_vel", TWIST, {"linear": {"x": speed}})
    b.source.put("/cmd_vel", TWIST, b"\0\1\0\0")
    b.turn()
    (series,) = plot.series.values()
    assert [value for _, value in series.history.points()] == [0.5, 0.7]
    assert "Not a geometry_msgs/msg/Twist" in series.problem
    b.do(Reset())
    assert series.history.points() == []
    b.do(OpenPanels(frozenset()))
    assert "/cmd_vel" not in b.source.subscriptions
