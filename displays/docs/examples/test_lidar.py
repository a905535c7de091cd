"""A test for CI: a scan is drawn where the laser is, without ROS or a screen."""

import numpy as np

from webviz_displays.laser_scan import LaserScan

SCAN = {"angle_min": -1.5, "angle_increment": 1.5, "range_max": 10.0, "ranges": [1.0, 2.0, 3.0]}


def test_a_scan_is_drawn_where_the_laser_is(webviz_harness) -> None:
    """The beam straight ahead ends 2 m in front of the laser."""
    harness = webviz_harness(LaserScan(size=0.05))
    harness.transform("map", "laser", (1.0, 0.0, 0.2))
    harness.publish("/scan", "sensor_msgs/msg/LaserScan", SCAN, frame="laser")
    harness.wait_until_drawn("LaserScan")
    points = harness.points("LaserScan")
    np.testing.assert_allclose(points[1], (3.0, 0.0, 0.2), atol=1e-5)
