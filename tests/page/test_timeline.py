"""The timeline of a recording, in a real browser."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import pytest
from msgspec.structs import replace
from playwright.sync_api import Locator, Position, expect
from viser_internals import cut_connections

from tests.page.conftest import Loop, Tab
from webviz.api.errors import Error
from webviz.api.status import Level
from webviz.commands import (
    Pause,
    RemoveBookmark,
    SaveBookmark,
    SaveMemory,
    Seek,
    SelectSpan,
    SetLoop,
    SetRate,
    StartRecording,
    StepMessage,
    StopRecording,
)
from webviz.engine.state import ClockRate, PanelTimes
from webviz.features.recording import MemoryState, RecordingState
from webviz.files.config import Settings
from webviz.files.config.model import MemorySettings
from webviz.scene.server import Server
from webviz.sources.past_state import Event, PlaybackState

START_S = 1_700_000_000
COUNTS = [20] * 100 + [0] * 50 + [5] * 350
TOPICS = {"/scan": COUNTS, "/odom": [10] * 500, "/map": [1] + [0] * 499}
RECORDING = PlaybackState(
    names=("run.mcap",),
    start_ns=START_S * 10**9,
    end_ns=(START_S + 100) * 10**9,
    position_s=12.5,
    rate=1.0,
    is_playing=False,
    is_seeking=False,
    loop=False,
    selected=None,
)
EDGE = 8
"""Pixels beside the track."""


def show(pages: Loop, /, **changes: object) -> None:
    """Show a recording."""
    recording = replace(RECORDING, **changes)
    ros_ns = recording.start_ns + round(recording.position_s * 1e9)
    clock = PanelTimes(
        ros_ns,
        clock_rate=ClockRate(ros_ns, 0.0, 0.0),
        is_simulated=True,
        is_paused=not recording.is_playing,
    )
    pages.show(playback=recording, recorded=TOPICS, clock=clock)


@pytest.fixture
def timeline(loop: Loop, tab: Tab) -> Tab:
    """The tab with a recording of 100 s at 12.5 s."""
    tab.wait_for(lambda: tab.page.locator(".wv-track").count() == 0)  # of the test before
    show(loop)
    tab.wait_for(lambda: tab.page.locator(".wv-track").count() == 1)
    return tab


def at(tab: Tab, seconds: float) -> Position:
    """The place of a time on the track that shows all 100 s."""
    box = tab.page.locator(".wv-track").bounding_box()
    assert box
    return {"x": EDGE + seconds / 100 * (box["width"] - 2 * EDGE), "y": box["height"] / 4}


def last_seek(tab: Tab) -> float:
    seeks = [command for command in tab.loop.commands if isinstance(command, Seek)]
    return seeks[-1].at_s if seeks else math.nan


def test_live_topics_have_no_timeline(loop: Loop, timeline: Tab) -> None:
    loop.show(playback=None)
    timeline.wait_for(lambda: timeline.page.locator(".wv-track").count() == 0)
    assert timeline.page.locator(".wv-transport").count() == 0
    assert timeline.page.locator(".wv-time").bounding_box()["height"] < 50  # pyright: ignore[reportOptionalSubscript]


def test_a_recording_shows_position_length_and_its_time(timeline: Tab) -> None:
    expect(timeline.page.get_by_label("Go to time")).to_have_value("0:00:12.500")
    expect(timeline.page.locator(".wv-transport")).to_contain_text("/ 0:01:40.0")
    badge = timeline.page.locator(".wv-badge")
    expect(badge).to_have_text("bag")
    expect(badge).to_have_attribute("data-tip", "run.mcap")
    slider = timeline.page.get_by_role("slider", name="Time of the recording")
    expect(slider).to_have_attribute("aria-valuetext", "0:00:12.5")
    assert "Elapsed" not in timeline.page.locator(".wv-time").inner_text()


def test_a_recording_of_one_message_has_its_head_and_mark_at_the_start(
    loop: Loop, timeline: Tab
) -> None:
    show(loop, end_ns=RECORDING.start_ns, position_s=0.0)
    alpha = """([x, y]) => {
        const canvas = document.querySelector("canvas.wv-track");
        const at = [x, y].map((each) => Math.round(each * devicePixelRatio));
        return canvas.getContext("2d").getImageData(...at, 1, 1).data[3];
    }"""
    timeline.wait_for(lambda: timeline.page.evaluate(alpha, [EDGE, 1]) > 0)
    expect(timeline.page.locator("canvas.wv-track")).to_have_attribute("aria-valuenow", "0")


@pytest.mark.parametrize("selected", ["nothing", "text"])
def test_a_click_and_a_drag_seek(timeline: Tab, selected: str) -> None:
    """Selected text stays where it is: a browser that drags it cancels the pointer."""
    select = "getSelection().selectAllChildren(document.body)" if selected == "text" else ""
    track = timeline.page.locator(".wv-track")
    track.click(position=at(timeline, 40))
    timeline.wait_for(lambda: abs(last_seek(timeline) - 40) < 0.2)
    timeline.page.evaluate(select)
    track.hover(position=at(timeline, 50))
    timeline.page.mouse.down()
    for seconds in (70, 80):
        track.hover(position=at(timeline, seconds))
        timeline.wait_for(lambda seconds=seconds: abs(last_seek(timeline) - seconds) < 0.2)
    timeline.page.mouse.up()
    timeline.page.evaluate("getSelection().removeAllRanges()")
    timeline.page.mouse.move(10, 10)


def test_seeks_go_on_after_a_lost_connection(timeline: Tab, server: Server) -> None:
    """The answer to a seek that was under way then never comes."""
    track = timeline.page.locator(".wv-track")
    timeline.page.evaluate(
        """async () => {
          const { onOpen } = await import("webviz/channel.js");
          onOpen(() => (window.isBack = true));
        }"""
    )
    track.click(position=at(timeline, 40))
    cut_connections(server)
    timeline.page.wait_for_function("window.isBack")
    timeline.wait_for(lambda: timeline.page.locator(".wv-track").is_visible())
    track.click(position=at(timeline, 60))
    timeline.wait_for(lambda: abs(last_seek(timeline) - 60) < 0.2)
    timeline.page.mouse.move(10, 10)


def test_dragging_with_shift_selects_and_a_click_selects_all(loop: Loop, timeline: Tab) -> None:
    track = timeline.page.locator(".wv-track")
    timeline.page.keyboard.down("Shift")
    track.hover(position=at(timeline, 60))
    timeline.page.mouse.down()
    track.hover(position=at(timeline, 20))
    timeline.page.mouse.up()
    timeline.wait_for(lambda: any(isinstance(c, SelectSpan) for c in loop.commands))
    span = loop.commands[-1]
    assert isinstance(span, SelectSpan)
    assert span.first_s == pytest.approx(20, abs=0.2)
    assert span.last_s == pytest.approx(60, abs=0.2)
    track.click(position=at(timeline, 50))
    timeline.page.keyboard.up("Shift")
    timeline.wait_for_command(SelectSpan(None, None))


def test_the_wheel_zooms_around_the_pointer(timeline: Tab) -> None:
    track = timeline.page.locator(".wv-track")
    track.hover(position=at(timeline, 50))
    for _ in range(2):
        timeline.page.mouse.wheel(0, -100)
    track.click(position=at(timeline, 50))
    timeline.wait_for(lambda: abs(last_seek(timeline) - 50) < 0.2)
    track.click(position=at(timeline, 100))  # the right end of the window: 100 s / 1.25 ** 2
    timeline.wait_for(lambda: abs(last_seek(timeline) - (50 + 50 / 1.25**2)) < 0.2)
    track.dblclick(position=at(timeline, 50))
    track.click(position=at(timeline, 90))
    timeline.wait_for(lambda: abs(last_seek(timeline) - 90) < 0.2)


def test_a_typed_time_is_gone_to_and_nonsense_is_not(loop: Loop, timeline: Tab) -> None:
    field = timeline.page.get_by_label("Go to time")
    field.fill("1:02.5")
    field.press("Enter")
    timeline.wait_for_command(Seek(62.5))
    loop.commands.clear()
    field.fill("soon")
    field.press("Enter")
    expect(timeline.page.locator(".wv-toast")).to_contain_text("soon is not a time.")
    expect(field).to_have_value("0:00:12.500")
    assert not loop.commands


def test_buttons_and_keys_step_play_and_loop(loop: Loop, timeline: Tab) -> None:
    page = timeline.page
    timeline.button("Play").click()
    timeline.wait_for_command(Pause(False))
    timeline.button("Next message").click()
    timeline.wait_for_command(StepMessage("", True))
    timeline.button("Rate").click()
    page.get_by_role("menuitemradio", name="As fast as possible").click()
    timeline.wait_for_command(SetRate(0))
    timeline.button("Loop").click()
    timeline.wait_for_command(SetLoop(True))
    page.keyboard.press("ArrowLeft")
    timeline.wait_for_command(StepMessage("", False))
    page.keyboard.press("Shift+ArrowRight")
    timeline.wait_for_command(Seek(17.5))
    page.keyboard.press("End")
    timeline.wait_for_command(Seek(100.0))
    show(loop, is_playing=True)
    timeline.wait_for(lambda: timeline.button("Pause").count())
    page.keyboard.press(" ")
    timeline.wait_for_command(Pause(True))


def test_a_held_key_steps_on_with_each_answer_and_no_further_than_it_goes(
    loop: Loop, timeline: Tab
) -> None:
    page = timeline.page
    page.evaluate("document.activeElement.blur()")

    def steps() -> int:
        return sum(isinstance(command, StepMessage) for command in loop.commands)

    def held_until(is_reached: Callable[[], object]) -> None:
        """Let the key repeat once for each turn of the loop, which answers at once."""
        timeline.wait_for(lambda: page.keyboard.down("ArrowRight") or is_reached())

    for _ in range(4):
        page.keyboard.down("ArrowRight")
    timeline.wait_for(steps)
    assert steps() == 1, "the next step waits for the answer"
    held_until(lambda: steps() == 2)
    loop.answer = Error("There is no later message.")
    toast = page.locator(".wv-toast", has_text="There is no later message.")
    held_until(toast.count)
    count = steps()
    for _ in range(4):
        page.keyboard.down("ArrowRight")
        timeline.turn()
    assert steps() == count
    page.keyboard.up("ArrowRight")
    held_until(lambda: steps() == count + 1)
    page.keyboard.up("ArrowRight")


def test_bookmarks_are_added_gone_to_and_removed(loop: Loop, timeline: Tab) -> None:
    page = timeline.page
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("b")
    expect(page.get_by_role("dialog")).to_contain_text("Bookmark at 0:00:12.5")
    page.get_by_label("Name of the bookmark").fill("lost here")
    page.keyboard.press("Enter")
    timeline.wait_for_command(SaveBookmark("lost here", 12.5))
    bookmarks = {"of another recording": START_S + 1000.0, "lost here": START_S + 80.0}
    loop.show(settings=Settings(bookmarks=bookmarks))
    timeline.turn()
    page.locator(".wv-track").click(position=at(timeline, 80.4))
    timeline.wait_for(lambda: last_seek(timeline) == 80.0)
    timeline.button("Bookmarks").click()
    expect(page.get_by_role("menuitem", name="of another recording")).to_have_count(0)
    page.get_by_role("menuitem", name="Remove").click()
    page.get_by_role("menuitem", name="lost here").last.click()
    timeline.wait_for_command(RemoveBookmark("lost here"))


def test_warnings_are_read_clicked_and_gone_to(loop: Loop, timeline: Tab) -> None:
    start_ns = RECORDING.start_ns
    hostile = "<b>lost</b>\x1b\u202e" + "x" * 10_000
    loop.show(
        logged=(
            Event(start_ns + 30 * 10**9, Level.WARN, "driver", "slow"),
            Event(start_ns + 60_000_400_000, Level.ERROR, "driver", hostile),
        ),
        warned=(Event(start_ns + 45 * 10**9, Level.WARN, "Scan", "No transform."),),
    )
    timeline.turn()
    page, track = timeline.page, timeline.page.locator(".wv-track")
    label = page.locator(".wv-track-label")
    track.hover(position=at(timeline, 45))
    expect(label).to_have_text("Warning · Scan: No transform.")
    track.hover(position=at(timeline, 60))
    expect(label).to_contain_text("Error · driver: <b>lost</b>  xxx")
    assert len(label.inner_text()) <= 320
    assert label.evaluate("e => e.getBoundingClientRect().right <= innerWidth")
    track.click(position=at(timeline, 30.2))
    timeline.wait_for(lambda: last_seek(timeline) == 30)
    page.mouse.move(10, 10)

    def run(command: str, position_s: float) -> None:
        show(loop, position_s=position_s)
        timeline.wait_for(lambda: float(track.get_attribute("aria-valuenow") or -1) == position_s)
        page.keyboard.press("Control+k")
        field = page.get_by_role("combobox", name="Command")
        field.fill(command)
        page.keyboard.press("Enter")
        expect(field).to_have_count(0)

    for position_s, command, then in (
        (12.5, "Next warning", 30.0),
        (60.0, "Previous warning", 45.0),  # not again the one that is shown
        (45.0, "Next warning", 60.0004),
    ):
        run(command, position_s)
        timeline.wait_for(lambda then=then: last_seek(timeline) == then)
    run("Next warning", 60.0)
    toast = page.locator(".wv-toast", has_text="There is no next warning or error.")
    expect(toast).to_have_count(1)


def test_a_link_names_a_moment_once(timeline: Tab) -> None:
    page = timeline.page
    page.goto(page.url + "&t=1:02.5")
    timeline.wait_for(lambda: last_seek(timeline) == 62.5)
    timeline.wait_for(lambda: "t=" not in page.url)
    page.keyboard.press("Control+k")
    page.get_by_role("combobox", name="Command").fill("link to this")
    page.keyboard.press("Enter")
    expect(page.locator(".wv-toast")).to_contain_text("Copied the link to this moment.")


def test_topics_are_listed_and_chosen_for_steps(timeline: Tab) -> None:
    timeline.button("Topics").click()
    rows = timeline.page.get_by_role("listbox", name="Topics of the timeline")
    timeline.wait_for(lambda: rows.get_by_role("option").count() == 4)
    texts = rows.get_by_role("option").all_inner_texts()
    assert texts == ["All displayed topics", "/map", "/odom", "/scan"]
    strip = rows.get_by_role("option", name="/scan").locator("canvas")
    timeline.wait_for(
        lambda: painted(strip, 0.1) and not painted(strip, 0.25) and painted(strip, 0.6)
    )
    rows.get_by_role("option", name="/odom").click()
    timeline.button("Next message").click()
    timeline.wait_for_command(StepMessage("/odom", True))
    rows.get_by_role("option", name="All displayed topics").click()
    timeline.button("Next message").click()
    timeline.wait_for_command(StepMessage("", True))
    timeline.button("Topics").click()
    expect(rows).to_have_count(0)


def painted(canvas: Locator, share: float) -> bool:
    """Return whether something is drawn at a share of the width of a canvas."""
    return canvas.evaluate(
        "(one, share) => one.width > 0 && one.getContext('2d')"
        ".getImageData(Math.round(share * one.width), one.height / 2, 1, 1).data[3] > 0",
        share,
    )


def test_seeks_that_cannot_keep_up_are_left_out(loop: Loop, timeline: Tab) -> None:
    """The newest place of a drag counts, whatever lies between."""
    track = timeline.page.locator(".wv-track")
    track.hover(position=at(timeline, 5))
    timeline.page.mouse.down()
    for seconds in (10, 50, 90):  # no turn of the loop answers meanwhile
        track.hover(position=at(timeline, seconds))
    timeline.page.mouse.up()
    timeline.wait_for(lambda: abs(last_seek(timeline) - 90) < 0.2)
    assert sum(isinstance(command, Seek) for command in loop.commands) == 2


def test_live_topics_are_recorded_and_their_last_minute_saved(loop: Loop, tab: Tab) -> None:
    loop.show(memory=MemoryState(42.7, 12_400_000))
    tab.wait_for(lambda: tab.button("Record").count())
    tab.button("Record").click()
    tab.wait_for_command(StartRecording())
    recording = RecordingState(
        path=Path("/home/robot/run"), seconds=65.2, messages=10, size=1_234_567, dropped=0
    )
    loop.show(recording=recording)
    tab.wait_for(lambda: tab.button("Stop recording").count())
    assert tab.button("Stop recording").inner_text() == "0:01:05 · 1.2 MB"
    tab.button("Stop recording").click()
    tab.wait_for_command(StopRecording())
    tab.page.get_by_role("button", name="Save last 42 s").click()
    tab.wait_for_command(SaveMemory())
    loop.show(memory=MemoryState(42.7, 12_400_000, held_s=95.3))
    tab.wait_for(lambda: tab.page.get_by_role("button", name="Save all 95 s").count())
    loop.show(memory=MemoryState(42.7, 12_400_000))
    loop.show(settings=Settings(memory=MemorySettings(seconds=0.0)))
    tab.wait_for(lambda: tab.page.get_by_role("button", name="Save last").count() == 0)
    loop.show(memory=None, playback=RECORDING)
    tab.wait_for(lambda: tab.button("Stop recording").count() == 0)
