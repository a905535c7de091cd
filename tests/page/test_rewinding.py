"""The timeline of live topics, in a real browser."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from bags import Bag
from playwright.sync_api import expect

from tests.page.everything import Everything
from tests.page.page_bench import SCAN, PageBench, PageServer
from tests.page.tabs import ViewerTab
from webviz.api.declared import Topic
from webviz.commands import (
    OpenRecording,
    Pause,
    ReturnToLive,
    SaveMemory,
    Seek,
    StartRecording,
    StopRecording,
)
from webviz.files.config.model import MemorySettings
from webviz.files.config.watch import WatchRule
from webviz.panels.log import LOG

REMEMBERED_S = 55.0
"""Seconds that the memory reaches back."""
SAVE = re.compile(r"Save (last|all) \d+ s")
WATCH = [WatchRule(display="Scan", status="error")]
FOLDER = "2026-11-23_05-12-47_Scan_error"
"""Name of the recording of a rule."""


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder in which the viewer is started, with a recording of a rule."""
    monkeypatch.chdir(tmp_path)
    bag = Bag()
    bag.add("/front", SCAN)
    for at_s in range(10):
        bag.put(at_s, "/front", {})
    bag.write(tmp_path / "webviz_black_box" / FOLDER)
    return tmp_path


@pytest.fixture
def viewer(folder: Path, page_server: PageServer, viewer: PageBench) -> Iterator[PageBench]:
    """A viewer that remembers live topics."""
    viewer = remembering(page_server)
    viewer.show(watch=WATCH)
    yield viewer
    page_server.begin(memory=MemorySettings(seconds=0.0))


@pytest.fixture
def live(viewer: PageBench, viewer_tab: ViewerTab) -> ViewerTab:
    viewer_tab.wait_for(lambda: viewer_tab.page.locator(".wv-track").count() == 1)
    return viewer_tab


def remembering(page_server: PageServer, memory: MemorySettings | None = None) -> PageBench:
    """Start a viewer that has received transforms for a while."""
    viewer = page_server.begin(ago_s=REMEMBERED_S, memory=memory)
    for ago_s in range(50, 0, -5):
        viewer.link("map", f"wheel{ago_s}", ago_s=ago_s)
    return viewer


def look_back(viewer: PageBench, ago_s: float) -> None:
    """Show what was some seconds ago."""
    playback = viewer.playback
    viewer.do(Seek((playback.end_ns - playback.start_ns) / 1e9 - ago_s))


def ago(viewer: PageBench) -> float:
    """Seconds between the newest message and what is shown."""
    playback = viewer.playback
    return (playback.end_ns - playback.start_ns) / 1e9 - playback.position_s


def test_the_past_cannot_be_overlooked_and_a_key_leads_back(
    viewer: PageBench, live: ViewerTab
) -> None:
    banner = live.page.locator(".wv-rewound-banner")
    expect(banner).to_be_hidden()
    look_back(viewer, 12.4)
    expect(banner).to_contain_text("s ago · not live · press L to return")
    assert 11 < float(banner.inner_text().split()[0]) < 30
    expect(live.page.get_by_role("button", name="Live (L)")).to_be_visible()
    assert re.fullmatch(r"\d+ s ago · (\* )?(.* · )?webviz", live.page.title())
    live.page.keyboard.press("l")
    live.wait_for_command(ReturnToLive())
    live.wait_for(lambda: viewer.playback.is_live)
    expect(banner).to_be_hidden()
    live.wait_for(lambda: re.fullmatch(r"(\* )?(.* · )?webviz", live.page.title()))


def test_a_drag_leads_into_the_past_and_back_to_now(viewer: PageBench, live: ViewerTab) -> None:
    box = live.page.locator(".wv-track").bounding_box()
    assert box
    middle, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 4
    live.page.mouse.move(middle, y)
    live.page.mouse.down()
    live.wait_for(lambda: viewer.playback.is_live is False)
    assert ago(viewer) == pytest.approx(REMEMBERED_S / 2, abs=10)
    live.page.mouse.move(box["x"] + box["width"] - 9, y)
    live.page.mouse.up()
    live.wait_for(lambda: viewer.commands[-1] == ReturnToLive())
    live.wait_for(lambda: viewer.playback.is_live)


def test_a_typed_number_is_seconds_ago(viewer: PageBench, live: ViewerTab) -> None:
    field = live.page.get_by_label("Go to time")
    expect(field).to_have_value("now")
    field.fill("20")
    field.press("Enter")
    live.wait_for(lambda: viewer.playback.is_live is False)
    assert ago(viewer) == pytest.approx(20, abs=10)


def test_a_paused_page_says_how_far_it_is_behind(viewer: PageBench, live: ViewerTab) -> None:
    field = live.page.get_by_label("Go to time")
    expect(field).to_have_value("now")
    viewer.do(Pause(True))
    live.wait_for(lambda: re.fullmatch(r".[2-9]\.\d\d? s", field.input_value()))
    expect(live.page.get_by_role("button", name="Live (L)")).to_be_hidden()


def test_the_memory_says_what_it_holds(page_server: PageServer, live: ViewerTab) -> None:
    viewer = remembering(page_server, MemorySettings(megabytes=3))
    viewer.show(Everything(name="a", topic=Topic("/front")), memory=MemorySettings(megabytes=3))
    viewer.offer("/front", SCAN, "/driver")
    viewer.turn()
    for ago_s, count in ((40.0, 60), (12.5, 330)):
        for _ in range(count):
            viewer.publish_past(ago_s, "/front", SCAN, {"ranges": [1.0] * 2500})
        viewer.turn()
    memory = live.page.locator(".wv-memory")
    expect(memory).to_have_text(re.compile(r"memory 1[2-6] s, [23] MB"))
    expect(memory).to_have_attribute(
        "data-tip",
        "Remembers the last 60 s of the displayed topics, up to 3 MB. Older messages are dropped "
        "already: raise memory.megabytes. Older latched messages and last transforms are kept of "
        "/tf_static.",
    )


def test_the_last_error_is_reached_from_now(viewer: PageBench, live: ViewerTab) -> None:
    viewer.offer("/rosout", LOG, "/amcl")
    viewer.turn()
    viewer.publish_past(8.0, "/rosout", LOG, {"level": 40, "name": "amcl", "msg": "lost track"})
    viewer.turn()
    live.page.keyboard.press("Control+k")
    live.page.get_by_role("combobox", name="Command").fill("Previous warning")
    live.wait_for(lambda: live.page.get_by_role("option", name="Previous warning").count() == 1)
    live.page.keyboard.press("Enter")
    live.wait_for(lambda: viewer.playback.is_live is False)
    assert 8.0 < ago(viewer) < 30.0


def test_a_recording_of_a_rule_is_opened_and_left(
    viewer: PageBench, live: ViewerTab, folder: Path
) -> None:
    name = "2026-11-23 05:12:47 · Scan error"
    item = live.page.get_by_role("menuitem", name=re.compile(rf"{name} · [\d.]+ MB"))

    def is_listed() -> int:
        """Return whether an opened menu has the recording, once the folder is read."""
        live.page.keyboard.press("Escape")
        live.button("Black box").click()
        return item.count()

    live.wait_for(live.button("Black box").is_visible)
    live.wait_for(is_listed)
    item.click()
    live.wait_for_command(OpenRecording(str(folder / "webviz_black_box" / FOLDER)))
    banner = live.page.locator(".wv-rewound-banner")
    live.wait_for(lambda: "Recording " in banner.inner_text())
    expect(banner).to_have_text(f"Recording {name} · not live · press L to return")
    assert live.page.title().startswith("Recording · ")
    assert viewer.playback.is_opened
    expect(live.button("Loop")).to_be_visible()
    banner.click()
    live.wait_for_command(ReturnToLive())
    live.wait_for(lambda: viewer.playback.is_live)
    expect(banner).to_be_hidden()
    live.wait_for(lambda: live.page.get_by_label("Go to time").input_value() == "now")


OUTSIDE = """async () => {
  const longest = {
    "Stop recording": "1:06:40 · 12.3 MB",
    "Save last": "Save last 60 s",
    memory: "memory 60 s, 512 MB",
  };
  const texts = document.createTreeWalker(document.querySelector(".wv-time"), NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const { currentNode: text } = texts;
    const name = text.parentElement.closest("button")?.ariaLabel ?? "";
    const is = (key) => name === key || text.data.startsWith(key);
    const key = Object.keys(longest).find(is);
    if (key && text.data.trim()) text.data = longest[key];
  }
  const frame = () => new Promise(requestAnimationFrame);
  for (let i = 0; i < 2; i += 1) await frame(); // the bar fits itself
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
"""Names of what is beyond the bar of the time, even if all its texts are as long as can be."""


@pytest.mark.parametrize("width", [1280, 1241, 1121, 1061, 961, 861, 741, 641])
def test_all_buttons_of_the_time_are_within_the_window(
    viewer: PageBench, live: ViewerTab, folder: Path, width: int
) -> None:
    live.page.set_viewport_size({"width": width, "height": 600})
    viewer.do(StartRecording("run"))
    live.wait_for(live.button("Stop recording").is_visible)
    live.wait_for(live.page.locator("[aria-label='Black box']").count)
    assert live.page.evaluate(OUTSIDE) == []
    look_back(viewer, 12.4)
    live.wait_for(live.button("Live (L)").is_visible)
    assert live.page.evaluate(OUTSIDE) == []
    viewer.do(OpenRecording(str(folder / "webviz_black_box" / FOLDER)))
    live.wait_for(live.button("Loop").is_visible)
    assert live.page.evaluate(OUTSIDE) == []


def test_live_topics_are_recorded_and_their_last_minute_saved(
    page_server: PageServer, viewer: PageBench, live: ViewerTab, folder: Path
) -> None:
    tab, before = live, {*folder.iterdir()}
    tab.wait_for(lambda: tab.button("Record").count())
    tab.button("Record").click()
    tab.wait_for_command(StartRecording())
    (recorded,) = {*folder.iterdir()} - before
    stop = tab.button("Stop recording")
    tab.wait_for(lambda: re.fullmatch(r"0:00:\d\d · 0 MB", stop.inner_text()))
    stop.click()
    tab.wait_for_command(StopRecording())
    save = tab.page.get_by_role("button", name=SAVE)
    expect(save).to_have_accessible_name(re.compile(r"Save last 5\d s"))
    save.click()
    tab.wait_for_command(SaveMemory())
    (new_folder,) = {*folder.iterdir()} - before - {recorded}
    assert [*recorded.glob("*.mcap")]
    assert [*new_folder.glob("*.mcap")]
    look_back(viewer, 20.0)
    expect(save).to_have_accessible_name(re.compile(r"Save all \d\d s"))
    card = tab.page.get_by_role("status", name="File")
    tab.wait_for(lambda: new_folder.name in card.inner_text())
    page_server.begin(memory=MemorySettings(seconds=0.0))
    tab.wait_for(lambda: tab.page.get_by_role("button", name=SAVE).count() == 0)
    tab.wait_for(card.is_hidden)  # its number would lead to another file
    tab.button("Record").click()
    stop.click()
    tab.wait_for(card.is_visible)
