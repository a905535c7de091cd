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
from webviz_sim import messages
from webviz_sim.description import demo_description, read_joints
from webviz_sim.lidar import LidarSettings, scan
from webviz_sim.pose import Pose2D
from webviz_sim.simulation import Simulation

LOCALISATION_RATE = 10.0  # Hz, of map -> odom: AMCL sends it with every scan
PATH_RATE = 2.0  # Hz, of /path, so that late subscribers receive it too

_SECOND = 1_000_000_000
_LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Broadcaster:
    """Publishes the state of a simulation after each step."""

    def __init__(self, node: Node, simulation: Simulation, values: dict[str, Any], now: int):
        """Creates the publishers and publishes the latched messages.

        Args:
            node: The node to publish from.
            simulation: The simulation to publish.
            values: The node's parameters by name; read at every step.
            now: The stamp of the latched messages in nanoseconds.
        """
        self._simulation = simulation
        self._values = values
        self._random = np.random.default_rng([values["seed"], 1])
        self._scanner_poses: deque[Pose2D] = deque(maxlen=math.ceil(10.0 * values["rate"]) + 1)
        self._scan_due, self._joints_due = _Schedule(), _Schedule()
        self._localisation_due, self._path_due = _Schedule(), _Schedule()

        urdf = demo_description()
        joints = read_joints(urdf)
        fixed = [joint.transform(now) for joint in joints if joint.kind == "fixed"]
        by_name = {joint.name: joint for joint in joints}
        self._wheels = [by_name[name] for name in messages.WHEEL_JOINTS]
        [self._scanner] = [
            Pose2D(*transform.translation[:2])
            for transform in fixed
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

        self._tf_static.publish(messages.tf(fixed))
        self._description.publish(String(data=urdf))
        self._map.publish(messages.occupancy_grid(simulation.world, now))

    def publish(self, now: int) -> None:
        """Publishes the messages that are due; `now` is the simulation's time in nanoseconds."""
        simulation, robot = self._simulation, self._simulation.robot
        values, time = self._values, self._simulation.time
        if self._clock:
            self._clock.publish(messages.clock(now))
        self._scanner_poses.append(robot.pose @ self._scanner)

        transforms = [messages.planar("odom", "base_link", now, robot.odometry)]
        if self._localisation_due(time, LOCALISATION_RATE):
            # AMCL stamps its transform ahead, so that it is valid until the next one.
            until = now + round(values["transform_tolerance"] * _SECOND)
            correction = robot.pose @ robot.odometry.inverse()
            transforms.append(messages.planar("map", "odom", until, correction))
        if self._joints_due(time, values["joint_state_rate"]):
            self._joints.publish(messages.joint_state(robot, now))
            turned = zip(self._wheels, robot.wheels, strict=True)
            transforms += [joint.transform(now, angle) for joint, angle in turned]
        self._tf.publish(messages.tf(transforms))
        self._odometry.publish(messages.odometry(robot, now))

        if self._scan_due(time, values["scan_rate"]):
            self._publish_scan(now)
        if self._path_due(time, PATH_RATE) and len(simulation.path) > 1:
            self._path.publish(messages.path(simulation.path, now))

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
    """Whether something that happens at a rate is due, in simulated seconds."""

    def __init__(self):
        self._next = 0.0

    def __call__(self, now: float, rate: float) -> bool:
        if now < self._next - 1e-9:
            return False
        self._next = max(self._next + 1.0 / rate, now)
        return True
