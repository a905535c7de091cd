"""The simulation's state as serialised messages.

`encode` is much faster than rclpy (50 paths take it milliseconds instead of a second), and needs no
package of the message type, which tf2_msgs lacks on PyPI.
"""

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from webviz.data.messages import FrameTransform, Header, PoseStampedSequence, Time, encode
from webviz.data.rotations import from_rpy, to_rpy, w_last
from webviz_sim.description import SCANNER, WHEEL_JOINTS
from webviz_sim.lidar import LidarSettings, Scan
from webviz_sim.pose import Pose2D
from webviz_sim.robot import DifferentialDrive
from webviz_sim.world import World

# Variances as diff_drive_controller's examples set them: x, y, z, roll, pitch, yaw.
_COVARIANCE = np.diag([0.001, 0.001, 0.001, 0.001, 0.001, 0.01]).ravel()

FARTHEST = 1e9
"""Metres to a pose along an axis; numbers of cells of a map overflow far beyond."""


def stamp(nanoseconds: int) -> Time:
    """Return a time as ROS has it."""
    return Time(*divmod(nanoseconds, 1_000_000_000))


def planar(parent: str, child: str, nanoseconds: int, pose: Pose2D) -> FrameTransform:
    """Return a pose in the plane as a transform."""
    rotation = w_last(from_rpy(0.0, 0.0, pose.yaw))
    return FrameTransform(parent, child, nanoseconds, (pose.x, pose.y, 0.0), rotation)


def to_pose(position: Any, orientation: Any) -> Pose2D | None:
    """Return the planar part of a pose; None if it is not finite or its quaternion is zero."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    norm = math.hypot(x, y, z, w)
    if not (all(map(math.isfinite, (position.x, position.y, norm))) and norm > 1e-6):
        return None
    _, _, yaw = to_rpy((w / norm, x / norm, y / norm, z / norm))
    return Pose2D(position.x, position.y, yaw)


def to_map_pose(header: Any, pose: Any) -> Pose2D | str:
    """Return the pose in the map, or why it is invalid."""
    if header.frame_id.removeprefix("/") != "map":
        return f"in the frame {header.frame_id!r}: send it in map"
    planar = to_pose(pose.position, pose.orientation)
    if planar is None:
        return "that is not finite"
    is_near = max(abs(planar.x), abs(planar.y)) <= FARTHEST
    return planar if is_near else f"that is farther than {FARTHEST:g} m"


def clock(nanoseconds: int) -> bytes:
    """Return a rosgraph_msgs/Clock."""
    return encode("rosgraph_msgs/msg/Clock", {"clock": stamp(nanoseconds)})


def tf(transforms: Iterable[FrameTransform]) -> bytes:
    """Return a tf2_msgs/TFMessage."""
    return encode("tf2_msgs/msg/TFMessage", {"transforms": list(transforms)})


def path(points: NDArray[np.float64], nanoseconds: int) -> bytes:
    """Return a nav_msgs/Path in the frame `map` along points (n, 2) in metres, n at least 2.

    The poses look along the path.
    """
    count = len(points)
    directions = np.gradient(points, axis=0)
    half = 0.5 * np.arctan2(directions[:, 1], directions[:, 0])
    zeros = np.zeros(count)
    poses = PoseStampedSequence(
        np.column_stack([points, zeros]),
        np.column_stack([zeros, zeros, np.sin(half), np.cos(half)]),
        np.full(count, nanoseconds),
        ["map"] * count,
    )
    return encode("nav_msgs/msg/Path", {"header": poses[0].header, "poses": poses})


def occupancy_grid(world: World, nanoseconds: int) -> bytes:
    """Return the map as a nav_msgs/OccupancyGrid, as map_server publishes it."""
    height, width = world.cells.shape
    origin = planar("", "", 0, world.origin)
    info = {
        "map_load_time": stamp(nanoseconds),
        "resolution": world.resolution,
        "width": width,
        "height": height,
        "origin": {"position": origin.translation, "orientation": origin.rotation},
    }
    header = Header(stamp(nanoseconds), "map")
    values = {"header": header, "info": info, "data": world.cells.ravel()}
    return encode("nav_msgs/msg/OccupancyGrid", values)


def pose_with_covariance(pose: Pose2D, covariance: NDArray[np.float64], nanoseconds: int) -> bytes:
    """Return a geometry_msgs/PoseWithCovarianceStamped in the map; the covariance is (6, 6)."""
    place = planar("", "", 0, pose)
    values = {
        "header": Header(stamp(nanoseconds), "map"),
        "pose": {
            "pose": {"position": place.translation, "orientation": place.rotation},
            "covariance": covariance.ravel(),
        },
    }
    return encode("geometry_msgs/msg/PoseWithCovarianceStamped", values)


def particle_cloud(poses: NDArray[np.float64], nanoseconds: int) -> bytes:
    """Return a nav2_msgs/ParticleCloud in the map: x, y and yaw, shape (n, 3), of equal weight."""
    places = [planar("", "", 0, Pose2D(*pose)) for pose in poses.tolist()]
    particles = [
        {
            "pose": {"position": place.translation, "orientation": place.rotation},
            "weight": 1.0 / len(places),
        }
        for place in places
    ]
    values = {"header": Header(stamp(nanoseconds), "map"), "particles": particles}
    return encode("nav2_msgs/msg/ParticleCloud", values)


def odometry(robot: DifferentialDrive, nanoseconds: int, prefix: str = "") -> bytes:
    """Return wheel odometry as nav_msgs/Odometry: base_link in odom, its velocity in base_link."""
    pose = planar("", "", 0, robot.odometry)
    twist = {"linear": {"x": robot.linear}, "angular": {"z": robot.angular}}
    values = {
        "header": Header(stamp(nanoseconds), f"{prefix}odom"),
        "child_frame_id": f"{prefix}base_link",
        "pose": {
            "pose": {"position": pose.translation, "orientation": pose.rotation},
            "covariance": _COVARIANCE,
        },
        "twist": {"twist": twist, "covariance": _COVARIANCE},
    }
    return encode("nav_msgs/msg/Odometry", values)


def joint_state(robot: DifferentialDrive, nanoseconds: int) -> bytes:
    """Return the wheels' angles and speeds as a sensor_msgs/JointState."""
    values = {
        "header": Header(stamp(nanoseconds)),
        "name": WHEEL_JOINTS,
        "position": robot.wheels,
        "velocity": robot.wheel_speeds,
    }
    return encode("sensor_msgs/msg/JointState", values)


def laser_scan(
    scan: Scan,
    settings: LidarSettings,
    nanoseconds: int,
    period: float,
    sweep: bool,
    prefix: str = "",
) -> bytes:
    """One revolution of the scanner as a sensor_msgs/LaserScan.

    Args:
        scan: measurements.
        settings: of the scanner.
        nanoseconds: time of the first beam.
        period: time from one revolution to the next, in seconds.
        sweep: whether the beams were measured one after another instead of all at once.
        prefix: before the name of its frame.
    """
    step = math.tau / settings.beams
    values = {
        "header": Header(stamp(nanoseconds), f"{prefix}{SCANNER}"),
        "angle_min": -math.pi,
        "angle_max": -math.pi + step * (settings.beams - 1),
        "angle_increment": step,
        "time_increment": period / settings.beams if sweep else 0.0,
        "scan_time": period,
        "range_min": settings.range_min,
        "range_max": settings.range_max,
        "ranges": scan.ranges,
        "intensities": scan.intensities,
    }
    return encode("sensor_msgs/msg/LaserScan", values)
