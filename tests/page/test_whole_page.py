"""Pictures of the whole page, as people see it: a real viewer, in which time stands still."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import playwright.sync_api as playwright
import pytest
from playwright.sync_api import expect
from waiting import until

from tests.page.conftest import DISMISS
from tests.page.page_bench import PageBench, PageServer
from tests.page.still_pages import (
    FINE,
    FONT,
    FREEZE,
    HAS_FONT,
    STILL,
    TOLERANCE,
    StillClock,
    capture,
)
from tests.page.still_viewers import StillViewers, record, wait_until_drawn
from tests.page.tabs import ViewerTab
from webviz.commands import Pause, RemoveDisplay, Seek, SelectSpan, SetLayout, SetLoop, SetRate
from webviz.engine.parts.time import TimePart
from webviz.features.doctor import DoctorFeature
from webviz.features.recording import RecordingFeature
from webviz.files.config import DockedPanel, Layout
from webviz.files.config.model import MemorySettings
from webviz.shell.pictures.browser import Pixels
from webviz.shell.testing import share_of_difference
from webviz.shell.testing.pictures import ReferenceImages

DESK, PHONE = (1280, 800), (390, 844)
HAS_MAP = """async () => {
  const { nodes } = await import("webviz/viser_page.js");
  let isDecoded = false;
  for (const node of Object.values(nodes())) {
    node?.traverse((object) => (isDecoded ||= Boolean(object.material?.map)));
  }
  return isDecoded;
}"""
HEARD = """async () => {
  const { on } = await import("webviz/channel.js");
  await new Promise((resolve) => on("Heartbeat", resolve));
}"""
"""Returns when the server has been heard."""
FITS = "canvas => canvas.clientWidth === document.getElementById('root').clientWidth"
MEMORY = MemorySettings(seconds=60.0, megabytes=256.0)
"""A memory that is as large on each machine."""
ARRANGED = Layout(
    beside=(DockedPanel(panel="doctor"), DockedPanel(panel="tools", weight=2)),
    below=(DockedPanel(panel="topics"),),
    height=200,
)


@pytest.fixture(scope="module")
def clock() -> Iterator[StillClock]:
    """The clocks of the machine, which stand still."""
    clock = StillClock()
    with pytest.MonkeyPatch.context() as patch:
        clock.hold(patch)
        # Checks of this machine would find other problems on each.
        patch.setattr("webviz.features.doctor.known_checks", tuple)
        yield clock


@pytest.fixture(scope="module")
def page_server(browser: playwright.Browser, clock: StillClock) -> Iterator[PageServer]:
    """A server of this module, since its last test stops it."""
    page_server = PageServer()
    yield page_server
    page_server.close()


@pytest.fixture(scope="module")
def viewers(page_server: PageServer, clock: StillClock) -> Iterator[StillViewers]:
    """Starts the viewers."""
    viewers = StillViewers(page_server, clock)
    yield viewers
    viewers.close()


@pytest.fixture(scope="module")
def lasting_desk(open_lasting_viewer_tab: Callable[..., ViewerTab]) -> ViewerTab:
    """A tab in which no time passes."""
    return still(open_lasting_viewer_tab(*DESK, **FINE, color_scheme="dark", resolution=1))


@pytest.fixture
def desk(page_server: PageServer, lasting_desk: ViewerTab) -> ViewerTab:
    """The same with nothing selected: a page selects the rows of one viewer in the next, too."""
    page_server.begin(is_linked=False)
    lasting_desk.wait_for(lambda: rows(lasting_desk) <= 1)
    return lasting_desk


def still(tab: ViewerTab) -> ViewerTab:
    """A tab in which no time passes any more."""
    if not tab.page.evaluate(HAS_FONT):
        pytest.skip(f"needs the font {FONT}: install fonts-dejavu-core")
    tab.page.evaluate(FREEZE)
    tab.page.add_style_tag(content=STILL)
    return tab


@pytest.fixture
def references(request: pytest.FixtureRequest) -> ReferenceImages:
    """The reference pictures beside this module."""
    root = request.config.rootpath
    update = bool(request.config.getoption("--update-pictures"))
    return ReferenceImages(Path(__file__).parent / "pictures", root / "tests/output", root, update)


def settle(tab: ViewerTab, page_server: PageServer) -> None:
    """Wait until everything is drawn, and nothing on the page is pointed at."""
    point_at_nothing(tab)
    tab.page.evaluate("document.activeElement.blur()")
    wait_until_drawn(tab.viewer)
    page_server.scene.acknowledge(timeout=60.0)  # the map is encoded in another thread
    tab.wait_for(lambda: tab.page.evaluate(HAS_MAP))
    tab.page.evaluate(HEARD)


def point_at_nothing(tab: ViewerTab) -> None:
    """Move the mouse away."""
    tab.page.mouse.move(900, 300)
    tab.page.mouse.move(5, 795)


def picture(tab: ViewerTab) -> Pixels:
    """The page without toasts, which go by themselves after a while."""
    tab.catch_up()
    tab.page.evaluate(DISMISS)
    expect(tab.page.locator(".wv-toast")).to_have_count(0)
    return capture(tab)


def look_back(viewer: PageBench, ago_s: float) -> None:
    """Show what was some seconds ago."""
    playback = viewer.playback
    viewer.do(Seek((playback.end_ns - playback.start_ns) / 1e9 - ago_s))


def examine(viewer: PageBench) -> None:
    """Let the doctor examine what is shown, which it does each second of a clock that goes on."""
    doctor = viewer.viewer.get(DoctorFeature)
    doctor.hasten()
    until(lambda: doctor.examined_ns == viewer.viewer.get(TimePart).shown_ns, turn=viewer.turn)


def rows(tab: ViewerTab) -> int:
    """Return the number of rows of the tree."""
    return tab.page.get_by_role("treeitem").count()


def test_the_page_is_as_in_its_pictures_and_a_missing_row_or_another_color_shows(
    viewers: StillViewers, page_server: PageServer, desk: ViewerTab, references: ReferenceImages
) -> None:
    tab, viewer = desk, viewers.begin()
    tab.wait_for(lambda: rows(tab) == 7)
    settle(tab, page_server)
    dark = references.check("dark", picture(tab), tolerance=TOLERANCE)

    style = "document.querySelector('#webviz').style"
    tab.page.evaluate(f"{style}.setProperty('--wv-warn', '#45b078')")
    assert share_of_difference(picture(tab), dark) > TOLERANCE
    tab.page.evaluate(f"{style}.removeProperty('--wv-warn')")

    tab.page.emulate_media(color_scheme="light")
    references.check("light", picture(tab), tolerance=TOLERANCE)
    tab.page.emulate_media(color_scheme="dark")

    viewer.do(RemoveDisplay(viewer.id("Plan")))
    tab.wait_for(lambda: rows(tab) == 6)
    assert share_of_difference(picture(tab), dark) > TOLERANCE


def test_an_error_is_said_in_the_tree_and_beside_the_properties(
    viewers: StillViewers, page_server: PageServer, desk: ViewerTab, references: ReferenceImages
) -> None:
    tab, _ = desk, viewers.begin(frame="front_laser")
    settle(tab, page_server)
    tab.page.get_by_role("treeitem", name="Front scan").click()
    expect(tab.page.get_by_role("region", name="Properties", exact=True)).to_be_visible()
    point_at_nothing(tab)
    references.check("error", picture(tab), tolerance=TOLERANCE)


def test_a_bag_is_played(
    viewers: StillViewers,
    page_server: PageServer,
    desk: ViewerTab,
    references: ReferenceImages,
    tmp_path: Path,
) -> None:
    tab, viewer = desk, viewers.play(record(tmp_path / "run.mcap"))
    for command in (Seek(37.25), SelectSpan(10.0, 80.0), SetLoop(True), SetRate(2.0), Pause(False)):
        viewer.do(command)
    tab.wait_for(lambda: tab.button("Topics").count() == 1)
    settle(tab, page_server)
    tab.page.get_by_role("treeitem", name="Front scan").click()
    tab.button("Topics").click()
    tab.wait_for(lambda: tab.page.get_by_role("option", name="/scan").count() == 1)
    point_at_nothing(tab)
    references.check("timeline", picture(tab), tolerance=TOLERANCE)
    tab.button("Topics").click()


def test_live_topics_that_are_recorded(
    viewers: StillViewers,
    page_server: PageServer,
    desk: ViewerTab,
    references: ReferenceImages,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    # Where flushes cut the data, and thereby its size, depends on how busy the machine is.
    monkeypatch.setattr("webviz.sources.recording.recorder.FLUSH_S", 3600.0)
    tab, viewer = desk, viewers.begin(memory=MEMORY, recorded_s=42.0)
    settle(tab, page_server)
    recording = viewer.viewer.get(RecordingFeature)
    tab.wait_for(lambda: recording.state()["recording"].messages == viewers.recorded)
    tab.page.get_by_role("treeitem", name="Front scan").click()
    point_at_nothing(tab)
    expect(tab.button("Stop recording")).to_contain_text("0:00:42")
    references.check("recording", picture(tab), tolerance=TOLERANCE)


def test_live_topics_are_rewound(
    viewers: StillViewers, page_server: PageServer, desk: ViewerTab, references: ReferenceImages
) -> None:
    tab, viewer = desk, viewers.begin(memory=MEMORY)
    look_back(viewer, 12.4)
    tab.wait_for(tab.page.locator(".wv-rewound-banner").is_visible)
    settle(tab, page_server)
    references.check("rewound", picture(tab), tolerance=TOLERANCE)

    examine(viewer)
    viewer.do(SetLayout(ARRANGED))
    tab.wait_for(lambda: tab.page.locator(".wv-docked").count() == 3)
    tab.wait_for(lambda: tab.page.locator("canvas[data-engine]").evaluate(FITS))
    references.check("layout", picture(tab), tolerance=TOLERANCE)


def test_on_a_phone_the_scene_is_free_until_the_side_lies_over_it(
    viewers: StillViewers,
    page_server: PageServer,
    open_viewer_tab: Callable[..., ViewerTab],
    references: ReferenceImages,
) -> None:
    options: dict[str, Any] = {"has_touch": True, "is_mobile": True, "color_scheme": "dark"}
    phone = still(open_viewer_tab(*PHONE, **FINE, **options, resolution=1))
    viewers.begin()
    settle(phone, page_server)
    references.check("phone", picture(phone), tolerance=TOLERANCE)

    phone.button("Show the panels").tap()
    phone.wait_for(lambda: rows(phone) == 7)
    references.check("phone_with_panels", picture(phone), tolerance=TOLERANCE)
    phone.button("Hide the panels").tap()

    look_back(viewers.begin(memory=MEMORY), 12.4)
    phone.wait_for(phone.page.locator(".wv-rewound-banner").is_visible)
    settle(phone, page_server)
    references.check("phone_rewound", picture(phone), tolerance=TOLERANCE)


def test_a_lost_connection_greys_the_page_and_says_so(
    viewers: StillViewers, page_server: PageServer, desk: ViewerTab, references: ReferenceImages
) -> None:
    """The last test of this module, since the server is gone then."""
    viewers.begin()
    desk.wait_for(lambda: rows(desk) == 7)
    settle(desk, page_server)
    page_server.server.stop()
    desk.page.evaluate("setTime(1_764_000_012_000)")
    expect(desk.page.locator(".wv-contact")).to_be_visible()
    references.check("connection_lost", capture(desk), tolerance=TOLERANCE)
    desk.page.close()
    desk.errors.clear()  # Chromium's, that there is no server
