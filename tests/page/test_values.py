"""Values of messages in the page: as text in a pane, and as curves in the panel Plot."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import playwright.sync_api as playwright
import pytest
from pages import bounds

from tests.page.opened_panels import open_panel
from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.api.declared import Topic, make
from webviz.commands import AddDisplay, SetPanelProperty
from webviz.panels.plot import Plot
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz_displays.text import Text

NUMBER = "std_msgs/msg/Float64"
STRING = "std_msgs/msg/String"
JOINT_STATE = "sensor_msgs/msg/JointState"
HOSTILE = "<img src=x onerror=alert(1)>"
JOINTS = {
    "header": header("base", 5 * SECOND),
    "name": ["left", HOSTILE],
    "position": [0.25, 1e308],
}


def show_text(viewer: PageBench, type_: str) -> str:
    """Show the messages of a topic as text; return the id of the display."""
    viewer.offer("/joints", type_, "/robot")
    viewer.show(Text(name="Joints", topic=Topic("/joints")))
    return viewer.id("Joints")


def publish(viewer: PageBench, type_: str, **values: Any) -> None:
    viewer.pass_time(0.1)  # a text changes at most so often
    viewer.publish("/joints", type_, values)
    viewer.turn()


def text_pane(tab: ViewerTab) -> playwright.Locator:
    return tab.page.get_by_label("Text /joints", exact=True)


def test_a_text_is_a_pane_with_fields_that_fold(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    show_text(viewer, JOINT_STATE)
    publish(viewer, JOINT_STATE, **JOINTS)
    pane = text_pane(viewer_tab)
    viewer_tab.wait_for(lambda: pane.count() and "1e+308" in pane.inner_text())
    plot_panel = pane.inner_text()
    assert "/joints · sensor_msgs/msg/JointState" in plot_panel
    assert "5.000 s" in plot_panel
    assert HOSTILE in plot_panel
    assert "left" in plot_panel
    rows = pane.get_by_role("treeitem")
    before = rows.count()
    rows.filter(has_text="header").click()
    assert rows.count() == before - 2
    for _ in range(40):
        publish(viewer, JOINT_STATE, **JOINTS)
    viewer_tab.wait_for(lambda: "10 Hz" in pane.inner_text())
    show_text(viewer, STRING)
    publish(viewer, STRING, data="hello")
    viewer_tab.wait_for(lambda: "'hello'" in pane.inner_text())


def test_a_text_that_is_folded_is_not_sent(
    page_server: PageServer,
    viewer: PageBench,
    viewer_tab: ViewerTab,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("webviz.server.images.pictures.UNSEEN_S", 0.0)
    id_ = show_text(viewer, STRING)
    publish(viewer, STRING, data="first")
    pane = text_pane(viewer_tab)
    viewer_tab.wait_for(lambda: pane.count() and "'first'" in pane.inner_text())
    pane.get_by_role("button", name="Collapse /joints").click()
    viewer_tab.wait_for(lambda: page_server.scene.is_unseen(id_))
    publish(viewer, STRING, data="second")
    pane.get_by_role("button", name="Expand /joints").click()
    viewer_tab.wait_for(lambda: "'second'" in pane.inner_text())


NEWEST = ["0.9046", "0.999"]
CURVES = ["/wheels.position[left]", "/wheels.position[right]"]


@pytest.fixture
def plot(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[ViewerTab]:
    """The tab with the panel Plot open, which has 20 s of two curves."""
    viewer.offer("/wheels", JOINT_STATE, "/robot")
    open_panel(viewer_tab, make(Plot, {"curves": CURVES}))
    viewer_tab.wait_for(lambda: viewer_tab.page.locator(".wv-chart-entry").count() == 2)
    viewer_tab.wait_for(lambda: "/wheels" in viewer.source.subscriptions)
    for i in range(1000):
        turn_wheels(viewer, math.sin(i / 50), math.nan if 400 < i < 600 else i / 1000)
        viewer.pass_time(0.02)
        if i % 50 == 49:
            viewer.turn()
    viewer_tab.wait_for(lambda: legend(viewer_tab) == NEWEST)
    yield viewer_tab
    viewer.show()
    viewer_tab.show_tab("Displays")


def turn_wheels(viewer: PageBench, *position: float) -> None:
    viewer.publish("/wheels", JOINT_STATE, {"name": ["left", "right"], "position": position})


def legend(tab: ViewerTab) -> list[str]:
    return tab.page.locator(".wv-chart-value").all_inner_texts()


def hue(tab: ViewerTab, x: float) -> list[int]:
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


def chart_box(tab: ViewerTab) -> playwright.FloatRect:
    """The place of the chart in the window, in pixels."""
    return bounds(tab.page.locator(".wv-chart-canvas"))


def drag(tab: ViewerTab, start: tuple[float, float], end: tuple[float, float]) -> None:
    box = chart_box(tab)
    place = [(box["x"] + x * box["width"], box["y"] + y * box["height"]) for x, y in (start, end)]
    tab.page.mouse.move(*place[0])
    tab.page.mouse.down()
    tab.page.mouse.move(*place[1], steps=3)
    tab.page.mouse.up()


def test_curves_are_drawn_with_gaps_and_a_legend_that_has_statistics(plot: ViewerTab) -> None:
    plot.wait_for(lambda: hue(plot, 0.95) == [0, 1])
    assert hue(plot, 0.71) == [0], "the second curve has a gap"
    assert hue(plot, 0.3) == [], "of the window of 30 s, the first 10 s are empty"
    box = chart_box(plot)
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


def test_a_page_zooms_pans_and_resets_for_itself(plot: ViewerTab) -> None:
    reset = plot.button("Reset zoom (double click)")
    assert reset.is_disabled()
    drag(plot, (0.6, 0.5), (0.85, 0.5))
    plot.wait_for(lambda: hue(plot, 0.95) == [0])
    assert reset.is_enabled()
    reset.click()
    plot.wait_for(lambda: hue(plot, 0.95) == [0, 1])
    box = chart_box(plot)
    plot.page.mouse.move(box["x"] + box["width"] - 8, box["y"] + 50)
    for _ in range(5):
        plot.page.mouse.wheel(0, -100)
    plot.wait_for(lambda: hue(plot, 0.3) == [0])
    plot.page.locator(".wv-chart-canvas").dblclick()
    plot.wait_for(reset.is_disabled)


def test_a_paused_page_stands_still_while_values_come(plot: ViewerTab) -> None:
    chart = plot.page.locator(".wv-chart-tools")
    chart.get_by_role("button", name="Pause").click()
    plot.viewer.pass_time(1.0)
    turn_wheels(plot.viewer, 7.0, 8.0)
    plot.turn()
    assert legend(plot) == NEWEST
    chart.get_by_role("button", name="Resume").click()
    plot.wait_for(lambda: legend(plot) == ["7", "8"])


def test_values_are_downloaded_as_csv(plot: ViewerTab) -> None:
    with plot.page.expect_download() as download:
        plot.button("Download as CSV").click()
    lines = download.value.path().read_text().splitlines()
    assert lines[0] == "curve,time (s),value"
    assert lines[1] == '"/wheels.position[left]",100.000000,0'
    assert len(lines) == 1 + 1000 + 801


def test_a_field_is_plotted_from_its_row_and_removed_in_the_legend(
    viewer: PageBench, plot: ViewerTab
) -> None:
    viewer.offer("/joints", NUMBER, "/robot")
    viewer.do(AddDisplay("Text", {"topic": "/joints"}))
    publish(viewer, NUMBER, data=3.5)
    pane = text_pane(plot)
    plot.wait_for(lambda: pane.count() and "3.5" in pane.inner_text())
    pane.get_by_role("button", name="Plot", exact=True).click()
    (panel,) = viewer.states[-1].panels
    plot_panel: Any = panel.panel
    curves = [*CURVES, "/joints.data"]
    plot.wait_for_command(SetPanelProperty(panel.id, "curves", curves))
    assert plot_panel.curves == curves
    plot.button(f"Remove {CURVES[0]}").click()
    plot.wait_for_command(SetPanelProperty(panel.id, "curves", curves[1:]))
    assert plot_panel.curves == curves[1:]
