"""The timeline of live topics, in a real browser."""

from __future__ import annotations

import re
import time
from pathlib import Path

import pytest
from msgspec.structs import replace
from playwright.sync_api import expect

from tests.page.conftest import Loop, Tab
from webviz.api.status import Level
from webviz.commands import OpenRecording, ReturnToLive, Seek
from webviz.engine.state import ClockRate, PanelTimes
from webviz.features.black_box.saved import BlackBoxState, SavedMoment
from webviz.features.recording import MemoryState, RecordingState
from webviz.sources.past_state import Event, PlaybackState

SHORT = MemoryState(60.0, 0)
BEGAN_S = 100
"""Time in seconds before now."""


def show(loop: Loop, ago_s: float | None, memory: MemoryState = SHORT) -> None:
    """Show live topics, or what was some seconds ago."""
    wall_s = time.time()
    recording = PlaybackState(
        names=(),
        start_ns=round((wall_s - BEGAN_S) * 1e9),
        end_ns=round(wall_s * 1e9),
        position_s=BEGAN_S - (ago_s or 0),
        rate=1.0,
        is_playing=False,
        is_seeking=False,
        loop=False,
        selected=None,
        first_s=BEGAN_S - memory.seconds,
        is_live=ago_s is None,
    )
    loop.show(playback=recording, memory=memory, clock=PanelTimes(wall_s=wall_s))


@pytest.fixture
def live(loop: Loop, tab: Tab) -> Tab:
    show(loop, None)
    tab.wait_for(lambda: tab.page.locator(".wv-track").count() == 1)
    return tab


def test_the_past_cannot_be_overlooked_and_a_key_leads_back(loop: Loop, live: Tab) -> None:
    banner = live.page.locator(".wv-rewound-banner")
    expect(banner).to_be_hidden()
    show(loop, 12.4)
    expect(banner).to_contain_text("s ago · not live · press L to return")
    assert 11 < float(banner.inner_text().split()[0]) < 30
    expect(live.page.get_by_role("button", name="Live (L)")).to_be_visible()
    assert re.fullmatch(r"\d+ s ago · (\* )?(.* · )?webviz", live.page.title())
    live.page.keyboard.press("l")
    live.wait_for(lambda: loop.commands == [ReturnToLive()])
    show(loop, None)
    expect(banner).to_be_hidden()
    live.wait_for(lambda: re.fullmatch(r"(\* )?(.* · )?webviz", live.page.title()))


def test_a_drag_leads_into_the_past_and_back_to_now(loop: Loop, live: Tab) -> None:
    box = live.page.locator(".wv-track").bounding_box()
    assert box
    middle, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 4
    live.page.mouse.move(middle, y)
    live.page.mouse.down()
    live.wait_for(lambda: bool(loop.commands))
    (seek,) = loop.commands
    assert isinstance(seek, Seek)
    assert seek.at_s == pytest.approx(BEGAN_S - 30, abs=10)
    live.page.mouse.move(box["x"] + box["width"] - 9, y)
    live.page.mouse.up()
    live.wait_for(lambda: loop.commands[-1] == ReturnToLive())


def test_a_typed_number_is_seconds_ago(loop: Loop, live: Tab) -> None:
    field = live.page.get_by_label("Go to time")
    expect(field).to_have_value("now")
    field.fill("20")
    field.press("Enter")
    live.wait_for(lambda: bool(loop.commands))
    (seek,) = loop.commands
    assert isinstance(seek, Seek)
    assert seek.at_s == pytest.approx(BEGAN_S - 20, abs=10)


def test_a_paused_page_says_how_far_it_is_behind(loop: Loop, live: Tab) -> None:
    field = live.page.get_by_label("Go to time")
    expect(field).to_have_value("now")
    since = time.time() - 20.0
    paused = ClockRate(round(since * 1e9), since, 0.0)
    loop.show(clock=PanelTimes(wall_s=time.time(), is_paused=True, clock_rate=paused))
    live.wait_for(lambda: re.fullmatch(r".[23]\d\.\d s", field.input_value()))
    expect(live.page.get_by_role("button", name="Live (L)")).to_be_hidden()


def test_the_memory_says_what_it_holds(loop: Loop, live: Tab) -> None:
    memory = live.page.locator(".wv-memory")
    show(loop, None, MemoryState(12.0, 256_000_000, is_full=True, pinned=("/map",)))
    expect(memory).to_have_text("memory 12 s, 256 MB")
    expect(memory).to_have_attribute(
        "data-tip",
        "Remembers the last 60 s of the displayed topics, up to 512 MB. Older messages are dropped "
        "already: raise memory.megabytes. Older latched messages and last transforms are kept of "
        "/map.",
    )


def test_the_last_error_is_reached_from_now(loop: Loop, live: Tab) -> None:
    show(loop, None)
    recording = loop.state.playback
    assert recording is not None
    at_ns = recording.start_ns + 92 * 10**9
    loop.show(logged=(Event(at_ns, Level.ERROR, "amcl", "lost track"),))
    live.page.keyboard.press("Control+k")
    live.page.get_by_role("combobox", name="Command").fill("Previous warning")
    live.wait_for(lambda: live.page.get_by_role("option", name="Previous warning").count() == 1)
    live.page.keyboard.press("Enter")
    live.wait_for(lambda: Seek(92.0) in loop.commands)
    show(loop, None)


def test_a_recording_of_a_rule_is_opened_and_left(loop: Loop, live: Tab) -> None:
    path = Path("/home/robot/webviz_black_box/2026-11-23_05-12-47_Scan_error")
    loop.show(black_box=BlackBoxState((SavedMoment(path, 12_300_000),)))
    name = "2026-11-23 05:12:47 · Scan error"
    live.button("Black box").click()
    live.page.get_by_role("menuitem", name=f"{name} · 12.3 MB").click()
    live.wait_for_command(OpenRecording(str(path)))
    assert loop.state.playback is not None
    opened = replace(loop.state.playback, names=(path.name,), is_live=None, is_opened=True)
    loop.show(playback=opened)
    banner = live.page.locator(".wv-rewound-banner")
    expect(banner).to_have_text(f"Recording {name} · not live · press L to return")
    assert live.page.title().startswith("Recording · ")
    expect(live.button("Loop")).to_be_visible()
    banner.click()
    live.wait_for_command(ReturnToLive())
    show(loop, None)
    expect(banner).to_be_hidden()
    expect(live.page.get_by_label("Go to time")).to_have_value("now")


OUTSIDE = """() => {
  const [bar] = document.getElementsByClassName("wv-time");
  const { right, bottom } = bar.getBoundingClientRect();
  return [...bar.querySelectorAll("button, input, .wv-number, .wv-badge")]
    .filter((each) => each.checkVisibility())
    .filter((each) => {
      const box = each.getBoundingClientRect();
      return box.right > right + 1 || box.bottom > bottom + 1;
    })
    .map((each) => each.ariaLabel || each.textContent);
}"""
"""Names of what is beyond the bar of the time."""


@pytest.mark.parametrize("width", [1280, 1241, 1121, 1061, 961, 861, 741, 641])
def test_all_buttons_of_the_time_are_within_the_window(loop: Loop, live: Tab, width: int) -> None:
    live.page.set_viewport_size({"width": width, "height": 600})
    path = Path("2026-11-23_05-12-47_Scan_error")
    recording = RecordingState(
        path=Path("run"), seconds=4000, messages=4, size=12_300_000, dropped=0
    )
    loop.show(black_box=BlackBoxState((SavedMoment(path, 1),)), recording=recording)
    long = MemoryState(60.0, 512_000_000)
    for ago_s in (None, 12.4):
        show(loop, ago_s, long)
        live.wait_for(
            live.button("Live (L)").is_visible
            if ago_s
            else live.button("Stop recording").is_visible
        )
        assert live.page.evaluate(OUTSIDE) == [], ago_s
    assert loop.state.playback is not None
    opened = replace(loop.state.playback, names=(path.name,), is_live=None, is_opened=True)
    loop.show(playback=opened)
    live.wait_for(live.button("Loop").is_visible)
    assert live.page.evaluate(OUTSIDE) == []
