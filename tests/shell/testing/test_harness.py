"""A viewer without ROS whose scene can be read by the names of its displays."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest

from webviz import Level
from webviz.engine.requests import Refused
from webviz.shell.testing import SECOND, Harness
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan
from webviz_displays.odometry import Odometry


def test_points_are_in_the_fixed_frame(filled: Harness) -> None:
    points = filled.points("Scan")
    assert points.shape == (7, 3)
    np.testing.assert_allclose(points[3], (3.0, 0.0, 0.5), atol=1e-6)
    filled.set_fixed_frame("laser")
    np.testing.assert_allclose(filled.points("Scan")[3], (2.0, 0.0, 0.0), atol=1e-6)


def test_lines_axes_arrows_and_texts_can_be_read(filled: Harness) -> None:
    assert filled.lines("Grid").shape == (22, 2, 3)
    assert np.abs(filled.lines("Grid")).max() == 5.0
    filled.set("show_names", True, "TF")
    assert filled.axes("TF").shape == (2, 3)
    np.testing.assert_allclose(filled.labels("TF")["laser"][:2], (1.0, 0.0), atol=0.1)
    assert filled.points("Grid").shape == (0, 3)


def test_arrows_can_be_read(webviz_harness: Callable[..., Harness]) -> None:
    stage = webviz_harness(Odometry())
    pose = {"position": {"x": 2.0}, "orientation": {"w": 1.0}}
    stage.publish("/odom", "nav_msgs/msg/Odometry", {"pose": {"pose": pose}}, frame="map")
    stage.wait_until_drawn("Odometry")
    np.testing.assert_allclose(stage.arrows()[0], [(2, 0, 0), (3, 0, 0)], atol=0.5)


def test_a_hidden_display_shows_nothing(filled: Harness) -> None:
    filled.set("enabled", False, "Scan")
    assert len(filled.points("Scan")) == 0
    assert not filled.is_drawn("Scan")


def test_a_status_is_the_worst_with_its_reason(stage: Harness) -> None:
    assert stage.status("Scan").level is Level.WARN
    assert "/scan" in stage.status("Scan").text
    assert stage.status("Grid").level is Level.OK


def test_the_test_sets_the_time(filled: Harness) -> None:
    filled.source.now += 20 * SECOND
    filled.clock += 20.0
    filled.turn()
    assert "20.0 s ago" in filled.statuses("Scan")["Topic"].text


def test_a_display_that_draws_nothing_is_reported_with_the_reason(stage: Harness) -> None:
    with pytest.raises(AssertionError, match=r"Scan draws nothing\. Topic: No publisher on /scan"):
        stage.wait_until_drawn("Scan")


def test_an_unknown_name_names_the_nearest(stage: Harness) -> None:
    with pytest.raises(LookupError, match="No display is named `Scna`, did you mean `Scan`"):
        stage.points("Scna")


def test_a_name_must_be_unique(webviz_harness: Callable[..., Harness]) -> None:
    with pytest.raises(LookupError, match="2 displays are named `Grid`"):
        webviz_harness(Grid(), Grid()).lines("Grid")


def test_a_wrong_value_is_refused(stage: Harness) -> None:
    with pytest.raises(Refused, match="cell_size"):
        stage.set("cell_size", -1.0)


def test_an_unknown_field_or_type_is_refused(stage: Harness) -> None:
    with pytest.raises(ValueError, match=r"no field 'range'; did you mean ranges\?"):
        stage.publish("/scan", "sensor_msgs/msg/LaserScan", {"range": []})
    with pytest.raises(ValueError, match="type sensor_msgs/msg/Laser is known"):
        stage.publish("/scan", "sensor_msgs/msg/Laser", {})


def test_a_ros_message_is_published_as_it_is(webviz_harness: Callable[..., Harness]) -> None:
    pytest.importorskip("rclpy", reason="ROS messages need rclpy")
    from sensor_msgs.msg import LaserScan as Message

    scan = Message(angle_increment=0.1, range_max=10.0, ranges=[2.0, 4.0])
    scan.header.frame_id = "map"
    stage = webviz_harness(LaserScan())
    stage.publish("/scan", scan)
    stage.wait_until_drawn("LaserScan")
    np.testing.assert_allclose(stage.points()[0], (2.0, 0.0, 0.0))
    with pytest.raises(TypeError, match="object is not a ROS message"):
        stage.publish("/scan", object())
