"""A viewer on real ROS, on a domain of its own."""

from __future__ import annotations

import os
import re
import socket
import threading
from collections.abc import Callable

import numpy as np
import pytest
from processes import no_thread_left
from waiting import until

from webviz import Display, Level, Topic
from webviz.shell.testing import LiveViewer
from webviz.shell.testing.domain import isolated_domain
from webviz_displays.laser_scan import LaserScan
from webviz_displays.path import Path

pytest.importorskip("rclpy", reason="a live viewer needs rclpy")

Viewers = Callable[..., LiveViewer]


def scan(ranges: list[float]) -> dict[str, object]:
    return {"angle_increment": 0.1, "range_max": 10.0, "ranges": ranges}


def send(viewer: LiveViewer, *ranges: float) -> None:
    viewer.publish("/scan", "sensor_msgs/msg/LaserScan", scan(list(ranges)), frame="laser")


def test_published_messages_are_drawn_when_waiting_ends(webviz_viewer: Viewers) -> None:
    viewer = webviz_viewer(LaserScan())
    assert viewer.viewer.turns > 0, "nothing tells when a turn is over"
    viewer.transform("map", "laser", (0.0, 0.0, 1.0))
    for count in range(1, 6):
        send(viewer, *[1.0 + count] * count)
        viewer.wait_until_drawn("LaserScan")
        assert viewer.points("LaserScan").shape == (count, 3)
        np.testing.assert_allclose(viewer.points("LaserScan")[0], (1.0 + count, 0.0, 1.0))
    assert viewer.status("LaserScan").level is Level.OK


def test_a_transform_that_comes_later_is_waited_for(webviz_viewer: Viewers) -> None:
    viewer = webviz_viewer(LaserScan())
    stamp_ns = viewer.now_ns()
    send(viewer, 1.0, 2.0)
    later = threading.Timer(0.3, viewer.transform, ("map", "laser"), {"stamp_ns": stamp_ns - 10**8})
    last = threading.Timer(0.5, viewer.transform, ("map", "laser"), {"stamp_ns": stamp_ns + 10**9})
    later.start()
    last.start()
    viewer.wait_until_drawn("LaserScan")
    assert len(viewer.points("LaserScan")) == 2
    later.join()
    last.join()


def test_a_wait_that_fails_gives_the_reason(webviz_viewer: Viewers) -> None:
    viewer = webviz_viewer(LaserScan(), Path(topic=Topic("/plan")))
    send(viewer, 1.0)

    def says(display: str, reason: str) -> bool:
        with pytest.raises(AssertionError) as error:
            viewer.wait_until_drawn(display, seconds=0.2)
        return re.search(reason, str(error.value)) is not None

    until(lambda: says("LaserScan", r"LaserScan has not drawn it\. Transform: .* no "))
    until(lambda: says("Path", "Topic: No publisher on /plan"))


def test_the_simulated_robot_drives_around(webviz_viewer: Viewers) -> None:
    viewer = webviz_viewer(LaserScan(), simulator={"tour": False}, fixed_frame="odom")
    viewer.wait_until_drawn("LaserScan", seconds=60)
    assert len(viewer.points("LaserScan")) > 100


class Broken(Display):
    """Draws nothing right."""

    def tick(self, ctx: object) -> None:
        raise RuntimeError("the wheel is flat")


def test_a_display_that_raises_fails_the_test(webviz_viewer: Viewers) -> None:
    with (
        no_thread_left(),
        pytest.raises(AssertionError, match="The viewer stopped: the wheel is flat"),
    ):
        webviz_viewer(Broken())


def test_each_session_has_a_domain_of_its_own() -> None:
    before = os.environ.get("ROS_DOMAIN_ID")
    with isolated_domain() as one, isolated_domain() as other:
        assert one != other
        assert os.environ["ROS_DOMAIN_ID"] == str(other)
        assert os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    assert os.environ.get("ROS_DOMAIN_ID") == before


def test_a_domain_in_use_is_skipped() -> None:
    with isolated_domain() as used:
        pass  # other tests may have any that is named here
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as other:
        other.bind(("", 7400 + 250 * used + 10))
        positions = set()
        for _ in range(98):
            with isolated_domain() as domain:
                positions.add(domain)
        assert used not in positions
        assert len(positions) > 20


def test_nothing_is_left_running(webviz_viewer: Viewers) -> None:
    before = set(threading.enumerate())
    with no_thread_left():
        viewer = webviz_viewer(LaserScan())
        assert set(threading.enumerate()) - before
        viewer.close()
