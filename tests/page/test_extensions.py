"""Modules of plug-ins in the page: gestures, widgets and overlays, as in the examples."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import playwright.sync_api as playwright
import pytest
from pages import bounds

from tests.page.everything import named
from tests.page.opened_panels import open_panel
from tests.page.page_bench import PageBench
from tests.page.tabs import ViewerTab
from webviz.api import registry
from webviz.api.declared import make
from webviz.api.panel import Panel
from webviz.api.tool import Tool
from webviz.commands import UseTool
from webviz.engine.pipeline.plugins import PluginError, load
from webviz.page.widgets import MAX_HTML, MAX_TEXT, CustomWidget

EXAMPLES = Path(__file__).parents[2] / "displays/docs/examples"

BATTERY = "sensor_msgs/msg/BatteryState"

DRAW = """async () => {
  const { afterRender, requestRender } = await import("webviz/viser_page.js");
  await new Promise((resolve) => (afterRender(resolve), requestRender()));
}"""
"""Returns when the scene was drawn once more."""


class Sketch(Tool):
    """Draw an area."""

    title = "Sketch"
    gesture = "outline"


class Keep(Tool):
    """Draw an area."""

    title = "Keep"
    gesture = "keep"


@pytest.fixture(autouse=True)
def _forget(viewer: PageBench, viewer_tab: ViewerTab) -> Iterator[None]:
    yield
    for path in EXAMPLES.glob("*.py"):
        registry.register(str(path), {})
    viewer_tab.page.keyboard.press("Escape")
    viewer.show()
    viewer_tab.show_tab("Displays")


def test_a_tool_has_a_gesture_of_its_module(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    viewer.show(tools=[Sketch(name="Sketch")])
    sketch = tab.button("Sketch")
    tab.wait_for(lambda: "is unknown" in str(sketch.get_attribute("data-tip")))
    playwright.expect(sketch).to_be_disabled()
    tool = make(load(EXAMPLES / "keep_out.py")["KeepOut"], {})
    assert isinstance(tool, Tool)
    tab.wait_for(lambda: sketch.get_attribute("aria-disabled") is None)
    viewer.show(tools=[tool])
    viewer.viewer.context.graph.allow("/keep_out")
    keep_out = tab.button("Keep Out")
    tab.wait_for(lambda: keep_out.count() and keep_out.get_attribute("aria-disabled") is None)
    assert keep_out.locator("path").get_attribute("d") == tool.icon
    keep_out.click()
    box = bounds(tab.page.locator("canvas").first)
    x, y = box["x"] + 150, box["y"] + box["height"] - 80
    tab.page.mouse.move(x, y)
    tab.page.mouse.down()
    for dx, dy in ((60, 0), (60, 40), (0, 40)):
        tab.page.mouse.move(x + dx, y + dy)
    line = tab.page.locator("[data-webviz=keep-out] polyline")
    playwright.expect(line).to_have_attribute("points", re.compile(r"^\S+ \S+ \S+ \S+$"))
    tab.page.mouse.up()
    tab.wait_for(lambda: isinstance(next(iter(viewer.commands[-1:]), None), UseTool))
    command = viewer.commands[-1]
    assert isinstance(command, UseTool)
    assert command.tool == viewer.states[-1].tools[0].id
    assert len(command.points) == 4
    assert {point[2] for point in command.points} == {0.0}
    assert len(set(command.points)) == 4
    ((topic, message),) = viewer.published()
    assert topic == "/keep_out"
    assert message.polygon.points == pytest.approx(np.array(command.points), abs=1e-5)


def battery_dial() -> Panel:
    panel = make(load(EXAMPLES / "battery_dial.py")["BatteryDial"], {})
    assert isinstance(panel, Panel)
    return panel


def test_a_panel_has_a_widget_of_its_module(viewer: PageBench, viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    viewer.offer("/battery_state", BATTERY, "/battery")
    panel: Any = open_panel(tab, battery_dial())
    tab.wait_for(lambda: "0 %, warns below 20 %" in tab.text())
    bar = tab.page.get_by_role("meter")
    width = bar.evaluate("each => each.getBoundingClientRect().width")
    bar.click(position={"x": width / 2, "y": 3})
    tab.wait_for(lambda: re.search("warns below (49|50|51) %", tab.text()))
    assert panel.limit == pytest.approx(0.5, abs=0.02)
    viewer.publish("/battery_state", BATTERY, {"percentage": 0.8})
    tab.wait_for(lambda: "80 %, warns below" in tab.text())


def test_a_display_has_an_overlay_of_its_module(viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    load(EXAMPLES / "compass.py")
    heading = tab.page.locator("[title='Heading of the camera']")
    tab.wait_for(lambda: heading.count() == 1 and heading.inner_text().endswith("°"))
    assert 0 <= int(heading.inner_text()[:-1]) < 360


def test_a_module_that_fails_is_reported_and_the_page_goes_on(
    viewer_tab: ViewerTab, tmp_path: Path
) -> None:
    tab = viewer_tab
    path = tmp_path / "broken.py"
    path.write_text(
        "from webviz import Display\nclass Broken(Display):\n    module = 'broken.js'\n"
    )
    with pytest.raises(PluginError, match=r"cannot read its module .*broken\.js: No such file"):
        load(path)
    (tmp_path / "broken.js").write_text("export default () => { throw new Error('no luck') }")
    load(path)
    try:
        tab.wait_for(
            lambda: "The module of the display Broken failed: Error: no luck" in tab.text()
        )
    finally:
        registry.register(str(path), {})


def test_a_module_that_is_too_large_with_those_that_it_imports_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "large.py"
    path.write_text("from webviz import Display\nclass Large(Display):\n    module = 'large.js'\n")
    (tmp_path / "large.js").write_text('import "./more.js";'.ljust(600_000))
    (tmp_path / "more.js").write_text(" " * 400_001)
    with pytest.raises(PluginError, match=r"its module .*large\.js has more than 1 MB"):
        load(path)
    (tmp_path / "more.js").write_text(" " * 400_000)
    load(path)
    registry.register(str(path), {})


def test_a_module_imports_others_beside_it(viewer_tab: ViewerTab, tmp_path: Path) -> None:
    tab = viewer_tab
    path = tmp_path / "split.py"
    path.write_text("from webviz import Display\nclass Split(Display):\n    module = 'split.js'\n")
    for name, text in {
        "split.js": "import { told } from './told.js';\nimport {\n  once,\n} from \"./once.js\";\n"
        "export default ({ toast }) => toast(told + once.size);",
        "told.js": 'import { once } from "./once.js";\nonce.add(1);\nexport const told = "Told ";',
        "once.js": "export const once = new Set();",
    }.items():
        (tmp_path / name).write_text(text)
    load(path)
    try:
        tab.wait_for(lambda: "Told 1" in tab.text())
    finally:
        registry.register(str(path), {})
    (tmp_path / "once.js").write_text('import "./told.js";')
    with pytest.raises(PluginError, match=r"its module .*told\.js imports itself"):
        load(path)
    (tmp_path / "once.js").unlink()
    with pytest.raises(PluginError, match=r"cannot read its module .*once\.js: No such file"):
        load(path)


MEMBERS = """\
import {
  el,
} from 'webviz/dom.js';
import { rowList } from "webviz/controls/rows.js";
export default (page) => {
  const isSame = page.el === el && page.rowList === rowList;
  page.toast(`${Object.keys(page).length} members, ${isSame ? "the same" : "others"}`);
};
"""


def test_a_module_imports_those_of_the_page(viewer_tab: ViewerTab, tmp_path: Path) -> None:
    tab = viewer_tab
    path = tmp_path / "members.py"
    path.write_text("from webviz import Display\nclass Members(Display):\n    module = 'm.js'\n")
    (tmp_path / "m.js").write_text(MEMBERS)
    load(path)
    try:
        tab.wait_for(lambda: "42 members, the same" in tab.text())
    finally:
        registry.register(str(path), {})


@pytest.mark.parametrize("value", [object(), float("nan"), "x" * MAX_HTML])
def test_values_of_a_widget_are_json_of_limited_size(value: object) -> None:
    with pytest.raises(ValueError, match="JSON"):
        CustomWidget("dial", {"value": value}, lambda value, browser: None)


@pytest.mark.parametrize("content", [None, True, "{", "[" * 5000, "1" * (MAX_TEXT + 1)])
def test_what_a_page_sends_of_a_widget_is_json_of_limited_size(content: object) -> None:
    entered: list[object] = []
    widget = CustomWidget("dial", {}, lambda value, browser: entered.append(value))
    with pytest.raises(ValueError, match="JSON"):
        widget.use(content, 1)
    assert entered == []
    widget.use('{"share": 0.5}', 1)
    assert entered == [{"share": 0.5}]


FAULTS = """\
import "./log.js";
export default ({ beforeRender, el, gesture, panel, style, toast, watch, widget }) => {
  const fail = (where) => { throw new Error(`no luck in ${where}`); };
  beforeRender(() => fail("render"));
  gesture("keep", () => fail("gesture"));
  watch("panels", () => fail("watch"));
  style("mine", "}}} * { colr");
  for (const title of ["Once", "Twice"])
    panel({ name: "fails", title, open: () => fail("open") });
  panel({ name: "answers", title: "Answers", open: (element) => (element.textContent = "fine") });
  for (const wrong of [() => panel({}), () => watch("tree"), () => beforeRender(0)])
    try { wrong(); } catch (error) { log.push(String(error)); }
  widget("dial", () => fail("widget"));
  toast("Started");
  throw Symbol("the end");
};
"""


def test_code_of_a_plug_in_that_throws_anywhere_stops_nothing_else(
    viewer: PageBench,
    viewer_tab: ViewerTab,
    open_viewer_tab: Callable[..., ViewerTab],
    tmp_path: Path,
) -> None:
    tab = open_viewer_tab()
    path = tmp_path / "faulty.py"
    path.write_text(
        "from webviz import Display\nclass Faulty(Display):\n    module = 'faulty.js'\n"
    )
    (tmp_path / "log.js").write_text("globalThis.log = [];")
    (tmp_path / "faulty.js").write_text(FAULTS)
    dial = battery_dial()
    viewer.show(*named("before"), tools=[Keep(name="Keep Out")])
    tab.wait_for(lambda: "before" in tab.text())
    load(path)
    try:
        tab.wait_for(lambda: tab.page.get_by_role("tab", name="Twice").count() == 1)
        assert tab.page.get_by_role("tab", name="Once").count() == 0
        assert tab.page.evaluate("log.length") == 3
        for title in ("Twice", "Answers", "Twice", "Displays"):
            tab.show_tab(title)
        tab.page.evaluate(DRAW)
        viewer.show(*named("after"), tools=[Keep(name="Keep Out")], panels=[dial])
        tab.wait_for(lambda: "after" in tab.text())
        tab.wait_for(lambda: tab.button("Keep Out").count())
        tab.show_tab("Battery")
        tab.wait_for(lambda: "This widget failed." in tab.text())
        assert "The module of the display Faulty failed: " in tab.text()
    finally:
        for each in (path, EXAMPLES / "battery_dial.py"):
            registry.register(str(each), {})
        viewer.show()
        viewer_tab.page.reload()  # its panels stay
        viewer_tab.wait_for(lambda: viewer_tab.page.get_by_role("tab", name="Tools").count())
