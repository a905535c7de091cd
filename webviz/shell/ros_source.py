"""The ROS graph as a source, if ROS is installed."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from webviz.api.errors import Error

if TYPE_CHECKING:
    from webviz.ros.node import RosSource

NO_ROS = (
    "Python {version} cannot import rclpy of ROS 2 Jazzy. Run `source /opt/ros/jazzy/setup.bash` "
    "if ROS is installed, or `pip install 'ros-webviz[ros]'`."
)


def ros_source(ros_args: Sequence[str] = ()) -> RosSource:
    """Return the ROS graph.

    Args:
        ros_args: command line arguments for ROS.

    Raises:
        Error: ROS is missing, or does not start.
    """
    try:
        from webviz.ros.node import RosSource
    except ImportError as error:
        raise Error(NO_ROS.format(version=sys.version.split()[0])) from error
    try:
        return RosSource(ros_args)
    except Exception as error:  # rclpy has no common base: bad arguments, no RMW, no network
        reason = " ".join(str(error).split()).partition(", at /")[0].rstrip(".")
        raise Error(f"ROS did not start: {reason}.") from error
