"""The timeline of a recording, in a real browser."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from bags import START_NS, Bag
from pages import bounds
from playwright.sync_api import Locator, Position, expect
from viser_internals import cut_connections

from tests.page.everything import Everything
from tests.page.page_bench import SCAN, PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.api.declared import Topic
from webviz.api.status import Level, Status
from webviz.commands import (
    Pause,
    RemoveBookmark,
    SaveBookmark,
    Seek,
    SelectSpan,
    SetLoop,
    SetRate,
    StepMessage,
)
from webviz.files.config.model import MemorySettings
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player

START_S = START_NS // 10**9
HOSTILE = "<b>lost</b>\x1b\u202e" + "x" * 10_000
DISPLAY = Everything(name="Scan", topic=Topic("/front"))
NO_MEMORY = MemorySettings(seconds=0.0)
EDGE = 8
"""Pixels beside the track."""


@pytest.fixture(scope="module")
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A recording of 100 s with a gap of 10 s in its scans, and two warnings."""
    bag = Bag()
    bag.add("/front", SCAN)
    bag.add("/odom", "nav_msgs/msg/Odometry")
    bag.add("/map", "nav_msgs/msg/OccupancyGrid")
    bag.add("/rosout", "rcl_interfaces/msg/Log")
    bag.put(0.0, "/map", {})
    for step in range(501):
        at_s = step / 5
        if not 20 < at_s < 30:
            bag.put(at_s, "/front", {"header": {"frame_id": "map"}})
        if at_s < 99:
            bag.put(at_s + 0.1, "/odom", {"header": {"frame_id": "map"}})
    bag.put(30.0, "/rosout", {"level": 30, "name": "driver", "msg": "slow"})
    bag.put(60.0004, "/rosout", {"level": 40, "name": "driver", "msg": HOSTILE})
    bag.messages.sort(key=lambda message: message[0])
    return bag.write_file(tmp_path_factory.mktemp("bags") / "run.mcap")


@pytest.fixture
def play(
    page_server: PageServer, viewer: PageBench, viewer_tab: ViewerTab
) -> Iterator[Callable[[Path], PageBench]]:
    """Start a viewer of a recording, with a display of its scans."""
    players: list[Player] = []

    def play(bag: Path) -> PageBench:
        players.append(Player(BagHistory([bag])))
        viewer = page_server.begin(player=players[-1])
        viewer.show(DISPLAY)
        return viewer

    yield play
    page_server.begin(memory=NO_MEMORY)
    viewer_tab.wait_for(lambda: viewer_tab.page.locator(".wv-track").count() == 0)
    for player in players:
        player.close()


@pytest.fixture
def timeline(play: Callable[[Path], PageBench], bag: Path, viewer_tab: ViewerTab) -> ViewerTab:
    """The tab with a recording of 100 s at 12.5 s."""
    play(bag).do(Seek(12.5))
    expect(viewer_tab.page.get_by_label("Go to time")).to_have_value("0:00:12.500")
    viewer_tab.viewer.forget_commands()
    return viewer_tab


def at(tab: ViewerTab, seconds: float) -> Position:
    """The place of a time on the track that shows all 100 s."""
    box = bounds(tab.page.locator(".wv-track"))
    return {"x": EDGE + seconds / 100 * (box["width"] - 2 * EDGE), "y": box["height"] / 4}


def last_seek(tab: ViewerTab) -> float:
    """The position that the page has asked for last, once the viewer shows it."""
    seeks = [command for command in tab.viewer.commands if isinstance(command, Seek)]
    position_s = tab.viewer.playback.position_s
    is_shown = seeks and seeks[-1].at_s == pytest.approx(position_s, abs=1e-6)
    return position_s if is_shown else math.nan


def test_live_topics_have_no_timeline(page_server: PageServer, timeline: ViewerTab) -> None:
    page_server.begin(memory=NO_MEMORY)
    timeline.wait_for(lambda: timeline.page.locator(".wv-track").count() == 0)
    assert timeline.page.locator(".wv-transport").count() == 0
    assert bounds(timeline.page.locator(".wv-time"))["height"] < 50


def test_a_recording_shows_position_length_and_its_time(timeline: ViewerTab) -> None:
    expect(timeline.page.get_by_label("Go to time")).to_have_value("0:00:12.500")
    expect(timeline.page.locator(".wv-transport")).to_contain_text("/ 0:01:40.0")
    badge = timeline.page.locator(".wv-badge")
    expect(badge).to_have_text("bag")
    expect(badge).to_have_attribute("data-tip", "run.mcap")
    slider = timeline.page.get_by_role("slider", name="Time of the recording")
    expect(slider).to_have_attribute("aria-valuetext", "0:00:12.5")
    assert "Elapsed" not in timeline.page.locator(".wv-time").inner_text()
    assert timeline.button("Record").count() + timeline.button("Stop recording").count() == 0


def test_a_recording_of_one_message_has_its_head_and_mark_at_the_start(
    play: Callable[[Path], PageBench], timeline: ViewerTab, tmp_path: Path
) -> None:
    bag = Bag()
    bag.add("/front", SCAN)
    bag.put(0.0, "/front", {})
    play(bag.write_file(tmp_path / "one.mcap"))
    alpha = """([x, y]) => {
        const canvas = document.querySelector("canvas.wv-track");
        const at = [x, y].map((each) => Math.round(each * devicePixelRatio));
        return canvas.getContext("2d").getImageData(...at, 1, 1).data[3];
    }"""
    timeline.wait_for(lambda: timeline.page.evaluate(alpha, [EDGE, 1]) > 0)
    expect(timeline.page.locator("canvas.wv-track")).to_have_attribute("aria-valuenow", "0")


@pytest.mark.parametrize("selected", ["nothing", "text"])
def test_a_click_and_a_drag_seek(timeline: ViewerTab, selected: str) -> None:
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


def test_seeks_go_on_after_a_lost_connection(timeline: ViewerTab) -> None:
    """The answer to a seek that was under way then never comes."""
    track = timeline.page.locator(".wv-track")
    timeline.page.evaluate(
        """async () => {
          const { onOpen } = await import("webviz/channel.js");
          onOpen(() => (window.isBack = true));
        }"""
    )
    track.click(position=at(timeline, 40))
    cut_connections(timeline.viewer.server)
    timeline.page.wait_for_function("window.isBack")
    timeline.wait_for(lambda: timeline.page.locator(".wv-track").is_visible())
    track.click(position=at(timeline, 60))
    timeline.wait_for(lambda: abs(last_seek(timeline) - 60) < 0.2)
    timeline.page.mouse.move(10, 10)


def test_dragging_with_shift_selects_and_a_click_selects_all(timeline: ViewerTab) -> None:
    viewer = timeline.viewer
    track = timeline.page.locator(".wv-track")
    timeline.page.keyboard.down("Shift")
    track.hover(position=at(timeline, 60))
    timeline.page.mouse.down()
    track.hover(position=at(timeline, 20))
    timeline.page.mouse.up()
    timeline.wait_for(lambda: any(isinstance(c, SelectSpan) for c in viewer.commands))
    assert viewer.playback.selected == pytest.approx((20, 60), abs=0.2)
    track.click(position=at(timeline, 50))
    timeline.page.keyboard.up("Shift")
    timeline.wait_for_command(SelectSpan(None, None))
    assert viewer.playback.selected is None


def test_the_wheel_zooms_around_the_pointer(timeline: ViewerTab) -> None:
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


def test_a_typed_time_is_gone_to_and_nonsense_is_not(timeline: ViewerTab) -> None:
    field = timeline.page.get_by_label("Go to time")
    field.fill("1:02.5")
    field.press("Enter")
    timeline.wait_for_command(Seek(62.5))
    assert last_seek(timeline) == 62.5
    timeline.viewer.forget_commands()
    field.fill("soon")
    field.press("Enter")
    expect(timeline.page.locator(".wv-toast")).to_contain_text("soon is not a time.")
    expect(field).to_have_value("0:01:02.500")
    assert not timeline.viewer.commands


def test_buttons_and_keys_step_play_and_loop(timeline: ViewerTab) -> None:
    page, viewer = timeline.page, timeline.viewer
    timeline.button("Play").click()
    timeline.wait_for_command(Pause(False))
    timeline.wait_for(lambda: viewer.playback.position_s > 12.6)
    with timeline.paused():  # it would play on
        viewer.do(Seek(12.5))
        timeline.button("Next message").click()
        timeline.catch_up()
    timeline.wait_for_command(StepMessage("", True))
    assert (viewer.playback.position_s, viewer.playback.is_playing) == (12.6, False)
    timeline.button("Rate").click()
    page.get_by_role("menuitemradio", name="As fast as possible").click()
    timeline.wait_for_command(SetRate(0))
    assert viewer.playback.rate == math.inf
    timeline.button("Loop").click()
    timeline.wait_for_command(SetLoop(True))
    assert viewer.playback.loop
    page.keyboard.press("ArrowLeft")
    timeline.wait_for_command(StepMessage("", False))
    assert viewer.playback.position_s == 12.4
    timeline.turn()
    page.keyboard.press("Shift+ArrowRight")
    timeline.wait_for(lambda: last_seek(timeline) == 17.4)
    page.keyboard.press("End")
    timeline.wait_for_command(Seek(100.0))
    assert last_seek(timeline) == 100.0
    viewer.do(SetRate(1))
    viewer.do(Seek(50))
    viewer.do(Pause(False))
    timeline.wait_for(lambda: timeline.button("Pause").count())
    page.keyboard.press(" ")
    timeline.wait_for_command(Pause(True))
    assert not viewer.playback.is_playing


def test_a_held_key_steps_on_with_each_answer_and_no_further_than_it_goes(
    timeline: ViewerTab,
) -> None:
    page, viewer = timeline.page, timeline.viewer
    page.evaluate("document.activeElement.blur()")

    def steps() -> int:
        return sum(isinstance(command, StepMessage) for command in viewer.commands)

    def held_until(is_reached: Callable[[], object]) -> None:
        """Let the key repeat once for each turn of the loop, which answers at once."""
        timeline.wait_for(lambda: page.keyboard.down("ArrowRight") or is_reached())

    with timeline.paused():
        for _ in range(4):
            page.keyboard.down("ArrowRight")
        timeline.catch_up()
        assert steps() == 0
    timeline.wait_for(steps)
    assert steps() == 1, "the next step waits for the answer"
    held_until(lambda: steps() >= 2)  # a busy machine may have had time for a third
    timeline.wait_for(lambda: viewer.playback.position_s == pytest.approx(12.4 + 0.2 * steps()))
    viewer.do(Seek(99.9))
    toast = page.locator(".wv-toast", has_text="There is no next message of a displayed topic.")
    held_until(toast.count)
    count = steps()
    for _ in range(4):
        page.keyboard.down("ArrowRight")
        timeline.turn()
    assert steps() == count
    page.keyboard.up("ArrowRight")
    held_until(lambda: steps() == count + 1)
    page.keyboard.up("ArrowRight")


def test_bookmarks_are_added_gone_to_and_removed(timeline: ViewerTab) -> None:
    page, viewer = timeline.page, timeline.viewer
    page.evaluate("document.activeElement.blur()")
    page.keyboard.press("b")
    expect(page.get_by_role("dialog")).to_contain_text("Bookmark at 0:00:12.5")
    page.get_by_label("Name of the bookmark").fill("lost here")
    page.keyboard.press("Enter")
    timeline.wait_for_command(SaveBookmark("lost here", 12.5))
    assert viewer.settings.bookmarks == {"lost here": START_S + 12.5}
    bookmarks = {"of another recording": START_S + 1000.0, "lost here": START_S + 80.0}
    viewer.show(DISPLAY, bookmarks=bookmarks)
    timeline.turn()
    page.locator(".wv-track").click(position=at(timeline, 80.4))
    timeline.wait_for(lambda: last_seek(timeline) == 80.0)
    timeline.button("Bookmarks").click()
    expect(page.get_by_role("menuitem", name="of another recording")).to_have_count(0)
    page.get_by_role("menuitem", name="Remove").click()
    page.get_by_role("menuitem", name="lost here").last.click()
    timeline.wait_for_command(RemoveBookmark("lost here"))
    assert [*viewer.settings.bookmarks] == ["of another recording"]


def test_warnings_are_read_clicked_and_gone_to(timeline: ViewerTab) -> None:
    viewer = timeline.viewer
    viewer.do(Seek(45))
    viewer.report(Scan={"Transform": Status(Level.WARN, "No transform.")})
    viewer.do(Seek(45))
    viewer.report(Scan={})
    viewer.do(Seek(12.5))
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
        viewer.do(Seek(position_s))
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


def test_a_link_names_a_moment_once(timeline: ViewerTab) -> None:
    page = timeline.page
    page.goto(page.url + "&t=1:02.5")
    timeline.wait_for(lambda: last_seek(timeline) == 62.5)
    timeline.wait_for(lambda: "t=" not in page.url)
    page.keyboard.press("Control+k")
    page.get_by_role("combobox", name="Command").fill("link to this")
    page.keyboard.press("Enter")
    expect(page.locator(".wv-toast")).to_contain_text("Copied the link to this moment.")


def test_topics_are_listed_and_chosen_for_steps(timeline: ViewerTab) -> None:
    timeline.button("Topics").click()
    rows = timeline.page.get_by_role("listbox", name="Topics of the timeline")
    timeline.wait_for(lambda: rows.get_by_role("option").count() == 5)
    texts = rows.get_by_role("option").all_inner_texts()
    assert texts == ["All displayed topics", "/front", "/map", "/odom", "/rosout"]
    strip = rows.get_by_role("option", name="/front").locator("canvas")
    timeline.wait_for(
        lambda: painted(strip, 0.1) and not painted(strip, 0.25) and painted(strip, 0.6)
    )
    rows.get_by_role("option", name="/odom").click()
    timeline.button("Next message").click()
    timeline.wait_for_command(StepMessage("/odom", True))
    assert timeline.viewer.playback.position_s == 12.7
    rows.get_by_role("option", name="All displayed topics").click()
    timeline.button("Next message").click()
    timeline.wait_for_command(StepMessage("", True))
    assert timeline.viewer.playback.position_s == 12.8
    timeline.button("Topics").click()
    expect(rows).to_have_count(0)


def painted(canvas: Locator, share: float) -> bool:
    """Return whether something is drawn at a share of the width of a canvas."""
    return canvas.evaluate(
        "(one, share) => one.width > 0 && one.getContext('2d')"
        ".getImageData(Math.round(share * one.width), one.height / 2, 1, 1).data[3] > 0",
        share,
    )


def test_seeks_that_cannot_keep_up_are_left_out(timeline: ViewerTab) -> None:
    """The newest place of a drag counts, whatever lies between."""
    track = timeline.page.locator(".wv-track")
    track.hover(position=at(timeline, 5))
    with timeline.paused():
        timeline.page.mouse.down()
        for seconds in (10, 50, 90):
            track.hover(position=at(timeline, seconds))
        timeline.page.mouse.up()
        timeline.catch_up()
    timeline.wait_for(lambda: abs(last_seek(timeline) - 90) < 0.2)
    assert sum(isinstance(command, Seek) for command in timeline.viewer.commands) == 2
