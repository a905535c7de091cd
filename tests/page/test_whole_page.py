"""Pictures of the whole page, as people see it.

A mask covers what differs from moment to moment. Letters are drawn in the font `FONT`.
"""

from __future__ import annotations

import io
import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import building
import numpy as np
import PIL.Image
import pytest
from msgspec.structs import replace

from tests.page.conftest import Loop, Tab
from tests.page.trees import group
from webviz.api.declared import Topic
from webviz.api.nodes import Image, Points, Pose
from webviz.api.status import Level, Status
from webviz.api.views import Orbit
from webviz.engine.state import ClockRate, ConfigFile, PanelTimes, Row, State, Traffic
from webviz.features.recording import MemoryState, RecordingState
from webviz.features.tools.toolbar import ToolButton
from webviz.files.config import DockedPanel, Layout, Settings
from webviz.scene import ViserScene, open_server
from webviz.scene.adapter import greeting
from webviz.scene.server import Server
from webviz.shell.pictures.browser import Pixels
from webviz.shell.testing import share_of_difference
from webviz.shell.testing.pictures import ReferenceImages
from webviz.sources import Offer, Publisher
from webviz.sources.past_state import Event, PlaybackState
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.path import Path as PathDisplay
from webviz_displays.robot_model import RobotModel
from webviz_sim.pose import Pose2D

DESK, PHONE = (1280, 800), (390, 844)
FINE: dict[str, Any] = {"timezone_id": "UTC", "locale": "en-US", "smooth": True}
TOLERANCE = 0.0001
"""Share of pixels that may differ: less than the dot of a row that has another colour."""
FONT = "DejaVu Sans"
STILL = f"""
  * {{ transition: none !important; animation: none !important; caret-color: transparent !important;
    font-family: "{FONT}", sans-serif !important }}
  .wv-rates {{ width: 110px; min-width: 0; height: 28px; visibility: hidden }}
"""
FREEZE = "window.setTime = (ms) => { Date.now = () => ms }; setTime(1_764_000_000_000)"
HAS_MAP = """async () => {
  const { nodes } = await import("webviz/viser_page.js");
  let isDecoded = false;
  for (const node of Object.values(nodes())) {
    node?.traverse((object) => (isDecoded ||= Boolean(object.material?.map)));
  }
  return isDecoded;
}"""
HAS_FONT = f"""() => {{
  const pen = document.createElement("canvas").getContext("2d");
  const width = (fallback) => {{
    pen.font = `40px "{FONT}", ${{fallback}}`;
    return pen.measureText("Wide Il1").width;
  }};
  return width("serif") === width("monospace");
}}"""
START_NS = 1_764_000_000_000_000_000
SCAN = "sensor_msgs/msg/LaserScan"
LOST = {"Topic": Status(Level.ERROR, "No publisher on /scan. Start the laser driver.")}
FEW = {"Joints": Status(Level.WARN, "No joint state for gripper_link.")}
TOOLS = (
    ToolButton("goal", "2D Goal Pose", "Send the robot to a pose.", "g", "pose"),
    ToolButton("point", "Publish Point", "Publish a point.", "u", "point"),
)

BAG: dict[str, Any] = {
    "playback": PlaybackState(
        names=("run.mcap",),
        start_ns=START_NS,
        end_ns=START_NS + 100 * 10**9,
        position_s=37.25,
        rate=2.0,
        is_playing=True,
        is_seeking=False,
        loop=True,
        selected=(10.0, 80.0),
    ),
    "recorded": {
        "/map": [1] + [0] * 499,
        "/odom": [20] * 500,
        "/scan": [10] * 200 + [0] * 50 + [4] * 250,
    },
    "settings": Settings(bookmarks={"lost": START_NS / 1e9 + 55.0}),
}
"""A bag that is played."""

ARRANGED = Layout(
    beside=(DockedPanel(panel="doctor"), DockedPanel(panel="tools", weight=2)),
    below=(DockedPanel(panel="topics"),),
    height=200,
)
LIVE: dict[str, Any] = {
    "playback": PlaybackState(
        names=(),
        start_ns=START_NS - 90 * 10**9,
        end_ns=START_NS,
        position_s=90.0,
        rate=1.0,
        is_playing=False,
        is_seeking=False,
        loop=False,
        selected=None,
        first_s=30.0,
        is_live=True,
        counted=(30.0, 89.0),
    ),
    "recorded": {"/odom": [20] * 59, "/scan": [10] * 20 + [0] * 10 + [40] * 29},
    "logged": (Event(START_NS - 25 * 10**9, Level.ERROR, "amcl", "lost track"),),
    "memory": MemoryState(60.0, 212_000_000),
    "recording": RecordingState(
        path=Path("run"), seconds=42.0, messages=4000, size=12_300_000, dropped=0
    ),
}
"""Live topics that are recorded."""
PAST: dict[str, Any] = {
    **LIVE,
    "playback": replace(LIVE["playback"], is_live=False, position_s=77.6),
    "recording": None,
    "clock": PanelTimes(START_NS - 12_400_000_000, wall_s=START_NS / 1e9, is_paused=True),
}
"""12.4 s ago."""


def rows(scan: dict[str, Status] | None = None) -> tuple[Row, ...]:
    """Six displays, two of them in a group."""
    displays = (
        (Grid(name="Grid"), 0, {}),
        (Map(name="Map"), 0, {}),
        (RobotModel(name="RobotModel"), 0, FEW),
        (LaserScan(name="Front scan", topic=Topic("/scan")), 1, scan or {}),
        (PathDisplay(name="Plan", enabled=False), 1, {}),
    )
    made = [
        Row(f"d{i}", type(one).__name__, one, one.name, statuses, depth, one.enabled)
        for i, (one, depth, statuses) in enumerate(displays)
    ]
    return (
        *made[:3],
        group("Sensors", statuses={"Front scan": LOST["Topic"]} if scan else {}),
        *made[3:],
    )


def show(tab: Tab, scan: dict[str, Status] | None = None) -> None:
    """Show a viewer in which nothing moves, with these statuses of its scan."""
    browser = tab.page.evaluate("window.webviz.browser")
    offer = Offer((Publisher("/driver", SCAN, "best_effort", "volatile"),))
    tab.loop.of_features.clear()
    tab.loop.state = State()
    tab.loop.change(
        rows=rows(scan),
        views={browser: Orbit()},
        offers={"/scan": offer},
        topics={"/scan": (SCAN,)},
        traffic={"/scan": Traffic(39.84, 1e4)},
        frames=("base_link", "map"),
        file=ConfigFile("/home/me/lab.yaml", is_changed=True),
        tools=TOOLS,
        clock=PanelTimes(
            START_NS,
            int(83.2e9),
            START_NS / 1e9,
            83.2,
            clock_rate=ClockRate(START_NS, START_NS / 1e9),
        ),
    )


def draw(server: Server) -> None:
    """The map of the building, and a scan in it."""
    scene, world = ViserScene(server), building.WORLD
    height, width = world.cells.shape
    shade = np.where(world.cells == 100, 20, np.where(world.cells == 0, 200, 110))
    cells = np.dstack([shade, shade, shade, np.full_like(shade, 255)]).astype(np.uint8)
    size = world.resolution
    origin = Pose((world.origin.x, world.origin.y, 0.0))
    scene.upsert("d1/all/map|", "map", Image(cells, width * size, height * size), origin)
    ranges = np.asarray(building.scan(Pose2D(0.0, 0.0, 0.0))["ranges"], float)
    angles = np.linspace(-math.pi, math.pi, len(ranges), endpoint=False)
    hits = np.column_stack([ranges * np.cos(angles), ranges * np.sin(angles), 0.1 + 0 * ranges])
    hits = hits[np.isfinite(ranges)].astype(np.float32)
    scene.upsert("d3/all/laser|", "points", Points(hits, (255, 60, 30), 0.08), Pose())
    scene.flush()
    scene.acknowledge(timeout=60.0)  # the map is encoded in another thread


@pytest.fixture(scope="module")
def server() -> Iterator[Server]:
    """A server with something to see."""
    server = open_server(port=0)
    draw(server)
    yield server
    server.stop()


@pytest.fixture(scope="module")
def shared_loop(server: Server) -> Loop:
    """The loop of that server."""
    return Loop(server)


@pytest.fixture(scope="module", autouse=True)
def still_server() -> Iterator[None]:
    """Let the server's clock stand still, too, by which pages say how long something is ago."""
    clock = SimpleNamespace(time=lambda: START_NS / 1e9, monotonic=time.monotonic)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(greeting, "time", clock)
        yield


@pytest.fixture(scope="module")
def shared_desk(open_lasting_tab: Callable[..., Tab], still_server: None) -> Tab:
    """A tab in which no time passes."""
    return still(open_lasting_tab(*DESK, **FINE, color_scheme="dark", resolution=1))


@pytest.fixture
def desk(shared_desk: Tab) -> Tab:
    """The tab as it was at first."""
    tab = shared_desk
    tab.loop.state = State()
    tab.show_tab("Displays")
    tab.wait_for(lambda: tab.page.get_by_role("treeitem").count() == 1)  # so none is selected
    show(tab)
    tab.page.mouse.move(5, 795)
    tab.page.evaluate("document.activeElement.blur()")
    return tab


def still(tab: Tab) -> Tab:
    """A tab in which no time passes any more."""
    if not tab.page.evaluate(HAS_FONT):
        pytest.skip(f"needs the font {FONT}: install fonts-dejavu-core")
    tab.page.evaluate(FREEZE)
    tab.wait_for(lambda: tab.page.evaluate("window.webviz?.browser !== undefined"))
    show(tab)
    tab.page.add_style_tag(content=STILL)
    tab.wait_for(lambda: tab.page.evaluate(HAS_MAP))
    tab.wait_for(lambda: "lab.yaml" in tab.page.locator(".wv-file").inner_text())
    return tab


@pytest.fixture
def references(request: pytest.FixtureRequest) -> ReferenceImages:
    """The reference pictures beside this module."""
    root = request.config.rootpath
    update = bool(request.config.getoption("--update-pictures"))
    return ReferenceImages(Path(__file__).parent / "pictures", root / "tests/output", root, update)


def capture(tab: Tab) -> Pixels:
    """The page once nothing moves: two equal pictures in a row."""
    before = b""
    for _ in range(40):
        tab.turn()
        now = tab.page.screenshot()
        if now == before:
            with PIL.Image.open(io.BytesIO(now)) as image:
                return np.asarray(image.convert("RGB"))
        before = now
        tab.page.wait_for_timeout(150)
    raise AssertionError("The page does not stand still.")


def test_the_page_is_as_in_its_pictures_and_a_missing_row_or_another_color_shows(
    desk: Tab, references: ReferenceImages
) -> None:
    tab = desk
    tab.wait_for(lambda: tab.page.get_by_role("treeitem").count() == 7)
    dark = references.check("dark", capture(tab), tolerance=TOLERANCE)

    tab.page.evaluate("document.querySelector('#webviz').style.setProperty('--wv-warn', '#45b078')")
    assert share_of_difference(capture(tab), dark) > TOLERANCE
    tab.page.evaluate("document.querySelector('#webviz').style.removeProperty('--wv-warn')")
    tab.loop.show(*rows()[:-1])
    tab.wait_for(lambda: tab.page.get_by_role("treeitem").count() == 6)
    assert share_of_difference(capture(tab), dark) > TOLERANCE

    show(tab)
    tab.page.emulate_media(color_scheme="light")
    tab.wait_for(lambda: tab.page.get_by_role("treeitem").count() == 7)
    references.check("light", capture(tab), tolerance=TOLERANCE)

    tab.page.emulate_media(color_scheme="dark")
    show(tab, LOST)
    tab.page.get_by_role("treeitem", name="Front scan").click()
    tab.wait_for(lambda: "No publisher on /scan" in tab.text())
    tab.page.mouse.move(900, 300)
    tab.page.mouse.move(5, 795)
    references.check("error", capture(tab), tolerance=TOLERANCE)

    show(tab)
    tab.loop.state = replace(tab.loop.state, **BAG)
    tab.wait_for(lambda: tab.button("Topics").count() == 1)
    tab.button("Topics").click()
    tab.wait_for(lambda: tab.page.get_by_role("option", name="/scan").count() == 1)
    tab.page.mouse.move(5, 5)
    references.check("timeline", capture(tab), tolerance=TOLERANCE)
    tab.button("Topics").click()


def test_live_topics_that_are_recorded_and_rewound(desk: Tab, references: ReferenceImages) -> None:
    tab = desk
    tab.page.evaluate(HEARD)
    tab.loop.change(**LIVE)
    tab.wait_for(lambda: tab.page.get_by_role("button", name="Stop recording").count() == 1)
    references.check("recording", capture(tab), tolerance=TOLERANCE)
    tab.loop.change(**PAST)
    tab.wait_for(tab.page.locator(".wv-rewound-banner").is_visible)
    references.check("rewound", capture(tab), tolerance=TOLERANCE)

    tab.loop.state = replace(tab.loop.state, settings=Settings(layout=ARRANGED))
    tab.wait_for(lambda: tab.page.locator(".wv-docked").count() == 3)
    tab.wait_for(lambda: tab.page.locator("canvas[data-engine]").evaluate(FITS))
    references.check("layout", capture(tab), tolerance=TOLERANCE)


def test_on_a_phone_the_scene_is_free_until_the_side_lies_over_it(
    open_tab: Callable[..., Tab], references: ReferenceImages
) -> None:
    options = {"has_touch": True, "is_mobile": True, "color_scheme": "dark"}
    phone = still(open_tab(*PHONE, **FINE, **options, resolution=1))
    references.check("phone", capture(phone), tolerance=TOLERANCE)

    phone.page.evaluate(HEARD)
    phone.loop.change(**PAST)
    banner = phone.page.locator(".wv-rewound-banner")
    phone.wait_for(banner.is_visible)
    references.check("phone_rewound", capture(phone), tolerance=TOLERANCE)

    show(phone)
    phone.wait_for(banner.is_hidden)
    phone.button("Show the panels").tap()
    phone.wait_for(lambda: phone.page.get_by_role("treeitem").count() == 7)
    references.check("phone_with_panels", capture(phone), tolerance=TOLERANCE)


FITS = "canvas => canvas.clientWidth === document.getElementById('root').clientWidth"
HEARD = """async () => {
  const { on } = await import("webviz/channel.js");
  await new Promise((resolve) => on("Beat", resolve));
}"""
"""Returns when the server has been heard."""


def test_a_lost_connection_greys_the_page_and_says_so(
    desk: Tab, server: Server, references: ReferenceImages
) -> None:
    """The last test of this module, since the server is gone then."""
    desk.wait_for(lambda: desk.page.get_by_role("treeitem").count() == 7)
    desk.page.evaluate(HEARD)  # in the frozen time
    server.stop()
    desk.page.evaluate("setTime(1_764_000_012_000)")
    desk.page.locator(".wv-contact").wait_for()
    references.check("connection_lost", capture(desk), tolerance=TOLERANCE)
    desk.page.close()
    desk.errors.clear()  # Chromium's, that there is nobody
