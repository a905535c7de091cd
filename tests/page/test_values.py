"""Values of messages in the page: as text in a pane, and as curves in the panel Plot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from webviz.api.declared import Topic
from webviz.api.nodes import Pane
from webviz.api.pictures import Readout
from webviz.commands import SetPanelProperty
from webviz.data.messages import Header, JointState, String, Time, message_class
from webviz.engine.state import PanelTab, PanelTimes, Row, Traffic
from webviz.panels.plot import Plot
from webviz.server.images.pictures import Pictures
from webviz.sources import Offer, Publisher
from webviz_displays.text import Text

SECOND = 10**9
Number = message_class("std_msgs/msg/Float64")
HOSTILE = "<img src=x onerror=alert(1)>"
JOINTS = JointState(Header(Time(5, 0), "base"), ["left", HOSTILE], np.array([0.25, 1e308]))


@pytest.fixture(scope="module")
def pictures(server: Any) -> Pictures:
    return Pictures(server.channel)


@pytest.fixture
def texts(tab: Any, pictures: Pictures) -> Iterator[Any]:
    """The tab with a text of joint states."""
    display = Text(name="Joints", topic=Topic("/joints"))
    tab.loop.show(
        Row("Joints", "Text", display, "Joints", {}), traffic={"/joints": Traffic(50.0, 1.0)}
    )
    yield tab
    pictures.remove("Joints")


def test_a_text_is_a_pane_with_fields_that_fold(texts: Any, pictures: Pictures) -> None:
    pictures.show("Joints", Pane(Readout("/joints", "sensor_msgs/msg/JointState", JOINTS)))
    pane = texts.page.get_by_label("Text /joints", exact=True)
    texts.wait_for(lambda: pane.count() and "1e+308" in pane.inner_text())
    shown = pane.inner_text()
    assert "/joints · sensor_msgs/msg/JointState" in shown
    assert "5.000 s" in shown
    assert HOSTILE in shown
    assert "left" in shown
    rows = pane.get_by_role("treeitem")
    before = rows.count()
    rows.filter(has_text="header").click()
    assert rows.count() == before - 2
    texts.wait_for(lambda: "50 Hz" in pane.inner_text())
    pictures.show("Joints", Pane(Readout("/joints", "std_msgs/msg/String", String("hello"))))
    texts.wait_for(lambda: "'hello'" in pane.inner_text())


def test_a_text_that_is_folded_is_not_sent(
    texts: Any, pictures: Pictures, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("webviz.server.images.pictures.UNSEEN_S", 0.0)
    pictures.show("Joints", Pane(Readout("/joints", "std_msgs/msg/String", String("first"))))
    pane = texts.page.get_by_label("Text /joints", exact=True)
    texts.wait_for(lambda: pane.count() and "'first'" in pane.inner_text())
    pane.get_by_role("button", name="Collapse /joints").click()
    texts.wait_for(lambda: pictures.is_unseen("Joints"))
    pictures.show("Joints", Pane(Readout("/joints", "std_msgs/msg/String", String("second"))))
    pane.get_by_role("button", name="Expand /joints").click()
    texts.wait_for(lambda: "'second'" in pane.inner_text())


NEWEST = ["0.9046", "0.999"]
CURVES = ["/wheels.position[left]", "/wheels.position[right]"]


@pytest.fixture
def plot(tab: Any) -> Iterator[Any]:
    """The tab with the panel Plot open, which has 20 s of two curves."""
    panel = Plot(name="Plot", curves=CURVES)
    wheels = Publisher("/robot", "sensor_msgs/msg/JointState", "reliable", "volatile")
    tab.loop.show(
        panels=(PanelTab("plot", "Plot", panel),),
        offers={"/wheels": Offer((wheels,))},
        clock=PanelTimes(ros_ns=120 * SECOND),
    )
    tab.show_tab("Plot")
    tab.wait_for(lambda: tab.page.locator(".wv-chart-entry").count() == 2)
    for i in range(1000):
        position = np.array([math.sin(i / 50), math.nan if 400 < i < 600 else i / 1000])
        message = JointState(name=["left", "right"], position=position)
        panel.take("/wheels", message, 100 * SECOND + i * SECOND // 50)
    tab.wait_for(lambda: legend(tab) == NEWEST)
    yield tab
    tab.loop.show(panels=())
    tab.show_tab("Displays")


def legend(tab: Any) -> list[str]:
    return tab.page.locator(".wv-chart-value").all_inner_texts()


def hue(tab: Any, x: float) -> list[int]:
    """The numbers of the curves that are drawn at a share of the width of the chart."""
    script = """(canvas, x) => {
      const [w, h] = [canvas.width, canvas.height];
      const data = canvas.getContext("2d").getImageData(x * w, 0, 8, h).data;
      const found = new Set();
      for (let i = 0; i < data.length; i += 4) {
        const [r, g, b, a] = data.slice(i, i + 4);
        if (a > 200 && Math.max(r, g, b) - Math.min(r, g, b) > 90) found.add(b > r ? 0 : 1);
      }
      return [...found].sort();
    }"""
    return tab.page.locator(".wv-chart-canvas").evaluate(script, x)


def drag(tab: Any, start: tuple[float, float], end: tuple[float, float]) -> None:
    box = tab.page.locator(".wv-chart-canvas").bounding_box()
    place = [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in (start, end)]
    tab.page.mouse.move(*place[0])
    tab.page.mouse.down()
    tab.page.mouse.move(*place[1], steps=3)
    tab.page.mouse.up()


def test_curves_are_drawn_with_gaps_and_a_legend_that_has_statistics(plot: Any) -> None:
    plot.wait_for(lambda: hue(plot, 0.95) == [0, 1])
    assert hue(plot, 0.71) == [0], "the second curve has a gap"
    assert hue(plot, 0.3) == [], "of the window of 30 s, the first 10 s are empty"
    box = plot.page.locator(".wv-chart-canvas").bounding_box()
    plot.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 50)
    plot.wait_for(lambda: legend(plot) != NEWEST)
    plot.page.mouse.move(0, 0)
    plot.wait_for(lambda: legend(plot) == NEWEST)
    sums = plot.page.locator(".wv-chart-sums").last
    assert sums.inner_text() == ""
    plot.button("Statistics of the visible values").click()
    plot.wait_for(lambda: sums.inner_text().startswith("min 0, max 0.999, mean 0.4"))
    plot.button("Statistics of the visible values").click()
    plot.wait_for(lambda: sums.inner_text() == "")


def test_a_page_zooms_pans_and_resets_for_itself(plot: Any) -> None:
    reset = plot.button("Reset zoom (double click)")
    assert reset.is_disabled()
    drag(plot, (0.6, 0.5), (0.85, 0.5))
    plot.wait_for(lambda: hue(plot, 0.95) == [0])
    assert reset.is_enabled()
    reset.click()
    plot.wait_for(lambda: hue(plot, 0.95) == [0, 1])
    box = plot.page.locator(".wv-chart-canvas").bounding_box()
    plot.page.mouse.move(box["x"] + box["width"] - 8, box["y"] + 50)
    for _ in range(5):
        plot.page.mouse.wheel(0, -100)
    plot.wait_for(lambda: hue(plot, 0.3) == [0])
    plot.page.locator(".wv-chart-canvas").dblclick()
    plot.wait_for(reset.is_disabled)


def test_a_paused_page_stands_still_while_values_come(plot: Any) -> None:
    chart = plot.page.locator(".wv-chart-tools")
    chart.get_by_role("button", name="Pause").click()
    panel = plot.loop.state.panels[0].panel
    message = JointState(name=["left", "right"], position=np.array([7.0, 8.0]))
    panel.take("/wheels", message, 121 * SECOND)
    plot.turn()
    assert legend(plot) == NEWEST
    chart.get_by_role("button", name="Resume").click()
    plot.wait_for(lambda: legend(plot) == ["7", "8"])


def test_values_are_downloaded_as_csv(plot: Any) -> None:
    with plot.page.expect_download() as download:
        plot.button("Download as CSV").click()
    lines = download.value.path().read_text().splitlines()
    assert lines[0] == "curve,time (s),value"
    assert lines[1] == '"/wheels.position[left]",100.000000,0'
    assert len(lines) == 1 + 1000 + 801


def test_a_field_is_plotted_from_its_row_and_removed_in_the_legend(
    plot: Any, texts: Any, pictures: Pictures
) -> None:
    pictures.show("Joints", Pane(Readout("/joints", "std_msgs/msg/Float64", Number(3.5))))
    pane = texts.page.get_by_label("Text /joints", exact=True)
    texts.wait_for(lambda: pane.count() and "3.5" in pane.inner_text())
    pane.get_by_role("button", name="Plot", exact=True).click()
    curves = [*CURVES, "/joints.data"]
    plot.wait_for(lambda: SetPanelProperty("plot", "curves", curves) in plot.loop.commands)
    plot.button(f"Remove {CURVES[0]}").click()
    plot.wait_for(lambda: SetPanelProperty("plot", "curves", CURVES[1:]) in plot.loop.commands)
