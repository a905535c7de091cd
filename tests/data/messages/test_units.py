"""Units of the numbers that message paths name."""

from __future__ import annotations

import pytest

from webviz.data.messages.message_paths import UNITS, MessagePath
from webviz.data.messages.typestore import fields

ODOMETRY, IMU = "nav_msgs/msg/Odometry", "sensor_msgs/msg/Imu"


@pytest.mark.parametrize(
    ("type_name", "field", "unit"),
    [
        (ODOMETRY, "twist.twist.linear.x", "m/s"),
        (ODOMETRY, "twist.twist.linear.@norm", "m/s"),
        (ODOMETRY, "twist.twist.angular.z", "rad/s"),
        (ODOMETRY, "twist.twist.angular.z.@degrees", "°"),
        (ODOMETRY, "twist.twist.linear.x.@abs.@derivative", "m/s²"),
        (ODOMETRY, "twist.covariance[0]", ""),
        (ODOMETRY, "pose.pose.position.x", "m"),
        (ODOMETRY, "pose.pose.position.@norm", "m"),
        (ODOMETRY, "pose.pose.position.x.@derivative", "m/s"),
        (ODOMETRY, "pose.pose.orientation.x", ""),
        (ODOMETRY, "pose.pose.orientation.@yaw", "rad"),
        (ODOMETRY, "pose.pose.orientation.@yaw.@degrees", "°"),
        (ODOMETRY, "header.stamp", "s"),
        (ODOMETRY, "header.stamp.nanosec", "ns"),
        (IMU, "linear_acceleration.z", "m/s²"),
        (IMU, "orientation.x", ""),
        ("sensor_msgs/msg/LaserScan", "ranges[3].@mean(5)", "m"),
        ("sensor_msgs/msg/JointState", "position[left]", ""),
        ("std_msgs/msg/Float64", "data", ""),
        ("some_msgs/msg/Unknown", "data", ""),
        (ODOMETRY, "no_such_field.x", ""),
    ],
)
def test_units_are_those_that_the_type_states(type_name: str, field: str, unit: str) -> None:
    assert MessagePath(f"/topic.{field}").unit(type_name) == unit


@pytest.mark.parametrize("type_name", UNITS)
def test_fields_with_units_exist(type_name: str) -> None:
    assert UNITS[type_name].keys() <= {field.name for field in fields(type_name)}
