"""Panels of a working day as people see them, with the pictures of their documentation."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.page.opened_panels import open_panel
from tests.page.page_bench import PageBench
from tests.page.still_pages import FINE, FONT, FREEZE, HAS_FONT, STILL, TOLERANCE, capture
from webviz.api.declared import make
from webviz.files.config import Item
from webviz.files.config.model import MemorySettings
from webviz.panels.diagnostics import Diagnostics
from webviz.panels.graph import NodeGraph
from webviz.panels.log import Log
from webviz.panels.plot import Plot
from webviz.shell.testing.pictures import ReferenceImages
from webviz.sources import Endpoint, Offer, Publisher
from webviz_displays.laser_scan import LaserScan
from webviz_displays.odometry import Odometry

SIZE = WIDTH, _ = 620, 460
"""Size of a picture."""
NUMBER = "std_msgs/msg/Float64"
LOG, ARRAY = "rcl_interfaces/msg/Log", "diagnostic_msgs/msg/DiagnosticArray"
SCAN, ODOMETRY = "sensor_msgs/msg/LaserScan", "nav_msgs/msg/Odometry"
WIDE = f"document.documentElement.style.setProperty('--wv-width', '{WIDTH}px')"

Compare = Callable[..., None]


@pytest.fixture
def compare(
    viewer: PageBench,
    open_viewer_tab: Callable[..., Any],
    request: pytest.FixtureRequest,
    monkeypatch: pytest.MonkeyPatch,
) -> Compare:
    """Compare a panel with its picture: `compare(name, panel, fill, *displays)`."""
    # A picture that takes longer would end the curves.
    monkeypatch.setattr("webviz.panels.plot.CLOSED_S", 60.0)
    # Checks of this machine would find other problems on each.
    monkeypatch.setattr("webviz.features.doctor.known_checks", tuple)
    root = request.config.rootpath
    update = bool(request.config.getoption("--update-pictures"))
    references = ReferenceImages(
        Path(__file__).parent / "pictures", root / "tests/output", root, update
    )
    tab = open_viewer_tab(WIDTH + 300, SIZE[1], **FINE, color_scheme="light")
    if not tab.page.evaluate(HAS_FONT):
        pytest.skip(f"needs the font {FONT}: install fonts-dejavu-core")
    tab.page.evaluate(FREEZE)
    tab.page.add_style_tag(content=STILL)
    tab.page.evaluate(WIDE)

    def compare(name: str, panel: Any, fill: Callable[[], object], *displays: Item) -> None:
        viewer.show()
        tab.wait_for(lambda: tab.page.locator(".wv-plugin-widgets").count() == 0)
        open_panel(tab, panel, *displays, memory=MemorySettings(seconds=0.0))
        tab.turn()
        fill()
        time = tab.page.locator(".wv-ros-time")
        tab.wait_for(lambda: "." in time.inner_text())  # which stands still
        references.check(name, capture(tab)[:, :WIDTH], tolerance=TOLERANCE)

    return compare


def offer(type_: str, *publishers: str, to: tuple[str, ...] = ()) -> Offer:
    """Publishers of best effort, and subscriptions that ask for that."""
    volatile: Any = ("best_effort", "volatile")
    readers = tuple(Endpoint(each, type_, *volatile) for each in to)
    return Offer(tuple(Publisher(each, type_, *volatile) for each in publishers), readers=readers)


def test_the_graph_is_as_in_its_picture(viewer: PageBench, compare: Compare) -> None:
    asking: Any = ("reliable", "volatile")
    scan = offer(SCAN, "/laser", to=("/amcl",))
    costmap = Endpoint("/costmap", SCAN, *asking)
    viewer.source.topics = {
        "/scan": Offer(scan.publishers, readers=(*scan.readers, costmap)),
        "/odom": offer(ODOMETRY, "/base", to=("/amcl", "/controller")),
        "/amcl_pose": offer(NUMBER, "/amcl", to=("/planner",)),
        "/plan": offer(NUMBER, "/planner", to=("/controller",)),
        "/cmd_vel": offer(NUMBER, "/controller", to=("/base",)),
    }

    def drive() -> None:
        for _ in range(40):
            viewer.pass_time(0.1)
            for topic, type_ in (("/scan", SCAN), *[("/odom", ODOMETRY)] * 3):
                viewer.publish(topic, type_, {})
            viewer.turn()

    compare("panel_graph", make(NodeGraph, {}), drive, LaserScan(name="a"), Odometry(name="b"))


def test_the_log_is_as_in_its_picture(viewer: PageBench, compare: Compare) -> None:
    lines = (
        (20, "map_server", "Read the map building.yaml"),
        (20, "amcl", "Initial pose: 0.000 0.000 0.000"),
        (30, "controller", "Control loop missed its desired rate of 20 Hz"),
        (40, "base", "The left motor does not respond"),
        (20, "planner", "Path of 4.2 m to the goal"),
    )

    def log() -> None:
        place = {"file": "drive.cpp", "function": "step", "line": 42}
        for at_s, (level, name, text) in enumerate(lines):
            line = {"stamp": {"sec": at_s}, "level": level, "name": name, "msg": text, **place}
            viewer.publish("/rosout", LOG, line)
        viewer.turn()

    viewer.offer("/rosout", LOG, "/robot")
    compare("panel_log", make(Log, {}), log)


def test_diagnostics_are_as_in_their_picture(viewer: PageBench, compare: Compare) -> None:
    def report() -> None:
        for at_s in range(8):
            load = {"key": "load", "value": f"{2 + math.sin(at_s):.2f} A"}
            motor = {"name": "base: left motor", "level": 2, "message": "Hot", "values": [load]}
            arm = [{"name": f"arm: joint {i}", "message": "fine"} for i in range(4)]
            statuses = [motor, *arm, {"name": "laser", "level": 1}]
            viewer.publish("/diagnostics", ARRAY, {"status": statuses})
            viewer.turn()
            viewer.pass_time(1.0)
        viewer.turn()

    viewer.offer("/diagnostics", ARRAY, "/robot")
    compare("panel_diagnostics", make(Diagnostics, {}), report)


def test_a_plot_is_as_in_its_picture(viewer: PageBench, compare: Compare) -> None:
    topics = ("/speed", "/turn", "/voltage")
    curves = [f"{topic}.data" for topic in topics]

    def drive() -> None:
        for i in range(300):
            values = (0.4 + 0.1 * math.sin(i / 20), 20 * math.cos(i / 30), 12.1 - i / 900)
            for topic, value in zip(topics, values, strict=True):
                viewer.publish(topic, NUMBER, {"data": value})
            viewer.pass_time(0.1)
            if i % 50 == 49:
                viewer.turn()

    for topic in topics:
        viewer.offer(topic, NUMBER, "/base")
    compare("panel_plot", make(Plot, {"curves": curves, "own_axis": curves[1:]}), drive)
