"""Panels of a working day as people see them, with the pictures of their documentation."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.page.conftest import Tab
from tests.page.test_daily_panels import ARRAY, LOG, log_line, message, offered, open_panel
from tests.page.test_graph import offer, reader
from tests.page.test_whole_page import FINE, FONT, FREEZE, HAS_FONT, STILL, TOLERANCE, capture
from webviz.api.declared import make
from webviz.engine.state import PanelTimes, State, Traffic
from webviz.panels.diagnostics import Diagnostics
from webviz.panels.graph import NodeGraph
from webviz.panels.log import Log
from webviz.panels.plot import Plot
from webviz.shell.testing.pictures import ReferenceImages
from webviz.sources import Offer, Publisher

SIZE = WIDTH, _ = 620, 460
"""Size of a picture."""
SECOND = 10**9
NUMBER = "std_msgs/msg/Float64"
WIDE = f"document.documentElement.style.setProperty('--wv-width', '{WIDTH}px')"


@pytest.fixture
def taken(
    open_tab: Callable[..., Tab], request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch
) -> Callable[[str, Any], None]:
    """Compare a panel with its picture: `taken(name, panel, fill, **state)`."""
    # A picture that takes longer would end the curves.
    monkeypatch.setattr("webviz.panels.plot.CLOSED_S", 60.0)
    root = request.config.rootpath
    update = bool(request.config.getoption("--update-pictures"))
    references = ReferenceImages(
        Path(__file__).parent / "pictures", root / "tests/output", root, update
    )
    tab = open_tab(WIDTH + 300, SIZE[1], **FINE, color_scheme="light")
    if not tab.page.evaluate(HAS_FONT):
        pytest.skip(f"needs the font {FONT}: install fonts-dejavu-core")
    tab.page.evaluate(FREEZE)
    tab.page.add_style_tag(content=STILL)
    tab.page.evaluate(WIDE)

    def taken(
        name: str, panel: Any, fill: Callable[[], object] = lambda: None, **changes: Any
    ) -> None:
        tab.loop.state = State()
        open_panel(tab.loop, tab, panel, **changes)
        fill()
        references.check(name, capture(tab)[:, :WIDTH], tolerance=TOLERANCE)

    return taken


def test_panels_are_as_in_their_pictures(taken: Callable[..., None]) -> None:
    offers = {
        "/scan": offer("/laser", to=(reader("/amcl"), reader("/costmap", "reliable"))),
        "/odom": offer("/base", to=(reader("/amcl"), reader("/controller"))),
        "/amcl_pose": offer("/amcl", to=(reader("/planner"),)),
        "/plan": offer("/planner", to=(reader("/controller"),)),
        "/cmd_vel": offer("/controller", to=(reader("/base"),)),
    }
    traffic = {"/scan": Traffic(10.0, 100.0, None), "/odom": Traffic(30.0, 100.0, None)}
    taken("panel_graph", make(NodeGraph, {}), offers=offers, traffic=traffic)

    log = make(Log, {})
    lines = (
        (20, "map_server", "Read the map building.yaml"),
        (20, "amcl", "Initial pose: 0.000 0.000 0.000"),
        (30, "controller", "Control loop missed its desired rate of 20 Hz"),
        (40, "base", "The left motor does not respond"),
        (20, "planner", "Path of 4.2 m to the goal"),
    )
    for at_s, line in enumerate(lines):
        log.take("/rosout", log_line(*line, at_s), at_s * SECOND)
    taken("panel_log", log, offers=offered(rosout=LOG))

    diagnostics = make(Diagnostics, {})
    for at_s in range(8):
        load = {"key": "load", "value": f"{2 + math.sin(at_s):.2f} A"}
        motor = {"name": "base: left motor", "level": 2, "message": "Hot", "values": [load]}
        arm = [{"name": f"arm: joint {i}", "message": "fine"} for i in range(4)]
        report = message(ARRAY, status=[motor, *arm, {"name": "laser", "level": 1}])
        diagnostics.take("/diagnostics", report, at_s * SECOND)
    clock = PanelTimes(ros_ns=8 * SECOND)
    taken("panel_diagnostics", diagnostics, offers=offered(diagnostics=ARRAY), clock=clock)

    curves = ["/speed.data", "/turn.data", "/voltage.data"]
    plot = make(Plot, {"curves": curves, "own_axis": curves[1:]})
    publisher = Publisher("/base", NUMBER, "reliable", "volatile")
    topics = {each.removesuffix(".data"): Offer((publisher,)) for each in curves}

    def drive() -> None:
        for i in range(300):
            values = (0.4 + 0.1 * math.sin(i / 20), 20 * math.cos(i / 30), 12.1 - i / 900)
            for topic, value in zip(topics, values, strict=True):
                plot.take(topic, message(NUMBER, data=value), i * SECOND // 10)

    taken("panel_plot", plot, drive, offers=topics, clock=PanelTimes(ros_ns=30 * SECOND))
