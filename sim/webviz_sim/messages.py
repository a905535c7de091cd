"""The simulation's state as ROS messages."""

import math
from array import array

import numpy as np
from builtin_interfaces.msg import Time
from geometry_msgs.msg import Point, Quaternion
from nav_msgs.msg import OccupancyGrid, Odometry
from sensor_msgs.msg import JointState, LaserScan

from webviz.data.rotations import from_rpy, to_rpy, w_last
from webviz_sim.description import Transform
from webviz_sim.lidar import LidarSettings, Scan
from webviz_sim.pose import Pose2D
from webviz_sim.robot import Robot
from webviz_sim.world import World

WHEEL_JOINTS = ("wheel_left_joint", "wheel_right_joint")
SCANNER = "base_scan"

# Variances as diff_drive_controller's examples set them: x, y, z, roll, pitch, yaw.
_COVARIANCE = np.diag([0.001, 0.001, 0.001, 0.001, 0.001, 0.01]).ravel()


def stamp(nanoseconds: int) -> Time:
    """A time as ROS has it."""
    seconds, rest = divmod(nanoseconds, 1_000_000_000)
    return Time(sec=seconds, nanosec=rest)


def planar(parent: str, child: str, pose: Pose2D) -> Transform:
    """A pose in the plane as a transform."""
    return Transform(parent, child, (pose.x, pose.y, 0.0), w_last(from_rpy(0.0, 0.0, pose.yaw)))


def to_pose(position: Point, orientation: Quaternion) -> Pose2D | None:
    """What a pose message says about the plane; None if it is not finite or no rotation."""
    x, y, z, w = orientation.x, orientation.y, orientation.z, orientation.w
    norm = math.hypot(x, y, z, w)
    if not (math.isfinite(position.x) and math.isfinite(position.y) and norm > 1e-6):
        return None
    if not math.isfinite(norm):
        return None
    _, _, yaw = to_rpy((w / norm, x / norm, y / norm, z / norm))
    return Pose2D(position.x, position.y, yaw)


def occupancy_grid(world: World, nanoseconds: int) -> OccupancyGrid:
    """The map, as map_server publishes it."""
    message = OccupancyGrid()
    message.header.frame_id = "map"
    message.header.stamp = message.info.map_load_time = stamp(nanoseconds)
    message.info.height, message.info.width = world.cells.shape
    message.info.resolution = world.resolution
    origin = planar("", "", world.origin)
    position, orientation = message.info.origin.position, message.info.origin.orientation
    position.x, position.y, position.z = origin.translation
    orientation.x, orientation.y, orientation.z, orientation.w = origin.rotation
    message.data = array("b", world.cells.tobytes())
    return message


def odometry(robot: Robot, nanoseconds: int) -> Odometry:
    """What the wheels tell: base_link in odom, and its velocity in base_link."""
    message = Odometry(child_frame_id="base_link")
    message.header.frame_id = "odom"
    message.header.stamp = stamp(nanoseconds)
    position, orientation = message.pose.pose.position, message.pose.pose.orientation
    position.x, position.y, yaw = robot.odometry
    orientation.z, orientation.w = math.sin(0.5 * yaw), math.cos(0.5 * yaw)
    message.pose.covariance = _COVARIANCE
    message.twist.twist.linear.x = robot.linear
    message.twist.twist.angular.z = robot.angular
    message.twist.covariance = _COVARIANCE
    return message


def joint_state(robot: Robot, nanoseconds: int) -> JointState:
    """The wheels' angles and speeds."""
    message = JointState(name=WHEEL_JOINTS)
    message.header.stamp = stamp(nanoseconds)
    message.position = array("d", robot.wheels)
    message.velocity = array("d", robot.wheel_speeds)
    return message


def laser_scan(
    scan: Scan, settings: LidarSettings, nanoseconds: int, period: float, sweep: bool
) -> LaserScan:
    """One revolution of the scanner.

    Args:
        scan: What it measured.
        settings: How it measures.
        nanoseconds: When the first beam was measured.
        period: Time from one revolution to the next, in seconds.
        sweep: Whether the beams were measured one after another instead of all at once.
    """
    step = math.tau / settings.beams
    message = LaserScan()
    message.header.frame_id = SCANNER
    message.header.stamp = stamp(nanoseconds)
    message.angle_min = -math.pi
    message.angle_max = -math.pi + step * (settings.beams - 1)
    message.angle_increment = step
    message.time_increment = period / settings.beams if sweep else 0.0
    message.scan_time = period
    message.range_min = settings.range_min
    message.range_max = settings.range_max
    message.ranges = array("f", scan.ranges.tobytes())
    message.intensities = array("f", scan.intensities.tobytes())
    return message
