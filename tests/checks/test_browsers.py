"""Faults of browsers and of what they show, provoked with real ones."""

from __future__ import annotations

import contextlib
import threading
from collections.abc import Iterator, Mapping
from typing import Any

import building
import numpy as np
import playwright.sync_api as playwright
import pytest
from pages import COARSE

from webviz.api import registry
from webviz.api.finding import CauseLevel, Finding, Severity
from webviz.api.views import Orbit, View
from webviz.checks.browser import no_webgl, throttled_tab, viewer_behind
from webviz.commands import AddDisplay, InspectLatency, RemoveDisplay, SetProperty, ShowView
from webviz.data.messages import encode
from webviz.engine import examiner
from webviz.features.latency.stages import BrowserLatency
from webviz.files.config import Config
from webviz.files.opening import parse
from webviz.shell.app.running import Running
from webviz.shell.pictures.browser import FLAGS, Page, executable_of
from webviz.shell.testing.messages import header, stamped_transform
from webviz.shell.testing.source import HandFedSource

CONFIG = """\
view: {type: Orbit, distance: 10}
fixed_frame: map
displays:
- {type: Axes, name: Origin}
"""
SLOW = """
import time
from typing import Annotated
from webviz import Display, Input, Topic

class SlowDisplay(Display):
    topic: Annotated[Topic, Input("sensor_msgs/msg/LaserScan")] = Topic("/scan")

    def draw(self, samples, ctx):
        until = time.thread_time() + 0.1
        while time.thread_time() < until:
            pass
        ctx.ok("Slow", "Drawn.")
"""
SCAN = "sensor_msgs/msg/LaserScan"
GRID = "nav_msgs/msg/OccupancyGrid"
CLOUD = "sensor_msgs/msg/PointCloud2"
TF = "tf2_msgs/msg/TFMessage"
FIELDS = (("x", 0, 7, 1), ("y", 4, 7, 1), ("z", 8, 7, 1))
"""Name, offset, type and count of those of clouds."""
PATIENCE_S = 30.0


def read(*_: object) -> Config:
    """The config of the viewer."""
    return parse(CONFIG, "x.yaml")


class PageDoctor:
    """A viewer with a browser, and the findings of its doctor."""

    def __init__(self, viewer: Running, source: HandFedSource, browser: playwright.Browser) -> None:
        self.viewer = viewer
        self.source = source
        self.page = Page(browser, viewer.url, 600, 500, resolution=COARSE)
        self.page.wait_for(lambda: viewer.state.views, "the report of its view")

    def findings(self) -> Mapping[str, Finding]:
        """The newest findings by id and subject."""
        levels = CauseLevel.VIEW, CauseLevel.BROWSER
        all = (each for each in self.viewer.state.findings if each.level in levels)
        return {each.id: each for each in all}

    def wait(self, id: str, is_there: bool = True) -> Finding | None:
        """Wait for a finding, or until it is gone; one whose cause comes and goes may be short."""
        looks: list[Finding | None] = []

        def is_so() -> bool:
            looks.append(self.findings().get(id))
            return (looks[-1] is not None) == is_there

        try:
            self.page.wait_for(is_so, id, PATIENCE_S)
        except TimeoutError:
            pytest.fail(f"{id}: {self.findings()}")
        return looks[-1]

    def look(self, view: View) -> None:
        """Move all cameras."""
        self.viewer.do(ShowView(view))

    def add(self, type: str, **values: Any) -> str:
        """Add a display; its id."""
        ids: list[str] = []
        self.viewer.do(AddDisplay(type, values, made=ids.append))
        return ids[0]

    def put(self, topic: str, type: str, frame: str, values: Mapping[str, Any]) -> None:
        """Receive a message."""
        stamped = {"header": header(frame, self.source.now), **values}
        self.source.put(topic, type, encode(type, stamped))

    def transform(self, child: str, x: float) -> None:
        """Receive a static transform from the map."""
        link = stamped_transform("map", child, self.source.now, (x, 0.0, 0.0))
        values = {"transforms": [link]}
        self.source.put("/tf_static", "tf2_msgs/msg/TFMessage", encode(TF, values))


@pytest.fixture(scope="module")
def viewer(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[Running, HandFedSource]]:
    plugin = tmp_path_factory.mktemp("plugin") / "slow.py"
    plugin.write_text(SLOW)
    source = HandFedSource()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("webviz.features.doctor.EVERY_S", 0.1)
        patch.setattr(examiner, "SLICE_S", 1.0)
        running = Running(port=0, source=source, read=read, plugins=[plugin])
        yield running, source
        running.close()
        registry.register(str(plugin), {})  # other tests list all displays


@pytest.fixture(scope="module")
def doctor(
    viewer: tuple[Running, HandFedSource], browser: playwright.Browser
) -> Iterator[PageDoctor]:
    doctor = PageDoctor(*viewer, browser)
    doctor.transform("base", 0.0)
    yield doctor
    doctor.page.close()


def test_displays_outside_the_view(doctor: PageDoctor) -> None:
    away = Orbit(focal_point=(0.0, 5000.0, 0.0), distance=10.0)
    doctor.look(away)
    finding = doctor.wait("VIEW004")
    assert finding is not None
    assert finding.severity is Severity.WARNING
    assert finding.cause == "The camera looks at nothing: all displays are outside the view."
    doctor.look(Orbit())
    doctor.wait("VIEW004", False)
    axes = next(row.id for row in doctor.viewer.state.rows if row.name == "Origin")
    doctor.viewer.do(SetProperty(axes, "length", 0.001))
    doctor.viewer.do(SetProperty(axes, "radius", 0.0001))
    finding = doctor.wait("VIEW003")
    assert finding is not None
    assert "less than a pixel" in finding.cause
    doctor.viewer.do(SetProperty(axes, "length", 1.0))
    doctor.wait("VIEW003", False)
    doctor.transform("far", 3e5)
    doctor.viewer.do(SetProperty(axes, "length", 9e3))
    doctor.viewer.do(SetProperty(axes, "reference_frame", "far"))
    doctor.look(Orbit(focal_point=(5.0, 0.0, 0.0), yaw=np.pi, pitch=0.0))
    finding = doctor.wait("VIEW005")
    assert finding is not None
    assert "km away" in finding.cause
    doctor.viewer.do(SetProperty(axes, "reference_frame", "map"))
    doctor.viewer.do(SetProperty(axes, "length", 1.0))
    doctor.wait("VIEW005", False)
    doctor.look(Orbit())


def test_a_map_below_an_opaque_one(doctor: PageDoctor) -> None:
    doctor.add("Map", topic={"name": "/costmap"}, alpha=0.7)
    upper = doctor.add("Map", topic={"name": "/map"}, alpha=1.0)
    doctor.page.wait_for(lambda: "/map" in doctor.source.subscriptions)
    doctor.put("/costmap", GRID, "map", building.grid())
    doctor.put("/map", GRID, "map", building.grid())
    finding = doctor.wait("VIEW006")
    assert finding is not None
    assert finding.button is not None
    doctor.viewer.do(SetProperty(upper, "alpha", 0.7))
    doctor.wait("VIEW006", False)


def test_a_browser_without_a_graphics_card(doctor: PageDoctor) -> None:
    finding = doctor.wait("WEB002")
    assert finding is not None
    assert "SwiftShader" in str(finding.evidence["renderer"])
    assert finding.severity is Severity.NOTE, "all is drawn, only slowly"


def test_a_page_that_hangs(doctor: PageDoctor, monkeypatch: pytest.MonkeyPatch) -> None:
    assert "WEB003" not in doctor.findings()
    monkeypatch.setattr(throttled_tab, "FROZEN_S", 6.5)
    dialogs: list[playwright.Dialog] = []

    def hear(dialog: playwright.Dialog) -> None:
        dialogs.append(dialog)

    doctor.page.tab.on("dialog", hear)
    # Until it is answered, the page stands still, without a processor that is busy with it.
    doctor.page.tab.evaluate("setTimeout(() => alert('wait'))")
    finding = doctor.wait("WEB003")
    assert finding is not None
    assert "has been silent for" in finding.cause
    (dialog,) = dialogs
    dialog.accept()
    doctor.page.tab.remove_listener("dialog", hear)
    doctor.wait("WEB003", False)


def test_a_viewer_that_cannot_keep_up(doctor: PageDoctor, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(viewer_behind, "OWN", 0.02)  # other tests want a core, too
    slow = doctor.add("SlowDisplay")
    ended = threading.Event()

    def publish() -> None:
        while not ended.wait(0.02):
            doctor.source.now += 20_000_000
            doctor.put("/scan", SCAN, "map", {"ranges": [1.0], "range_max": 2.0})

    thread = threading.Thread(target=publish)
    thread.start()
    try:
        finding = doctor.wait("WEB006")
    finally:
        ended.set()
        thread.join()
    assert finding is not None
    assert "SlowDisplay" in finding.cause
    assert finding.evidence["SlowDisplay"]
    doctor.viewer.do(SetProperty(slow, "enabled", False))
    doctor.wait("WEB006", False)


def publish_points(doctor: PageDoctor, count: int) -> None:
    """Receive a cloud of random points."""
    names = ("name", "offset", "datatype", "count")
    xyz = np.random.default_rng(doctor.source.now).uniform(-3.0, 3.0, (count, 3)).astype(np.float32)
    values = {
        "height": 1,
        "width": count,
        "fields": [dict(zip(names, each, strict=True)) for each in FIELDS],
        "point_step": 12,
        "row_step": 12 * count,
        "data": xyz.view(np.uint8).ravel(),
        "is_dense": True,
    }
    doctor.put("/points", CLOUD, "map", values)


def test_clouds_that_are_too_large_for_a_browser(doctor: PageDoctor) -> None:
    doctor.add("PointCloud2", topic={"name": "/points"})
    doctor.page.wait_for(lambda: "/points" in doctor.source.subscriptions)
    publish_points(doctor, 2_000_000)
    finding = doctor.wait("WEB005")
    assert finding is not None
    assert finding.cause.startswith("The clouds have 2 000 000 points, most of them PointCloud2")
    publish_points(doctor, 1000)
    doctor.wait("WEB005", False)


def test_the_way_of_samples_to_the_screen(doctor: PageDoctor) -> None:
    cloud = doctor.add("PointCloud2", topic={"name": "/points"})
    doctor.page.wait_for(lambda: "/points" in doctor.source.subscriptions)
    doctor.viewer.do(InspectLatency())

    def ways() -> list[BrowserLatency]:
        doctor.source.now += 10_000_000
        publish_points(doctor, 1000)
        latencies = [each for each in doctor.viewer.state.latencies if each.id == cloud]
        return [to for each in latencies for to in each.browsers if to.stages]

    doctor.page.wait_for(lambda: any(to.bytes_per_s for to in ways()), "the way")
    to = ways()[0]
    assert [stage.name for stage in to.stages] == ["acknowledged", "painted"]
    assert to.stages[1].p99 > 0.0
    assert to.name == "the browser of 127.0.0.1"
    assert to.p99 >= to.p50 >= to.stages[0].p50 + to.stages[1].p50 / 2
    doctor.viewer.do(InspectLatency(is_wanted=False))
    assert doctor.viewer.state.latencies == ()
    doctor.viewer.do(RemoveDisplay(cloud))


def test_a_slow_link(browser: playwright.Browser) -> None:
    source = HandFedSource()
    with contextlib.closing(Running(port=0, source=source, read=read, link="1Mbit/s")) as viewer:
        doctor = PageDoctor(viewer, source, browser)
        doctor.transform("base", 0.0)
        doctor.add("PointCloud2", topic={"name": "/points"})
        doctor.page.wait_for(lambda: "/points" in source.subscriptions)

        def reduced() -> Finding | None:
            source.now += 10**8  # another cloud: one that stays is sent whole
            publish_points(doctor, 50_000)
            return doctor.findings().get("WEB004")

        finding = doctor.page.wait_for(reduced, "the finding", 2 * PATIENCE_S)
        assert finding is not None
        assert "clouds show every" in finding.cause
        doctor.page.wait_for(lambda: "WEB004" not in doctor.findings(), "its end", PATIENCE_S)
        doctor.page.close()


def test_a_browser_without_webgl(doctor: PageDoctor, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(no_webgl, "PATIENCE_S", 2.0)
    browser = doctor.page.tab.context.browser
    assert browser is not None
    kind = browser.browser_type
    flags = [FLAGS[0], "--disable-3d-apis"]
    bare = kind.launch(executable_path=executable_of(kind), args=flags)
    try:
        tab = bare.new_page()
        tab.goto(doctor.viewer.url)
        notice = tab.get_by_role("alert").filter(has_text="webviz needs WebGL 2")
        playwright.expect(notice).to_be_visible()
        finding = doctor.wait("WEB001")
    finally:
        bare.close()
    assert finding is not None
    assert finding.severity is Severity.ERROR
    doctor.wait("WEB001", False)
