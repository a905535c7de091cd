"""Panels of plug-ins, which record widgets that pages draw."""

from __future__ import annotations

import logging
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, ClassVar

import pytest
from pages import bounds
from playwright.sync_api import expect

from tests.page.opened_panels import open_panel
from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.api import registry
from webviz.api.declared import Prop, Topic, make
from webviz.api.panel import Panel, Send, Slide, Ui
from webviz.commands import AddPanel, InspectTopic, RemovePanel, Reset, SetPanelProperty
from webviz.engine.pipeline.plugins import load
from webviz.engine.state import State
from webviz.features.panels import MAX_WAITING
from webviz.page.recorded_ui import RecordedUi
from webviz.page.widgets import MAX_HTML, MAX_LINES
from webviz_displays.laser_scan import LaserScan

EXAMPLE = Path(__file__).parents[2] / "displays/docs/examples/quiet_topics.py"
HOSTILE = "<img src=x onerror=alert(1)>"


class Frames(Panel):
    """The frames in a table."""

    def build(self, ui: Ui, send: Send) -> None:
        ui.button("Forget all", lambda browser: send(Reset(), browser), "All of it", width=0.5)
        ui.button("Break", lambda browser: 1 / 0, width=0.5)
        ui.command("Forget frames", lambda browser: send(Reset(), browser), "j")
        self.table = ui.area()

    def show(self, state: State) -> None:
        self.table.table([(frame, str(len(frame))) for frame in state.frames])


class Form(Panel):
    """A widget of each kind."""

    entered: ClassVar[list[Any]] = []

    def build(self, ui: Ui, send: Send) -> None:
        def note(value: Any, browser: int | None) -> None:
            self.entered.append(value)

        self.text = ui.area()
        self.lines = ui.area()
        self.html = ui.area()
        self.live = ui.checkbox("Live", False, note)
        self.robot = ui.field("Name", "robot", note, "Of the robot")
        self.color = ui.choice("Color", "red", note)
        self.color.offer(["red", "green", ""], "red")
        self.pause = ui.button("Pause", lambda browser: None)
        self.sliders = ui.sliders(lambda name, value, browser: note((name, value), browser))

    def show(self, state: State) -> None:
        self.text.text(f"a text {HOSTILE}")
        self.lines.lines("one\n  two")
        self.html.html("<b id='bold'>bold</b>")
        self.pause.label = "Resume" if "arm" in state.frames else "Pause"
        self.sliders.show([Slide("left hip", 0.25, -1.0, 1.0, "rad"), Slide("rail", 2.0, 0.0, 4.0)])
        if "arm" in state.frames:
            self.robot.show("arm")


class Limited(Panel):
    """A panel with a property."""

    most: Annotated[int, Prop(ge=1, help="Lines.")] = 3

    def build(self, ui: Ui, send: Send) -> None:
        self.text = ui.area()
        self.text.text("limited")


class Moody(Panel):
    """A panel that fails until the frame of an arm is known."""

    def build(self, ui: Ui, send: Send) -> None:
        ui.button("Half", lambda browser: None, width=0.5)
        ui.button("Other half", lambda browser: None, width=0.5)

    def show(self, state: State) -> None:
        if "arm" not in state.frames:
            raise ValueError("no arm, sorry")


class Unbuilt(Panel):
    """A panel that cannot be built."""

    def build(self, ui: Ui, send: Send) -> None:
        raise SystemExit("not today")


class Slow(Panel):
    """A panel whose button takes its time."""

    go_on: ClassVar[threading.Event] = threading.Event()

    def build(self, ui: Ui, send: Send) -> None:
        ui.button("Wait", lambda browser: self.go_on.wait(30))


@pytest.fixture(autouse=True)
def _types(viewer_tab: ViewerTab) -> Iterator[None]:
    types = Frames, Form, Limited, Moody, Unbuilt, Slow
    registry.register("tests", {each.__name__: each for each in types})
    yield
    registry.register("tests", {})
    viewer_tab.viewer.show()
    viewer_tab.show_tab("Displays")


def titles(tab: ViewerTab) -> list[str]:
    """The titles of the tabs that are shown."""
    return [each for each in tab.page.get_by_role("tab").all_inner_texts() if each]


def logged(caplog: pytest.LogCaptureFixture) -> list[str]:
    """The first line of each warning."""
    return [
        each.message.partition("\n")[0] for each in caplog.records if each.levelno > logging.INFO
    ]


def test_a_panel_of_a_plug_in_has_a_tab_behind_those_of_webviz(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    viewer.link("map", HOSTILE)
    viewer.show()
    tab.wait_for(lambda: titles(tab)[-1:] == ["Tools"])
    before = titles(tab)
    open_panel(tab, make(Frames, {}))
    assert titles(tab) == [*before, "Frames"]
    tab.wait_for(lambda: HOSTILE in tab.text())
    assert tab.button("Forget all").get_attribute("data-tip") == "All of it"
    assert not tab.button("Settings of this panel").is_visible(), "it has none"
    tab.button("Forget all").click()
    tab.wait_for_command(Reset())
    assert viewer.senders[-1].browser == tab.browser
    viewer.show()
    tab.wait_for(lambda: titles(tab) == before)
    assert tab.page.locator("[role=tab][aria-selected=true]").count() == 1


def test_every_kind_of_widget_is_drawn_and_heard(viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    Form.entered.clear()
    open_panel(tab, make(Form, {}))
    tab.wait_for(lambda: f"a text {HOSTILE}" in tab.text())
    assert tab.page.locator("pre").inner_text() == "one\n  two"
    assert tab.page.locator("#bold").inner_text() == "bold"
    tab.page.get_by_label("Live", exact=True).check()
    tab.wait_for(lambda: Form.entered == [True])
    name = tab.page.get_by_label("Name", exact=True)
    assert name.input_value() == "robot"
    name.fill("turtle")
    tab.wait_for(lambda: Form.entered == [True, "turtle"])
    color = tab.page.get_by_role("combobox", name="Color")
    color.click()
    tab.page.get_by_role("option", name="green").click()
    tab.wait_for(lambda: Form.entered == [True, "turtle", "green"])
    hip = tab.page.get_by_role("slider", name="left hip")
    assert hip.input_value() == "0.25"
    hip.fill("-0.5")
    tab.wait_for(lambda: Form.entered[-1] == ("left hip", -0.5))
    rail = tab.page.get_by_role("spinbutton", name="rail, as a number")
    rail.fill("3")
    rail.press("Enter")
    tab.wait_for(lambda: Form.entered[-1] == ("rail", 3.0))


def test_typed_text_stays_while_the_panel_shows_something_else(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    open_panel(tab, make(Form, {}))
    name = tab.page.get_by_label("Name", exact=True)
    name.click()
    name.press("End")
    name.press("x")
    viewer.link("map", "arm")
    tab.wait_for(lambda: tab.page.get_by_text("Resume", exact=True).count() > 0)
    assert name.input_value() == "robotx"
    name.blur()
    tab.wait_for(lambda: name.input_value() == "arm")


def test_panels_are_added_and_removed_and_their_properties_edited(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    panel = open_panel(tab, make(Limited, {}))
    (panel_tab,) = viewer.states[-1].panels
    settings = tab.button("Settings of this panel")
    settings.click()
    most = tab.page.get_by_role("spinbutton", name="Most")
    expect(most).to_be_focused()
    most.fill("7")
    most.press("Enter")
    tab.wait_for_command(SetPanelProperty(panel_tab.id, "most", 7))
    assert panel.most == 7
    most.press("Escape")
    expect(most).to_have_count(0)
    expect(settings).to_be_focused()
    tab.button("More for this panel").click()
    tab.page.get_by_role("menuitem", name="Remove panel").click()
    tab.wait_for_command(RemovePanel(panel_tab.id))
    assert viewer.states[-1].panels == ()
    viewer.show(panels=[make(Limited, {}), make(Limited, {})])
    tab.wait_for(lambda: titles(tab).count("Limited") == 2)
    tab.button("Add a panel").click()
    element = tab.page.get_by_role("dialog", name="Add panel").get_by_role("option")
    offers = element.locator(".wv-pick-title").all_inner_texts()
    assert offers == sorted(offers, key=str.casefold)
    plot = element.filter(has_text="Numbers of any messages over time")
    assert plot.locator(".wv-pick-note").inner_text() == "Below the scene"
    tab.page.keyboard.type("nav")
    assert element.first.locator(".wv-pick-note").inner_text() == "In the side bar"
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(AddPanel("Nav2"))
    title = viewer.states[-1].panels[-1].panel.name
    added = tab.page.get_by_role("tab", name=title, exact=True)
    tab.wait_for(lambda: added.get_attribute("aria-selected") == "true")


def test_a_click_elsewhere_closes_the_settings_of_a_panel(viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    open_panel(tab, make(Limited, {}))
    settings, most = tab.button("Settings of this panel"), tab.page.get_by_text("Most", exact=True)
    for close in (settings, tab.page.get_by_role("tab", name="Limited")):
        settings.click()
        expect(most).to_be_visible()
        close.click()
        expect(most).to_have_count(0)


def test_tabs_that_are_too_many_leave_the_open_one_and_the_button_in_sight(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    viewer.show(panels=[make(Limited, {}) for _ in range(6)])
    tab.wait_for(lambda: titles(tab).count("Limited") == 6)
    for tab_button in (tab.page.get_by_role("tab").last, tab.page.get_by_role("tab").first):
        tab.button("All panels").click()
        name = tab_button.inner_text()
        entries = tab.page.get_by_role("menuitemradio", name=name)
        (entries.last if name == "Limited" else entries.first).click()
        expect(tab_button).to_have_attribute("aria-selected", "true")
        expect(tab_button).to_be_in_viewport(ratio=1)
        box, add = bounds(tab_button), bounds(tab.button("Add a panel"))
        assert box["x"] + box["width"] <= add["x"]
        assert add["x"] + add["width"] <= 320


def test_the_list_of_commands_opens_and_adds_panels(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    open_panel(tab, make(Limited, {}))
    for words in ("panel topics", "panel limited"):
        tab.page.keyboard.press("Control+k")
        tab.page.get_by_role("combobox", name="Command").fill(words)
        tab.page.keyboard.press("Enter")
        tab_button = tab.page.get_by_role("tab", name=words.removeprefix("panel ").title())
        tab.wait_for(
            lambda tab_button=tab_button: tab_button.get_attribute("aria-selected") == "true"
        )
    tab.page.keyboard.press("Control+k")
    tab.page.get_by_role("combobox", name="Command").fill("add panel navigation")
    tab.page.keyboard.press("Enter")
    tab.wait_for_command(AddPanel("Nav2"))
    assert len(viewer.states[-1].panels) == 2


def test_a_button_that_fails_says_so_in_the_browser(
    viewer_tab: ViewerTab, caplog: pytest.LogCaptureFixture
) -> None:
    tab = viewer_tab
    open_panel(tab, make(Frames, {}))
    tab.button("Break").click()
    sentence = "The panel Frames failed: ZeroDivisionError: division by zero"
    tab.wait_for(lambda: sentence in tab.text())
    assert logged(caplog) == [sentence]


def test_a_panel_that_fails_says_so_in_its_tab_and_harms_no_other(
    page_server: PageServer, viewer_tab: ViewerTab, caplog: pytest.LogCaptureFixture
) -> None:
    tab = viewer_tab
    viewer = page_server.begin(strict=False)
    caplog.clear()  # it began with a panel of each type
    viewer.show(panels=[make(Moody, {}), make(Unbuilt, {})])
    unbuilt, moody = (
        "The panel Unbuilt failed: SystemExit: not today",
        "The panel Moody failed: ValueError: no arm, sorry",
    )
    tab.wait_for(lambda: "Unbuilt" in titles(tab))
    tab.show_tab("Unbuilt")
    tab.wait_for(lambda: unbuilt in tab.text())
    tab.show_tab("Moody")
    tab.wait_for(lambda: moody in tab.text())
    assert logged(caplog) == [unbuilt, moody]
    note, half, other = (
        tab.page.get_by_text(text, exact=True).bounding_box() or {}
        for text in (moody, "Half", "Other half")
    )
    assert note["y"] < half["y"] == other["y"], "the sentence is on top, the rest as it was"
    viewer.link("map", "arm")
    tab.wait_for(lambda: moody not in tab.text())


def test_a_button_that_takes_long_holds_up_nobody_else(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    Slow.go_on.clear()
    try:
        viewer.show(panels=[make(Slow, {}), make(Frames, {})])
        tab.wait_for(lambda: "Slow" in titles(tab))
        tab.show_tab("Slow")
        tab.wait_for(lambda: tab.button("Wait").count() > 0)
        for _ in range(MAX_WAITING + 2):
            tab.button("Wait").click()
        tab.wait_for(lambda: "Failed: the panel Slow is busy." in tab.text())
        tab.show_tab("Frames")
        tab.wait_for(lambda: tab.button("Forget all").count() > 0)
        tab.button("Forget all").click()
        tab.wait_for_command(Reset())
    finally:
        Slow.go_on.set()


def test_a_command_of_a_panel_has_a_key_and_stands_in_the_list(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    open_panel(tab, make(Frames, {}))
    tab.wait_for(lambda: "Forget all" in tab.text())
    tab.page.keyboard.press("Control+k")
    tab.page.get_by_role("dialog").get_by_text("Forget frames").click()
    tab.wait_for_command(Reset())
    viewer.forget_commands()
    tab.page.keyboard.press("j")
    tab.wait_for_command(Reset())


def test_unchanged_widgets_are_not_sent_again(viewer_tab: ViewerTab) -> None:
    tab = viewer_tab
    open_panel(tab, make(Frames, {}))
    tab.wait_for(lambda: tab.page.locator("td").count() == 4)
    tab.page.evaluate(
        "window.changes = 0; new MutationObserver(() => { changes += 1 }).observe("
        "document.querySelector('.wv-plugin'), {subtree: true, childList: true, attributes: true})"
    )
    for _ in range(5):
        tab.turn()
    assert tab.page.evaluate("changes") == 0


def test_the_example_of_the_docs_works_from_its_file(
    viewer: PageBench, viewer_tab: ViewerTab
) -> None:
    tab = viewer_tab
    types = load(EXAMPLE)
    displays = [LaserScan(name=name, topic=Topic(name)) for name in ("/scan", "/busy")]
    try:
        viewer.offer("/scan", "sensor_msgs/msg/LaserScan", "/driver")
        viewer.show(*displays, panels=[make(types["QuietTopics"], {})])
        viewer.stream_scans("/busy", 10.0)
        tab.wait_for(lambda: "Quiet topics" in titles(tab))
        tab.show_tab("Quiet topics")
        side = tab.page.locator(".wv-plugin")
        tab.wait_for(lambda: "/scan\tno messages" in side.inner_text())
        assert "/busy" not in side.inner_text()
        tab.button("Stop inspecting topics").click()
        tab.wait_for_command(InspectTopic(""))
        again = load(EXAMPLE)  # after a save: the same tab, of the new class
        viewer.show(panels=[make(again["QuietTopics"], {})])
        tab.wait_for(lambda: "/scan" not in side.inner_text())
        assert "/tf_static\tno messages" in side.inner_text()
    finally:
        registry.register(str(EXAMPLE), {})


def test_what_is_endless_is_cut() -> None:
    area = RecordedUi().area()
    area.lines("\n".join(f"line {i}" for i in range(MAX_LINES + 7)))
    assert area.values["lines"][-1] == "… and 7 more lines"
    area.table([("x" * 100_000,)] * (MAX_LINES + 7))
    assert len(area.values["table"]) == MAX_LINES
    assert len(area.values["table"][0][0]) <= 1000
    with pytest.raises(ValueError, match="the limit is"):
        area.html("x" * (MAX_HTML + 1))
    area.text("half a character \ud800")
    assert area.values["text"].isprintable()


@pytest.mark.parametrize("value", [None, True, 3, "x" * 100_000])
def test_a_value_that_does_not_fit_is_refused(value: Any) -> None:
    ui = RecordedUi()
    field = ui.field("Name", "a", lambda *_: None)
    choice = ui.choice("Color", "red", lambda *_: None)
    for widget in (field, choice, ui.area()):
        with pytest.raises(ValueError, match=r"fit|characters|available|input"):
            widget.use(value, 1)
