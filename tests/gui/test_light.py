"""The panel stays light, however much there is to show."""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

from webviz.engine.sources import Offer, Publisher
from webviz.engine.state import Clock, Row, Traffic

CONTROLS = "input, button, textarea"
PER_DISPLAY = 2
"""A check box and a name."""

MakeRow = Callable[..., Row]


def mounted(tab: Any, selector: str = "*") -> int:
    return tab.page.locator(selector).count()


def settled(tab: Any) -> int:
    """The number of elements once the page has stopped adding some."""
    counts = [0]

    def is_settled() -> bool:
        counts.append(mounted(tab))
        return len(set(counts[-15:])) == 1

    tab.wait_for(is_settled)
    return counts[-1]


def test_a_hundred_displays_mount_two_controls_each_and_one_editor(
    loop: Any, tab: Any, make_row: MakeRow
) -> None:
    loop.show(*(make_row(str(i)) for i in range(5)))
    tab.wait_for(lambda: len(tab.names()) == 5)
    controls, elements = mounted(tab, CONTROLS), mounted(tab)
    loop.show(*(make_row(str(i)) for i in range(100)))
    tab.wait_for(lambda: len(tab.names()) == 100)
    assert mounted(tab, CONTROLS) - controls == 95 * PER_DISPLAY
    assert mounted(tab) - elements <= 95 * 20


def test_the_controls_of_a_dialog_are_there_only_while_it_is_open(loop: Any, tab: Any) -> None:
    topics = {f"/scan{i}": ("sensor_msgs/msg/LaserScan",) for i in range(30)}
    loop.show(topics=topics)
    settled(tab)
    before = mounted(tab, CONTROLS)
    tab.click("By topic")
    tab.wait_for(lambda: len(tab.dialog_labels()) == 30)
    tab.dialog_button("Cancel").click()
    tab.wait_for(lambda: loop.turn() or mounted(tab, CONTROLS) == before)


def test_a_tab_that_nobody_has_opened_costs_the_page_nothing(loop: Any, tab: Any) -> None:
    loop.show()
    before = settled(tab)
    publisher = Publisher("/driver", "sensor_msgs/msg/LaserScan", "reliable", "volatile")
    loop.show(offers={f"/scan{i}": Offer((publisher,)) for i in range(500)})
    assert settled(tab) == before


def test_what_changes_all_the_time_is_sent_now_and_then(loop: Any, tab: Any) -> None:
    publisher = Publisher("/driver", "sensor_msgs/msg/LaserScan", "reliable", "volatile")
    offers = {f"/scan{i}": Offer((publisher,)) for i in range(500)}
    loop.show(offers=offers)
    settled(tab)
    frames, began = tab.frames_received, time.monotonic()
    for i in range(100):
        traffic = {"/scan1": Traffic(float(i), 10.0)}
        loop.show(offers=offers, clock=Clock(1 + i * 20_000_000), traffic=traffic)
        tab.page.wait_for_timeout(20)
    assert tab.frames_received - frames <= 6 * (time.monotonic() - began)
