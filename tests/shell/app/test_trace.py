"""Steps of a sample on its way to a browser, and their times."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Iterator
from itertools import pairwise

import playwright.sync_api as playwright
import pytest
from refusals import refusal_of
from waiting import until

import webviz
from tests.scene.conftest import Peer
from tests.support.guest import Served
from webviz.data.messages import encode
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import HandFedSource

PATH = "nav_msgs/msg/Path"
AGE_NS = 20_000_000


def publish(source: HandFedSource) -> None:
    """A path that was stamped 20 ms ago."""
    source.now = time.time_ns()
    poses = [{"pose": {"position": {"x": x}, "orientation": {"w": 1.0}}} for x in (0.0, 1.0)]
    stamped = header("map", source.now - AGE_NS)
    poses = [{"header": stamped, **pose} for pose in poses]
    source.put("/plan", PATH, encode(PATH, {"header": stamped, "poses": poses}))


@pytest.fixture
def published(source: HandFedSource) -> Iterator[None]:
    """Paths all the time."""
    stop = threading.Event()

    def run() -> None:
        while not stop.wait(0.05):
            publish(source)

    thread = threading.Thread(target=run)
    thread.start()
    yield
    stop.set()
    thread.join()


@pytest.mark.usefixtures("published")
def test_a_sample_passes_each_place_on_its_way_in_order(
    viewer: webviz.Viewer, browser: playwright.Browser
) -> None:
    plan = viewer.add("Path", topic="/plan", name="Plan")
    page = browser.new_page()
    try:
        page.goto(viewer.url)
        until(lambda: viewer.acknowledged(60))
        first, second = plan.trace(timeout=60), plan.trace(timeout=60)
    finally:
        page.close()
    times = first.times()
    names = ["published", "received", "ready", "decoded", "drawn", "sent", "acknowledged"]
    assert list(times) == names
    assert all(early <= late for early, late in pairwise(times.values()))
    assert times["received"] - times["published"] == AGE_NS
    assert str(first).startswith("published +0.0 ms, received +20.0 ms, ready +")
    assert second.number > first.number
    assert second.received_ns > first.received_ns


@pytest.mark.usefixtures("published")
def test_a_page_that_still_loads_has_applied_nothing(viewer: webviz.Viewer) -> None:
    plan = viewer.add("Path", topic="/plan", name="Plan")
    with contextlib.closing(Peer(Served(viewer.port))):
        trace = plan.trace(timeout=60)
    assert list(trace.times())[-1] == "sent"


def test_a_trace_without_browsers_is_refused_with_a_remedy(viewer: webviz.Viewer) -> None:
    plan = viewer.add("Path", topic="/plan", name="Plan")
    assert refusal_of(lambda: plan.trace(timeout=0.1)) == (
        "Plan drew no new sample within 0.1 s. Check its status, and open the page in a browser."
    )
