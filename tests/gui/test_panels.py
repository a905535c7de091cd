"""Panels of anybody, beside those that come with webviz."""

from __future__ import annotations

import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from webviz.api import registry
from webviz.api.panel import Panel, Send, Ui
from webviz.api.registry import plugin_types
from webviz.engine.commands import InspectTopic, Reset
from webviz.engine.plugins import load
from webviz.engine.state import State, Traffic

EXAMPLE = Path(__file__).parents[2] / "displays/docs/examples/quiet_topics.py"
TABS = ["Displays", "Views", "Time", "TF tree", "Topics"]
HOSTILE = "<img src=x onerror=alert(1)>"


class Frames(Panel):
    """The frames in a table."""

    def build(self, ui: Ui, send: Send) -> None:
        ui.button("Forget all", lambda browser: send(Reset(), browser), width=0.5)
        ui.button("Break", lambda browser: 1 / 0, width=0.5)
        self.table = ui.area()

    def show(self, state: State) -> None:
        self.table.table([(frame, str(len(frame))) for frame in state.frames])


class Moody(Panel):
    """A panel that fails until there are frames."""

    def build(self, ui: Ui, send: Send) -> None:
        ui.button("Half", lambda browser: None, width=0.5)
        ui.button("Other half", lambda browser: None, width=0.5)

    def show(self, state: State) -> None:
        if not state.frames:
            raise ValueError("no frames, sorry")


class Unbuilt(Panel):
    """A panel that cannot be built."""

    def build(self, ui: Ui, send: Send) -> None:
        raise SystemExit("not today")


@pytest.fixture(autouse=True)
def _register() -> Iterator[None]:
    yield
    registry.register("tests", {})


def tabs(tab: Any) -> list[str]:
    """The titles of the tabs."""
    return tab.page.get_by_role("tab").all_inner_texts()


def test_a_panel_of_a_plug_in_has_a_tab_behind_those_of_webviz(loop: Any, tab: Any) -> None:
    loop.show(frames=("map", HOSTILE))
    assert tabs(tab) == TABS
    registry.register("tests", {"Frames": Frames})
    tab.wait_for(lambda: loop.turn() or tabs(tab) == [*TABS, "Frames"])
    tab.show_tab("Frames")
    tab.wait_for(lambda: loop.turn() or HOSTILE in tab.text())
    tab.click("Forget all")
    assert loop.commands == [Reset()]
    registry.register("tests", {})
    tab.wait_for(lambda: loop.turn() or tabs(tab) == TABS)


def test_a_button_that_fails_says_so_in_the_browser(
    loop: Any, tab: Any, caplog: pytest.LogCaptureFixture
) -> None:
    registry.register("tests", {"Frames": Frames})
    loop.show()
    tab.show_tab("Frames")
    tab.page.get_by_role("button", name="Break", exact=True).click()
    sentence = "The panel Frames failed: ZeroDivisionError: division by zero"
    tab.wait_for(lambda: loop.turn() or sentence in tab.text())
    assert [record.message for record in caplog.records] == [sentence]


def test_a_panel_that_fails_says_so_in_its_tab_and_harms_no_other(
    loop: Any, tab: Any, caplog: pytest.LogCaptureFixture
) -> None:
    registry.register("tests", {"Moody": Moody, "Unbuilt": Unbuilt})
    with caplog.at_level(logging.WARNING):
        loop.show()
        loop.turn()
    unbuilt, moody = (
        "The panel Unbuilt failed: SystemExit: not today",
        "The panel Moody failed: ValueError: no frames, sorry",
    )
    assert sorted(record.message.partition("\n")[0] for record in caplog.records) == [
        moody,
        unbuilt,
    ]
    tab.show_tab("Unbuilt")
    tab.wait_for(lambda: unbuilt in tab.text())
    tab.show_tab("Moody")
    tab.wait_for(lambda: moody in tab.text())
    note, half, other = (
        tab.page.get_by_text(text, exact=True).bounding_box()
        for text in (moody, "Half", "Other half")
    )
    assert note["y"] < half["y"] == other["y"], "the sentence is on top, the rest as it was"
    loop.show(frames=("map",))
    tab.wait_for(lambda: moody not in tab.text())
    tab.show_tab("Time")
    tab.wait_for(lambda: loop.turn() or "ROS Elapsed" in tab.text())


def test_the_example_of_the_docs_works_from_its_file(loop: Any, tab: Any) -> None:
    types = load(EXAMPLE)
    try:
        loop.show(traffic={"/scan": Traffic(0.0, 0.0), "/map": Traffic(2.0, 10.0)})
        tab.show_tab("Quiet topics")
        tab.wait_for(lambda: "no messages" in tab.text())
        assert "/scan" in tab.text()
        assert "/map" not in tab.text()
        tab.click("Look into none")
        assert loop.commands == [InspectTopic("")]
        load(EXAMPLE)  # after a save: the same tab, of the new class
        loop.show(traffic={})
        assert plugin_types(Panel)["QuietTopics"] is not types["QuietTopics"]
        tab.show_tab("Quiet topics")
        tab.wait_for(lambda: loop.turn() or "has messages" in tab.text())
    finally:
        registry.register(str(EXAMPLE), {})
