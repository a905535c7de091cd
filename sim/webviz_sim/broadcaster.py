"""Publishers of the simulated robot and its Nav2."""

import math
from collections import deque
from collections.abc import Iterable
from typing import Any

import numpy as np

from webviz.data.messages import FrameTransform, encode
from webviz.data.rotations import from_rpy, multiply
from webviz_sim import messages
from webviz_sim.description import demo_description, read_joints, read_robot
from webviz_sim.lidar import LidarSettings, scan
from webviz_sim.localization import Amcl, Perfect, Slam
from webviz_sim.pose import Pose2D
from webviz_sim.publishers import SimPublishers
from webviz_sim.simulation import Simulation

LOCALISATION_RATE = 10.0  # Hz, of map -> odom: AMCL sends it with every scan
MAP_RATE = 1.0  # Hz, of a map that grows
FAR = 2.0  # m; a path that long has room for a box on it
BOX = 0.25  # m, its radius
PATH_RATE = 2.0  # Hz, of /path, so that late subscribers receive it too

TEXT = "std_msgs/msg/String"
_SECOND = 1_000_000_000
_LATCHED = 1, "transient_local"


class Broadcaster:
    """Publishes the state of a simulation after each step."""

    def __init__(
        self, outputs: SimPublishers, simulation: Simulation, values: dict[str, Any], now: int
    ) -> None:
        """Create the publishers and publish the latched messages.

        Args:
            outputs: Creates the publishers.
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

        self._prefix = values["frame_prefix"]
        self._late = round(values["fault_clock"] * _SECOND)
        now -= self._late
        urdf = read_robot(values["robot"]) if values["robot"] else demo_description()
        joints = read_joints(urdf)
        fixed = [joint.transform(now) for joint in joints if joint.kind == "fixed"]
        by_name = {joint.name: joint for joint in joints}
        self._wheels = [by_name[name] for name in messages.WHEEL_JOINTS]
        [self._scanner] = [
            Pose2D(*transform.translation[:2])
            for transform in fixed
            if transform.child == messages.SCANNER
        ]

        make = outputs.publisher
        self._tf = make("tf2_msgs/msg/TFMessage", "tf", 100)
        self._tf_static = make("tf2_msgs/msg/TFMessage", "tf_static", *_LATCHED)
        self._description = make(TEXT, "robot_description", *_LATCHED)
        self._map = make("nav_msgs/msg/OccupancyGrid", "map", *_LATCHED)
        self.localization = self._localization_of(outputs)
        self._map_due = _Schedule()
        self._odometry = make("nav_msgs/msg/Odometry", "odom")
        self._scan = make("sensor_msgs/msg/LaserScan", "scan", 0)
        self._joints = make("sensor_msgs/msg/JointState", "joint_states")
        self._path = make("nav_msgs/msg/Path", "path")
        self._clock = None
        if values["publish_clock"]:
            self._clock = make("rosgraph_msgs/msg/Clock", "/clock")

        turn = from_rpy(0.0, 0.0, values["fault_laser_yaw"])
        fixed = [
            joint._replace(rotation=multiply(joint.rotation, turn)).transform(now)
            if joint.child == messages.SCANNER
            else joint.transform(now)
            for joint in joints
            if joint.kind == "fixed"
        ]
        self._is_misplaced = bool(values["fault_misplaced"])
        if self._is_misplaced:
            wrong = Pose2D(0.0, values["fault_misplaced"], 0.0) @ simulation.robot.pose
            fixed.append(messages.planar("map", "odom", now, wrong))
        self._tf_static.publish(self._tf_message(fixed))
        self._description.publish(encode(TEXT, {"data": urdf}))
        if not isinstance(self.localization, Slam):
            self._map.publish(messages.occupancy_grid(simulation.world, now))

    def publish(self, now: int) -> None:
        """Publish the messages that are due; `now` is the simulation's time in nanoseconds."""
        simulation, robot = self._simulation, self._simulation.robot
        values, time = self._values, self._simulation.time
        if self._clock:
            self._clock.publish(messages.clock(now))
        now -= self._late
        self._scanner_poses.append(robot.pose @ self._scanner)

        transforms = [messages.planar("odom", "base_link", now, robot.odometry)]
        if self._localisation_due(time, LOCALISATION_RATE):
            # AMCL stamps its transform ahead, so that it is valid until the next one.
            until = now + round(values["transform_tolerance"] * _SECOND)
            self.localization.update(robot.pose, 1.0 / LOCALISATION_RATE)
            correction = self.localization.pose @ robot.odometry.inverse()
            if not self._is_misplaced:
                transforms.append(messages.planar("map", "odom", until, correction))
            if self._map_due(time, MAP_RATE) or isinstance(self.localization, Amcl):
                self.localization.publish(now)
        if self._joints_due(time, values["joint_state_rate"]):
            self._joints.publish(messages.joint_state(robot, now))
            turned = zip(self._wheels, robot.wheels, strict=True)
            transforms += [joint.transform(now, angle) for joint, angle in turned]
        self._tf.publish(self._tf_message(transforms))
        self._odometry.publish(messages.odometry(robot, now, self._prefix))

        if self._scan_due(time, values["scan_rate"]):
            self._publish_scan(now)
        if self._path_due(time, PATH_RATE) and len(simulation.path) > 1:
            self._publish_path(now)

    def _publish_path(self, now: int) -> None:
        path, simulation = self._simulation.path, self._simulation
        if self._values["fault_stale_path"] >= 0.5:
            if len(simulation.boxes) or math.dist(path[0], path[-1]) < FAR:
                return
            simulation.boxes = np.array([(*path[len(path) // 2], BOX)])
        self._path.publish(messages.path(path, now))

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
        simulation = self._simulation
        measured = scan(simulation.world, first, last, settings, self._random, simulation.circles)
        self.localization.see(last, measured, settings.range_max)
        sweep = values["scan_sweep"]
        message = messages.laser_scan(measured, settings, now, period, sweep, self._prefix)
        self._scan.publish(message)

    def _localization_of(self, outputs: SimPublishers) -> Perfect:
        kind, truth = self._values["localization"], self._simulation.robot.pose
        if kind == "amcl":
            return Amcl(outputs, truth, self._values["seed"])
        return Slam(self._simulation.world, self._map) if kind == "slam" else Perfect()

    def _tf_message(self, transforms: Iterable[FrameTransform]) -> bytes:
        """Return a message of transforms, with the prefix of the robot before its own frames."""
        return messages.tf(
            transform._replace(
                parent=self._named(transform.parent), child=self._named(transform.child)
            )
            if self._prefix
            else transform
            for transform in transforms
        )

    def _named(self, frame: str) -> str:
        return frame if frame == "map" else self._prefix + frame


class _Schedule:
    """Schedule of an event that repeats at a rate, in simulated seconds."""

    def __init__(self) -> None:
        self._next = 0.0

    def __call__(self, now: float, rate: float) -> bool:
        if now < self._next - 1e-9:
            return False
        self._next = max(self._next + 1.0 / rate, now)
        return True
