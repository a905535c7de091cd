"""The bar with the time."""

from __future__ import annotations

import re
import time
from collections.abc import Callable

import pytest
from playwright.sync_api import expect

from tests.page.page_bench import PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.commands import Pause, Reset
from webviz.engine.parts.time import TimePart
from webviz.engine.state import PanelTimes
from webviz.files.config.model import MemorySettings
from webviz.shell.testing import SECOND

CHANGES = """() => {
  window.changes = 0;
  window.countingSince = performance.now();
  window.counting?.disconnect();
  window.counting = new MutationObserver(() => { window.changes += 1; });
  const everything = { subtree: true, childList: true, characterData: true, attributes: true };
  window.counting.observe(document.querySelector(".wv-time"), everything);
}"""
FIVE_TICKS = """async () => {
  const { watchTime } = await import("webviz/clock.js");
  let ticks = 0;
  const end = await new Promise((resolve) => {
    const end = watchTime(100, () => ++ticks === 5 && resolve(end));
  });
  end();
}"""
"""Script that waits for five updates of the time bar."""


@pytest.fixture
def viewer(page_server: PageServer, viewer: PageBench) -> PageBench:
    """A viewer without memory, so that its bar has no timeline."""
    return page_server.begin(memory=MemorySettings(seconds=0.0))


@pytest.fixture
def tab(viewer_tab: ViewerTab) -> ViewerTab:
    return viewer_tab


def bar(tab: ViewerTab) -> str:
    """Return the text of the bar in one line."""
    return " ".join(tab.page.locator(".wv-time").inner_text().split())


def shows_seconds(tab: ViewerTab) -> bool:
    """Return whether the bar begins with the time of the clock in seconds."""
    first, *_ = bar(tab).split(" ")  # empty while the page loads
    return "." in first and abs(float(first) - time.time()) < 60.0


def times(viewer: PageBench) -> PanelTimes:
    """Both clocks, as of the last turn."""
    return viewer.viewer.get(TimePart).times


def run(tab: ViewerTab, ros_s: float, until: Callable[[], object]) -> None:
    """Let ROS time go on from a moment in step with the machine until a condition holds."""
    viewer, began_s = tab.viewer, time.monotonic()
    viewer.source.now = round(ros_s * 1e9)
    viewer.do(Reset())

    def go_on() -> object:
        passed_s = time.monotonic() - began_s
        viewer.source.now = round((ros_s + passed_s) * 1e9)
        return until()

    tab.wait_for(go_on)


def simulate(tab: ViewerTab, ros_s: float) -> None:
    """Have a simulation that has run for a second and goes on, whose /clock comes at 98.7 Hz."""
    viewer = tab.viewer
    began_s, began_clock = time.monotonic(), viewer.clock

    def is_measured() -> bool:
        passed_s = time.monotonic() - began_s
        viewer.clock = began_clock + passed_s
        viewer.source.clock_count = 1 + int(98.7 * passed_s)
        return passed_s > 1.0 and times(viewer).clock_rate.rate == 1.0

    run(tab, ros_s, is_measured)


def test_a_time_that_is_not_known_yet_is_not_zero(viewer: PageBench, tab: ViewerTab) -> None:
    viewer.source.now = viewer.source.clock_count = 0
    viewer.do(Reset())
    tab.wait_for(lambda: "No time yet" in bar(tab))
    assert "1970" not in bar(tab)


def test_times_tick_without_messages(tab: ViewerTab) -> None:
    simulate(tab, 3600.0)
    with tab.paused():
        expect(tab.page.locator(".wv-time")).to_contain_text("1:00:03")
    assert re.search(r"sim time · (?:98|99|100) Hz", bar(tab)), "of whole messages in a second"
    assert "Elapsed 0:00:0" in bar(tab)
    assert "Wall 20" in bar(tab)


def test_wall_time_is_shown_as_date_and_time_and_on_a_click_as_seconds(tab: ViewerTab) -> None:
    run(tab, time.time(), lambda: times(tab.viewer).clock_rate.rate == 1.0)
    # The clock of the page ticks after the label has changed.
    tab.wait_for(lambda: time.strftime("%Y-%m-%d ") in bar(tab))
    assert "wall time" in bar(tab)
    assert "Wall 20" not in bar(tab), "it is the same time"
    tab.page.locator(".wv-ros-time").click()
    tab.wait_for(lambda: shows_seconds(tab))
    tab.page.locator(".wv-ros-time").click()
    tab.wait_for(lambda: not shows_seconds(tab))


def test_a_paused_time_changes_nothing_on_the_page(viewer: PageBench, tab: ViewerTab) -> None:
    viewer.source.now, viewer.source.clock_count = 100_250_000_000, 1
    viewer.do(Reset())
    viewer.do(Pause(True))
    tab.page.mouse.move(450, 300)  # no tooltip
    tab.wait_for(lambda: "0:01:40.250" in bar(tab))
    tab.page.evaluate(CHANGES)
    tab.page.evaluate(FIVE_TICKS)
    assert tab.page.evaluate("window.changes") == 0


@pytest.mark.parametrize("jump_ns", [0, SECOND])
def test_a_running_time_changes_the_page_ten_times_a_second_at_most(
    tab: ViewerTab, jump_ns: int
) -> None:
    def have_changed() -> bool:
        tab.viewer.source.now += jump_ns  # the page is sent each jump
        return tab.page.evaluate("window.changes >= 12")

    simulate(tab, 100.0)
    tab.wait_for(lambda: "0:01:4" in bar(tab))
    tab.page.evaluate(CHANGES)
    tab.wait_for(have_changed)
    changes, ms = tab.page.evaluate("[window.changes, performance.now() - window.countingSince]")
    assert changes <= 10 * ms / 1000 + 3


def test_time_stands_still_and_goes_on_and_starts_over(viewer: PageBench, tab: ViewerTab) -> None:
    part = viewer.viewer.get(TimePart)
    tab.button("Pause").click()
    tab.wait_for_command(Pause(True))
    assert part.is_paused
    viewer.pass_time(5.0)
    tab.wait_for(lambda: tab.button("Resume").count() > 0)
    assert times(viewer).ros_ns == 100_000_000_000
    tab.button("Resume").click()
    tab.wait_for_command(Pause(False))
    tab.wait_for(lambda: times(viewer).ros_ns == 105_000_000_000)
    assert times(viewer).ros_elapsed_ns == 5_000_000_000
    tab.page.locator(".wv-time").get_by_role("button", name="Reset").click()
    tab.wait_for_command(Reset())
    tab.wait_for(lambda: times(viewer).ros_elapsed_ns == 0)


def test_the_key_r_resets_unless_somebody_types(viewer: PageBench, tab: ViewerTab) -> None:
    tab.page.evaluate("document.activeElement?.blur()")
    tab.page.keyboard.press("r")
    tab.wait_for_command(Reset())
    viewer.forget_commands()
    tab.page.evaluate(
        "document.querySelector('.wv-time').append(Object.assign("
        "document.createElement('input'), {id: 'typed'}))"
    )
    tab.page.locator("#typed").press("r")
    tab.page.evaluate("document.querySelector('#typed').remove()")
    tab.button("Pause").click()
    tab.wait_for_command(Pause(True))
    assert viewer.commands == [Pause(True)]
