"""Live topics: of the ROS graph, or through bridges and over Zenoh without ROS."""

from __future__ import annotations

import importlib.util
import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from webviz.api.errors import Error
from webviz.api.robots import NamespacedRobot, robots_of
from webviz.shell.remappings import remappings

if TYPE_CHECKING:
    from webviz.ros.node import RosSource
    from webviz.sources import Source
    from webviz.sources.fleet.source import FleetSource


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


def bridge_source(
    url: str,
    headers: str | os.PathLike[str] | None = None,
    ros_args: Sequence[str] = (),
) -> Source:
    """Return the topics of a bridge or over Zenoh, which may be connected later.

    Args:
        url: such as ws://robot:8765 or tcp/robot:7447.
        headers: file with headers for the bridge, see `webviz.sources.bridge.address`.
        ros_args: remappings of topics.

    Raises:
        Error: the URL, the file or an argument is invalid.
    """
    from webviz.sources.bridge.address import address
    from webviz.sources.bridge.source import BridgeSource
    from webviz.sources.zenoh.address import is_zenoh, zenoh_address

    if is_zenoh(url):
        if headers:
            raise Error("Zenoh has no headers. Name credentials in a session config (.json5).")
        zenoh = zenoh_address(url)
        from webviz.sources.zenoh.source import ZenohSource

        return ZenohSource(zenoh, remappings(ros_args, "Zenoh"))
    renamed = remappings(ros_args, "a bridge")
    return BridgeSource(address(url, Path(headers) if headers else None), renamed)


def live_source(
    connect: str,
    headers: Path | None = None,
    ros_args: Sequence[str] = (),
    robots: Sequence[str | NamespacedRobot] = (),
) -> Source:
    """Return the topics of a bridge, or of the ROS graph, and of robots with connections.

    Args:
        connect: URL of the bridge or address of Zenoh, "" for the ROS graph.
        headers: for the bridge.
        ros_args: command line arguments for ROS.
        robots: of the config.

    Raises:
        Error: a connection is invalid, or ROS is missing or does not start.
    """
    if not connect and is_alone(robots):
        return with_robots(None, robots)
    base = bridge_source(connect, headers, ros_args) if connect else ros_source(ros_args)
    try:
        return with_robots(base, robots)
    except Error:
        base.close()
        raise


def is_alone(robots: Sequence[str | NamespacedRobot]) -> bool:
    """Return whether robots with connections are all there is, as ROS is not installed."""
    has_ros = importlib.util.find_spec("rclpy") is not None
    return not has_ros and any(robot.connection for robot in robots_of(tuple(robots)))


def with_robots(base: Source | None, robots: Sequence[str | NamespacedRobot]) -> FleetSource:
    """Return a source with the robots that have connections, now and later.

    Args:
        base: of all other topics; None if there are none.
        robots: of the config.

    Raises:
        Error: a connection is invalid.
    """
    from webviz.sources.fleet.source import FleetSource

    return FleetSource(robots_of(tuple(robots)), base)
