"""The bar with the time."""

from __future__ import annotations

import time

from tests.page.conftest import Loop, Tab
from webviz.commands import Pause, Reset
from webviz.engine.state import ClockRate, PanelTimes

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


def bar(tab: Tab) -> str:
    """Return the text of the bar in one line."""
    return " ".join(tab.page.locator(".wv-time").inner_text().split())


def shows_seconds(tab: Tab) -> bool:
    """Return whether the bar begins with the time of the clock in seconds."""
    first, *_ = bar(tab).split(" ")  # empty while the page loads
    return "." in first and abs(float(first) - time.time()) < 60.0


def running(ros_s: float, **more: object) -> PanelTimes:
    """A simulation that has run for 5 s and goes on."""
    clock_rate = ClockRate(round(ros_s * 1e9), time.time(), 1.0)
    values = {"clock_rate": clock_rate, "is_simulated": True, **more}
    return PanelTimes(round(ros_s * 1e9), 5_000_000_000, time.time(), 5.0, **values)  # pyright: ignore[reportArgumentType]


def wall_time() -> PanelTimes:
    """A real robot, whose clock is that of this machine."""
    now = time.time()
    clock_rate = ClockRate(round(now * 1e9), now, 1.0)
    return PanelTimes(round(now * 1e9), 0, now, 0.0, clock_rate=clock_rate)


def test_a_time_that_is_not_known_yet_is_not_zero(loop: Loop, tab: Tab) -> None:
    loop.show(clock=PanelTimes(is_simulated=True))
    tab.wait_for(lambda: "No time yet" in bar(tab))
    assert "1970" not in bar(tab)


def test_times_tick_without_messages(loop: Loop, tab: Tab) -> None:
    loop.show(clock=running(3600.0, clock_hz=98.7))
    tab.wait_for(lambda: "sim time · 99 Hz" in bar(tab))
    tab.wait_for(lambda: "1:00:02" in bar(tab))
    assert "Elapsed 0:00:0" in bar(tab)
    assert "Wall 20" in bar(tab)


def test_wall_time_is_shown_as_date_and_time_and_on_a_click_as_seconds(
    loop: Loop, tab: Tab
) -> None:
    loop.show(clock=wall_time())
    tab.wait_for(lambda: "wall time" in bar(tab))
    assert time.strftime("%Y-%m-%d ") in bar(tab)
    assert "Wall 20" not in bar(tab), "it is the same time"
    tab.page.locator(".wv-ros-time").click()
    tab.wait_for(lambda: shows_seconds(tab))
    tab.page.locator(".wv-ros-time").click()
    tab.wait_for(lambda: not shows_seconds(tab))


def test_a_paused_time_changes_nothing_on_the_page(loop: Loop, tab: Tab) -> None:
    loop.show(
        clock=running(
            100.25, is_paused=True, clock_rate=ClockRate(100_250_000_000, time.time(), 0.0)
        )
    )
    tab.page.mouse.move(450, 300)  # no tooltip
    tab.wait_for(lambda: "0:01:40.250" in bar(tab))
    tab.page.evaluate(CHANGES)
    tab.page.evaluate(FIVE_TICKS)
    assert tab.page.evaluate("window.changes") == 0


def test_a_running_time_changes_the_page_ten_times_a_second_at_most(loop: Loop, tab: Tab) -> None:
    loop.show(clock=running(100.0))
    tab.wait_for(lambda: "0:01:4" in bar(tab))
    tab.page.evaluate(CHANGES)
    tab.page.wait_for_function("window.changes >= 12")
    changes, ms = tab.page.evaluate("[window.changes, performance.now() - window.countingSince]")
    assert changes <= 10 * ms / 1000 + 3


def test_time_stands_still_and_goes_on_and_starts_over(loop: Loop, tab: Tab) -> None:
    loop.show(clock=running(100.0))
    tab.button("Pause").click()
    tab.wait_for_command(Pause(True))
    loop.show(clock=running(100.0, is_paused=True))
    tab.wait_for(lambda: tab.button("Resume").count() > 0)
    tab.button("Resume").click()
    tab.wait_for_command(Pause(False))
    tab.page.locator(".wv-time").get_by_role("button", name="Reset").click()
    tab.wait_for_command(Reset())


def test_the_key_r_resets_unless_somebody_types(loop: Loop, tab: Tab) -> None:
    loop.show()
    tab.page.evaluate("document.activeElement?.blur()")
    tab.page.keyboard.press("r")
    tab.wait_for_command(Reset())
    loop.commands.clear()
    tab.page.evaluate(
        "document.querySelector('.wv-time').append(Object.assign("
        "document.createElement('input'), {id: 'typed'}))"
    )
    tab.page.locator("#typed").press("r")
    tab.page.evaluate("document.querySelector('#typed').remove()")
    tab.button("Pause").click()
    tab.wait_for_command(Pause(True))
    assert loop.commands == [Pause(True)]
