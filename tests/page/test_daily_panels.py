"""The panels of a working day in a real browser: each draws what it was given, and hears clicks."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from tests.page.conftest import Loop, Tab
from webviz.api.declared import make
from webviz.api.panel import Panel
from webviz.data.messages import decode, encode
from webviz.engine.commands import Seek
from webviz.engine.state import PanelTab
from webviz.panels.log import LOG, Log
from webviz.sources import Offer, Publisher
from webviz.sources.past_state import PlaybackState

HOSTILE = "<img src=x onerror=alert(1)>"
SECOND = 10**9


@pytest.fixture(autouse=True)
def _close(loop: Loop, tab: Tab) -> Iterator[None]:
    yield
    loop.show(panels=(), offers={}, playback=None)
    tab.show_tab("Displays")


def message(type_: str, **values: Any) -> Any:
    """A message as it is received."""
    return decode(type_, encode(type_, values))


def offered(**types: str) -> dict[str, Offer]:
    """Publishers by topic, whose names have no slash here."""
    return {
        f"/{topic}": Offer((Publisher("/robot", type_, "reliable", "volatile"),))
        for topic, type_ in types.items()
    }


def open_panel(loop: Loop, tab: Tab, panel: Panel, **changes: Any) -> None:
    """Open a panel in its tab, with these changes of the viewer's state."""
    name = type(panel).__name__
    loop.show(panels=(PanelTab(f"of {name}", name, panel),), **changes)
    tab.wait_for(lambda: tab.page.get_by_role("tab", name=panel.name, exact=True).count())
    tab.show_tab(panel.name)
    tab.wait_for(lambda: tab.page.locator(".wv-plugin-widgets > *").count() > 0)


def log_line(level: int, name: str, text: str, at_s: int) -> Any:
    place = {"file": "drive.cpp", "function": "step", "line": 42}
    return message(LOG, stamp={"sec": at_s}, level=level, name=name, msg=text, **place)


def test_the_log_is_filtered_and_opened_and_leads_to_its_time(loop: Loop, tab: Tab) -> None:
    log = make(Log, {})
    for i in range(100_000):
        level = (20, 20, 20, 10, 40)[i % 5]
        log.add((float(i), level, f"node_{i % 3}", f"line {i} {HOSTILE}", "a.py:1 f"), i * SECOND)
    log.receive("/rosout", log_line(40, "base", "The motor is hot\nsecond line", 5), 7 * SECOND)
    playback = PlaybackState(
        names=("run",),
        start_ns=0,
        end_ns=10**6 * SECOND,
        position_s=0.0,
        rate=1.0,
        is_playing=False,
        is_seeking=False,
        loop=False,
        selected=None,
    )
    open_panel(loop, tab, log, offers=offered(rosout=LOG), playback=playback)
    newest = tab.page.get_by_role("option").filter(has_text="The motor is hot")
    tab.wait_for(lambda: newest.count() == 1 and newest.is_visible())
    kept = len(log.chunks) * 200
    assert 90_000 < kept <= 100_000
    tab.page.get_by_label("Lowest level").select_option("Error")
    tab.page.get_by_label("Node", exact=True).fill("BASE")
    tab.wait_for(lambda: tab.page.get_by_text("1 line", exact=True).count())
    newest.click()
    tab.wait_for(lambda: "drive.cpp:42 step" in tab.text() and "second line" in tab.text())
    tab.button("Go to this time").click()
    tab.wait_for_command(Seek(7.0))
    tab.page.get_by_label("Node", exact=True).fill("nobody")
    tab.wait_for(lambda: "No line matches these filters." in tab.text())
