"""Displays of poses, areas, vectors and measurements draw what comes over DDS."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from plain_scenes import PLAIN_MESSAGES, ROBOT

from webviz import Display, Level
from webviz.api.display import inputs, inputs_of
from webviz.data.messages import encode
from webviz.shell.testing import LiveViewer
from webviz_displays.areas import GridCells, Polygon
from webviz_displays.poses import (
    ParticleCloud,
    PointStamped,
    Pose,
    PoseArray,
    PoseWithCovariance,
)
from webviz_displays.sensors import (
    FluidPressure,
    Illuminance,
    PointCloud,
    Range,
    RelativeHumidity,
    Temperature,
)
from webviz_displays.vectors import AccelStamped, Effort, Twist, TwistStamped, Wrench

pytest.importorskip("rclpy", reason="a live viewer needs rclpy")

CLASSES: tuple[type[Display], ...] = (
    *(ParticleCloud, PointStamped, Pose, PoseArray, PoseWithCovariance, GridCells, Polygon),
    *(FluidPressure, Illuminance, PointCloud, Range, RelativeHumidity, Temperature),
    *(AccelStamped, Effort, TwistStamped, Wrench),
)


def test_each_display_draws_what_is_published_and_says_ok(
    webviz_viewer: Callable[..., LiveViewer],
) -> None:
    """Types without a package, such as nav2's, are composed."""
    shown = [cls() for cls in CLASSES]
    viewer = webviz_viewer(*shown, Twist(reference_frame="sensor"))
    viewer.transform("map", "sensor")
    viewer.transform("map", "rider")
    text = "std_msgs/msg/String"
    viewer.publish_bytes("/robot_description", text, encode(text, {"data": ROBOT}), latched=True)
    viewer.publish("/cmd_vel", "geometry_msgs/msg/Twist", PLAIN_MESSAGES["geometry_msgs/msg/Twist"])
    for display in shown:
        _, _, topic = inputs(display)[0]
        type_name = next(iter(inputs_of(type(display)).values())).type
        viewer.publish(topic.name, type_name, PLAIN_MESSAGES.get(type_name, {}), frame="sensor")
    for cls in (*CLASSES, Twist):
        viewer.wait_until_drawn(cls.__name__)
        status = viewer.status(cls.__name__)
        assert status.level is Level.OK, f"{cls.__name__}: {status.text}"
