"""The tabs besides "Displays"."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from webviz.edges.gui.text import MAX_LINES, block_html
from webviz.edges.gui.topics_table import MAX_ROWS, amount, qos_of, topics_html
from webviz.engine.commands import InspectTopic, InspectTransforms, Pause, Reset
from webviz.engine.sources import Offer, Publisher
from webviz.engine.state import Clock, Inspected, Traffic
from webviz.panels import transforms
from webviz.panels.time import times

HOSTILE = "<img src=x onerror=alert(1)>"
SCAN = Publisher("/driver", "sensor_msgs/msg/LaserScan", "best_effort", "volatile")
MAP = Publisher("/server", "nav_msgs/msg/OccupancyGrid", "reliable", "transient_local")


def test_the_time_is_rvizs(loop: Any, tab: Any) -> None:
    loop.show(clock=Clock(12_345_678_901, 2_000_000_000, 1_700_000_000.5, 3.25))
    tab.show_tab("Time")
    tab.wait_for(lambda: loop.turn() or "12.34" in tab.text())
    for text in ("ROS Time", "2.00", "1700000000.50", "3.25"):
        assert text in tab.text()


def test_time_stands_still_and_goes_on(loop: Any, tab: Any) -> None:
    loop.show()
    tab.show_tab("Time")
    tab.click("Pause")
    tab.wait_for(lambda: loop.drain() or loop.commands == [Pause(True)])
    loop.show(clock=Clock(5_000_000_000, is_paused=True))
    tab.wait_for(lambda: loop.turn() or "webviz · paused" in tab.text())
    tab.click("Resume")
    tab.wait_for(lambda: loop.drain() or loop.commands[1:] == [Pause(False)])
    tab.click("Reset")
    tab.wait_for(lambda: loop.drain() or loop.commands[2:] == [Reset()])


def test_a_time_that_is_not_known_is_not_zero() -> None:
    assert ("ROS Time", "not known yet") in times(Clock())
    assert ("ROS Elapsed", "-1.50") in times(Clock(1, ros_elapsed_ns=-1_500_000_000))


def test_transforms_are_followed_while_somebody_wants_to(
    loop: Any, tab: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(transforms, "EVERY_S", 0.0)
    loop.show()
    tab.show_tab("TF tree")
    tab.check("Live")
    tab.wait_for(lambda: loop.drain() or loop.commands)
    assert loop.commands == [InspectTransforms(True)]
    tab.wait_for(lambda: loop.turn() or transforms.NOTHING in tab.text())
    loop.show(transforms=f"map\n└─ odom  50.0 Hz\n   └─ {HOSTILE}")
    tab.wait_for(lambda: loop.turn() or "└─ odom  50.0 Hz" in tab.text())
    assert HOSTILE in tab.text()
    loop.show(transforms="map")
    tab.wait_for(lambda: loop.turn() or "odom" not in tab.text())
    tab.uncheck("Live")
    tab.wait_for(lambda: loop.turn() or transforms.OFF in tab.text())
    assert loop.commands[1:] == [InspectTransforms(False)]


def test_the_topics_are_listed_and_one_is_looked_into(loop: Any, tab: Any) -> None:
    offers = {"/scan": Offer((SCAN,)), "/map": Offer((MAP, MAP)), HOSTILE: Offer(())}
    loop.show(offers=offers, traffic={"/scan": Traffic(10.04, 45_300.0)})
    tab.show_tab("Topics")
    tab.wait_for(lambda: loop.turn() or "10.0 Hz" in tab.text())
    for text in (
        "sensor_msgs/msg/LaserScan · 1 publisher · best effort, volatile",
        "nav_msgs/msg/OccupancyGrid · 2 publishers · reliable, transient local",
        "45.3 kB/s",
        HOSTILE,
    ):
        assert text in tab.text()
    tab.field("Inspect").click()
    tab.page.get_by_role("option", name="/scan").click()
    tab.wait_for(lambda: loop.turn() or loop.commands)
    assert loop.commands == [InspectTopic("/scan")]
    loop.show(inspected=Inspected("/scan", f"header:\n  frame_id: {HOSTILE}", 3.2))
    tab.wait_for(lambda: loop.turn() or f"  frame_id: {HOSTILE}" in tab.text())
    assert "3 s ago" in tab.text()
    assert tab.field("Inspect").input_value() == "/scan"


def test_a_filter_finds_topics_by_name_and_type(loop: Any, tab: Any) -> None:
    loop.show(offers={"/scan": Offer((SCAN,)), "/map": Offer((MAP,))})
    tab.show_tab("Topics")
    tab.wait_for(lambda: loop.turn() or "LaserScan" in tab.text())
    tab.fill("Filter", "occupancy")
    tab.wait_for(lambda: loop.turn() or "LaserScan" not in tab.text())
    assert "OccupancyGrid" in tab.text()


def test_of_very_many_topics_and_lines_some_are_shown() -> None:
    markup = topics_html({f"/t{i:04}": Offer((SCAN,)) for i in range(MAX_ROWS + 50)}, {})
    assert "/t0199" in markup
    assert "/t0200" not in markup
    assert "… and 50 more" in markup
    block = block_html("\n".join(f"line {i}" for i in range(MAX_LINES + 7)))
    assert block.count("line ") == MAX_LINES
    assert "… and 7 more lines" in block
    assert block_html("one\ntwo") == '<pre class="webviz-block">one\ntwo</pre>'


def test_an_endless_line_is_cut() -> None:
    assert len(block_html("x" * 100_000)) < 500


def test_publishers_that_differ_are_mixed() -> None:
    assert qos_of((SCAN, MAP)) == "mixed, mixed"
    assert qos_of((SCAN, SCAN)) == "best effort, volatile"


@pytest.mark.parametrize(
    ("bytes_per_s", "text"),
    [
        (0.0, "0 B/s"),
        (999.0, "999 B/s"),
        (1500.0, "1.5 kB/s"),
        (2.5e8, "250 MB/s"),
        (3e12, "3000 GB/s"),
    ],
)
def test_amounts_have_few_digits(bytes_per_s: float, text: str) -> None:
    assert amount(bytes_per_s) == text


def test_the_tabs_are_the_same_in_a_browser_that_comes_late(
    loop: Any, tab: Any, open_tab: Callable[[], Any]
) -> None:
    loop.show(offers={"/scan": Offer((SCAN,))}, clock=Clock(12_000_000_000))
    tab.show_tab("TF tree")
    tab.check("Live")
    loop.show(transforms="map\n└─ odom")
    late = open_tab()
    for name, text in (("TF tree", "└─ odom"), ("Topics", "LaserScan"), ("Time", "12.00")):
        late.show_tab(name)
        late.wait_for(lambda text=text: loop.turn() or text in late.text())
