"""Fields of messages that are added to panels in a popover and by dragging, and room for curves."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest
from playwright.sync_api import expect

from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.commands import SetPanelProperty
from webviz.files.config import DockedPanel, Layout
from webviz.panels.plot import Plot
from webviz.panels.raw import RawMessage

TWIST = "geometry_msgs/msg/Twist"
FIELDS = ["/cmd.linear.x", "/cmd.angular.z"]
BELOW = Layout(below=(DockedPanel(panel="Plot", tabs=("RawMessage",)),))


@pytest.fixture(autouse=True)
def _close(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[None]:
    yield
    viewer.show()
    viewer_tab.wait_for(lambda: viewer_tab.page.locator(".wv-docked").count() == 0)
    viewer_tab.show_tab("Displays")


def publish(viewer: PageBench, x: float) -> None:
    viewer.publish("/cmd", TWIST, {"linear": {"x": x}})
    viewer.turn()


def show(viewer: PageBench, tab: ViewerTab, *curves: str) -> tuple[str, str]:
    """Show a plot and a raw message below the scene, with one topic; return their ids."""
    panels = [Plot(name="Plot", curves=list(curves)), RawMessage(name="Raw")]
    viewer.show(panels=panels, layout=BELOW)
    viewer.source.topics.clear()
    viewer.offer("/cmd", TWIST, "/robot")
    front = tab.page.locator(".wv-docked [role=tab][data-tab=Plot]")
    tab.wait_for(lambda: front.count() == 1)
    front.click()
    tab.wait_for(lambda: tab.page.locator("[data-panel=plugin-Plot]").count() == 1)
    tab.wait_for(lambda: tab.page.locator(".wv-chart-entry").count() == len(curves))
    plot, raw = viewer.states[-1].panels
    return plot.id, raw.id


def panel(viewer: PageBench, number: int) -> Any:
    """The first or the second panel."""
    return viewer.states[-1].panels[number].panel


def test_a_field_is_added_in_a_popover_by_keys(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    plot, _ = show(viewer, tab)
    tab.wait_for(lambda: "Add a field with +" in tab.text())
    tab.button("Add a field").click()
    topic = tab.page.get_by_role("combobox", name="Topic", exact=True)
    expect(topic).to_be_focused()
    topic.fill("/cmd")
    topic.press("Enter")
    tab.wait_for(lambda: "/cmd" in viewer.source.subscriptions)
    publish(viewer, 0.0)
    fields = tab.page.get_by_role("listbox", name="Fields").get_by_role("option")
    tab.wait_for(lambda: fields.count() == 6)
    expect(tab.page.get_by_role("combobox", name="Field", exact=True)).to_be_focused()
    tab.page.keyboard.type("ang z")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(SetPanelProperty(plot, "curves", ["/cmd.angular.z"]))
    assert panel(viewer, 0).curves == ["/cmd.angular.z"]
    tab.page.keyboard.press("Escape")
    expect(fields).to_have_count(0)
    expect(tab.button("Add a field")).to_be_focused()


def test_topics_and_fields_are_dragged_onto_panels_and_the_scene(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    plot, raw = show(viewer, tab)
    tab.show_tab("Topics")
    topic = tab.page.locator(".wv-topic")
    tab.wait_for(lambda: topic.count() == 1)
    here = tab.page.locator(".wv-docked .wv-plugin")
    topic.drag_to(here)
    tab.wait_for(lambda: panel(viewer, 0).chooser.topic == "/cmd")
    expect(tab.page.get_by_role("dialog", name="Add a field")).to_be_visible()
    tab.page.keyboard.press("Escape")

    topic.click()
    tab.wait_for(lambda: "/cmd" in viewer.states[-1].inspected)
    publish(viewer, 0.5)
    field = tab.page.locator(".wv-field-row").filter(has_text="x0.5")
    tab.wait_for(lambda: field.count() == 1)
    field.drag_to(here)
    tab.wait_for_command(SetPanelProperty(plot, "curves", ["/cmd.linear.x"]))
    assert panel(viewer, 0).curves == ["/cmd.linear.x"]
    tab.page.get_by_role("tab", name="Raw").click()
    tab.wait_for(lambda: tab.page.locator("[data-panel=plugin-RawMessage]").count() == 1)
    tab.wait_for(lambda: "Choose a topic." in tab.text())
    field.drag_to(here)
    tab.wait_for_command(SetPanelProperty(raw, "path", "/cmd.linear.x"))
    assert panel(viewer, 1).path == "/cmd.linear.x"

    topic.drag_to(tab.page.locator("canvas[data-engine]"), target_position={"x": 400, "y": 150})
    tab.wait_for(lambda: len(viewer.rows) == 1)
    assert viewer.values("topic.name") == ["/cmd"]


def test_a_docked_plot_leaves_its_height_to_the_curves(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    size = tab.page.viewport_size
    assert size is not None
    tab.page.set_viewport_size({"width": 960, "height": 720})
    show(viewer, tab, *FIELDS)
    publish(viewer, 0.5)
    frame = tab.page.locator(".wv-docked")
    tab.wait_for(lambda: (frame.bounding_box() or {}).get("width") == 640)
    assert (frame.bounding_box() or {})["height"] <= 240
    area = """async (canvas) => {
      const { inside } = await import("webviz/charts/draw.js");
      return inside(canvas.clientWidth, canvas.clientHeight).height;
    }"""
    assert tab.page.locator(".wv-chart-canvas").evaluate(area) >= 180
    entries = [each.bounding_box() for each in tab.page.locator(".wv-chart-entry").all()]
    assert len({each["y"] for each in entries if each}) == 1, "the legend is one line"
    value = tab.page.locator(".wv-chart-value").first
    width = "(value, text) => { value.textContent = text; return value.offsetWidth; }"
    assert len({value.evaluate(width, text) for text in ("0 m/s", "-0.12345 rad/s")}) == 1
    tab.page.set_viewport_size(size)
