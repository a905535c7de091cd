"""What the simulated robot and its Nav2 publish."""

import math
from collections import deque
from typing import Any

import numpy as np
from nav_msgs.msg import OccupancyGrid, Odometry, Path
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState, LaserScan
from std_msgs.msg import String

from webviz.edges.ros.types import message_class
from webviz_sim import cdr, messages
from webviz_sim.description import demo_description, read_joints
from webviz_sim.lidar import LidarSettings, scan
from webviz_sim.pose import Pose2D
from webviz_sim.simulation import Simulation

LOCALISATION_RATE = 10.0  # Hz, of map -> odom: AMCL sends it with every scan
PATH_RATE = 2.0  # Hz, of /path, so that who comes late sees it too

_SECOND = 1_000_000_000
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Broadcaster:
    """Publishes the state of a simulation after each step."""

    def __init__(self, node: Node, simulation: Simulation, values: dict[str, Any], now: int):
        """Creates the publishers and publishes what is latched.

        Args:
            node: The node to publish from.
            simulation: What to publish.
            values: The node's parameters by name; read anew at every step.
            now: The time in nanoseconds, for the stamps of what is latched.
        """
        self._simulation = simulation
        self._values = values
        self._random = np.random.default_rng([values["seed"], 1])
        self._scanner_poses: deque[Pose2D] = deque(maxlen=math.ceil(10.0 * values["rate"]) + 1)
        self._scan_due, self._joints_due = _Schedule(), _Schedule()
        self._localisation_due, self._path_due = _Schedule(), _Schedule()

        urdf = demo_description()
        joints = read_joints(urdf)
        self._fixed = [joint.transform() for joint in joints if joint.kind == "fixed"]
        by_name = {joint.name: joint for joint in joints}
        self._wheels = [by_name[name] for name in messages.WHEEL_JOINTS]
        [self._scanner] = [
            Pose2D(*transform.translation[:2])
            for transform in self._fixed
            if transform.child == messages.SCANNER
        ]

        tf_message = message_class("tf2_msgs/msg/TFMessage")
        self._tf = node.create_publisher(tf_message, "/tf", 100)
        self._tf_static = node.create_publisher(tf_message, "/tf_static", _LATCHED)
        self._description = node.create_publisher(String, "/robot_description", _LATCHED)
        self._map = node.create_publisher(OccupancyGrid, "/map", _LATCHED)
        self._odometry = node.create_publisher(Odometry, "/odom", 10)
        self._scan = node.create_publisher(LaserScan, "/scan", qos_profile_sensor_data)
        self._joints = node.create_publisher(JointState, "/joint_states", 10)
        self._path = node.create_publisher(Path, "/path", 10)
        self._clock = None
        if values["publish_clock"]:
            self._clock = node.create_publisher(Clock, "/clock", 10)

        self._tf_static.publish(cdr.tf_message((now, transform) for transform in self._fixed))
        self._description.publish(String(data=urdf))
        self._map.publish(messages.occupancy_grid(simulation.world, now))

    def publish(self, now: int) -> None:
        """Publishes what is due.

        Args:
            now: The time in nanoseconds that the simulation has reached.
        """
        simulation, robot = self._simulation, self._simulation.robot
        values, time = self._values, self._simulation.time
        if self._clock:
            self._clock.publish(Clock(clock=messages.stamp(now)))
        self._scanner_poses.append(robot.pose @ self._scanner)

        transforms = [(now, messages.planar("odom", "base_link", robot.odometry))]
        if self._localisation_due(time, LOCALISATION_RATE):
            # AMCL dates its transform ahead, so that it holds until the next one.
            until = now + round(values["transform_tolerance"] * _SECOND)
            correction = robot.pose @ robot.odometry.inverse()
            transforms.append((until, messages.planar("map", "odom", correction)))
        if self._joints_due(time, values["joint_state_rate"]):
            self._joints.publish(messages.joint_state(robot, now))
            turned = zip(self._wheels, robot.wheels, strict=True)
            transforms += [(now, joint.transform(angle)) for joint, angle in turned]
        self._tf.publish(cdr.tf_message(transforms))
        self._odometry.publish(messages.odometry(robot, now))

        if self._scan_due(time, values["scan_rate"]):
            self._publish_scan(now)
        if self._path_due(time, PATH_RATE) and len(simulation.path) > 1:
            self._path.publish(cdr.path_message(now, simulation.path))

    def _publish_scan(self, now: int) -> None:
        values = self._values
        settings = LidarSettings(
            values["scan_beams"],
            values["scan_range_min"],
            values["scan_range_max"],
            values["scan_noise"],
        )
        period, last = 1.0 / values["scan_rate"], self._scanner_poses[-1]
        first = last
        if values["scan_sweep"]:
            back = min(round(period * values["rate"]), len(self._scanner_poses) - 1)
            first = self._scanner_poses[-1 - back]
            now -= round(back / values["rate"] * _SECOND)
        measured = scan(self._simulation.world, first, last, settings, self._random)
        message = messages.laser_scan(measured, settings, now, period, values["scan_sweep"])
        self._scan.publish(message)


class _Schedule:
    """Says when something that happens at a rate is due, in simulated seconds."""

    def __init__(self):
        self._next = 0.0

    def __call__(self, now: float, rate: float) -> bool:
        if now < self._next - 1e-9:
            return False
        self._next = max(self._next + 1.0 / rate, now)
        return True
