"""Fields of messages that are added to panels in a popover and by dragging, and room for curves."""

from __future__ import annotations

from collections.abc import Iterator

import pytest
from playwright.sync_api import expect

from tests.page.conftest import Loop, Tab
from webviz.commands import AddDisplay, SetPanelProperty
from webviz.data.messages import decode, encode, to_tree
from webviz.engine.state import Inspected, PanelTab, PanelTimes
from webviz.files.config import DockedPanel, Layout, Settings
from webviz.panels.plot import Plot
from webviz.panels.raw import RawMessage
from webviz.sources import Offer, Publisher

TWIST = "geometry_msgs/msg/Twist"
SECOND = 10**9
FIELDS = ["/cmd.linear.x", "/cmd.angular.z"]
BELOW = Settings(layout=Layout(below=(DockedPanel(panel="Plot", tabs=("RawMessage",)),)))


@pytest.fixture(autouse=True)
def _close(loop: Loop, tab: Tab) -> Iterator[None]:
    yield
    loop.show(panels=(), offers={}, inspected={}, settings=Settings())
    tab.wait_for(lambda: tab.page.locator(".wv-docked").count() == 0)
    tab.show_tab("Displays")


def show(loop: Loop, tab: Tab, plot: Plot) -> None:
    """A plot below the scene, with a topic that has one message."""
    message = decode(TWIST, encode(TWIST, {"linear": {"x": 0.5}}))
    raw = PanelTab("raw", "RawMessage", RawMessage(name="Raw"))
    loop.show(
        panels=(PanelTab("plot", "Plot", plot), raw),
        offers={"/cmd": Offer((Publisher("/robot", TWIST, "reliable", "volatile"),))},
        inspected={"/cmd": Inspected(TWIST, to_tree(message), "", 48, 1.0)},
        clock=PanelTimes(ros_ns=100 * SECOND),
        settings=BELOW,
    )
    front = tab.page.locator(".wv-docked [role=tab][data-tab=Plot]")
    tab.wait_for(lambda: front.count() == 1)
    front.click()
    tab.wait_for(lambda: tab.page.locator("[data-panel=plugin-Plot]").count() == 1)
    if plot.curves:
        tab.wait_for(lambda: tab.page.locator(".wv-chart-entry").count() == len(plot.curves))
    plot.take("/cmd", message, 90 * SECOND)


def test_a_field_is_added_in_a_popover_by_keys(loop: Loop, tab: Tab) -> None:
    plot = Plot(name="Plot")
    show(loop, tab, plot)
    tab.wait_for(lambda: "Add a field with +" in tab.text())
    tab.button("Add a field").click()
    topic = tab.page.get_by_role("combobox", name="Topic", exact=True)
    expect(topic).to_be_focused()
    topic.fill("/cmd")
    topic.press("Enter")
    tab.wait_for(lambda: plot.chooser.topic == "/cmd")
    tab.wait_for(lambda: "/cmd" in plot.subscriptions())
    plot.take("/cmd", decode(TWIST, encode(TWIST, {})), 91 * SECOND)
    fields = tab.page.get_by_role("listbox", name="Fields").get_by_role("option")
    tab.wait_for(lambda: fields.count() == 6)
    expect(tab.page.get_by_role("combobox", name="Field", exact=True)).to_be_focused()
    tab.page.keyboard.type("ang z")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(SetPanelProperty("plot", "curves", ["/cmd.angular.z"]))
    tab.page.keyboard.press("Escape")
    expect(fields).to_have_count(0)
    expect(tab.button("Add a field")).to_be_focused()


def test_topics_and_fields_are_dragged_onto_panels_and_the_scene(loop: Loop, tab: Tab) -> None:
    plot = Plot(name="Plot")
    show(loop, tab, plot)
    tab.show_tab("Topics")
    topic = tab.page.locator(".wv-topic")
    tab.wait_for(lambda: topic.count() == 1)
    here = tab.page.locator(".wv-docked .wv-plugin")
    topic.drag_to(here)
    tab.wait_for(lambda: plot.chooser.topic == "/cmd")
    expect(tab.page.get_by_role("dialog", name="Add a field")).to_be_visible()
    tab.page.keyboard.press("Escape")

    topic.click()
    field = tab.page.locator(".wv-field-row").filter(has_text="x0.5")
    tab.wait_for(lambda: field.count() == 1)
    field.drag_to(here)
    tab.wait_for_command(SetPanelProperty("plot", "curves", ["/cmd.linear.x"]))
    tab.page.get_by_role("tab", name="Raw").click()
    tab.wait_for(lambda: tab.page.locator("[data-panel=plugin-RawMessage]").count() == 1)
    tab.wait_for(lambda: "Choose a topic." in tab.text())
    field.drag_to(here)
    tab.wait_for_command(SetPanelProperty("raw", "path", "/cmd.linear.x"))

    topic.drag_to(tab.page.locator("canvas[data-engine]"), target_position={"x": 400, "y": 150})
    tab.wait_for(lambda: isinstance(loop.commands[-1], AddDisplay))


def test_a_docked_plot_leaves_its_height_to_the_curves(loop: Loop, tab: Tab) -> None:
    size = tab.page.viewport_size
    assert size is not None
    tab.page.set_viewport_size({"width": 960, "height": 720})
    show(loop, tab, Plot(name="Plot", curves=FIELDS))
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
