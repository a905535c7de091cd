"""The node `/sim`: its parameters and commands."""

import math
from collections.abc import Sequence
from typing import Any

from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, Twist, TwistStamped
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    ParameterType,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Empty

from webviz_sim import messages, options
from webviz_sim.broadcaster import Broadcaster
from webviz_sim.navigation import Navigation
from webviz_sim.pose import Pose2D
from webviz_sim.publishers import RosPublishers
from webviz_sim.simulation import Simulation, SimulationSettings
from webviz_sim.world import WorldError, load_world


class SimNode(Node):
    """Steps a simulation, publishes what a real robot would, and receives commands."""

    def __init__(self, start: int, fleet: Sequence["SimNode"] = (), namespace: str = "") -> None:
        """Create the node and publish the latched messages.

        Args:
            start: The time in nanoseconds; ignored with `publish_clock`.
            fleet: Of other robots in the same world.
            namespace: Of its topics.

        Raises:
            WorldError: The world cannot be loaded, or has no room for the robot.
            rclpy.exceptions.InvalidParameterValueException: A parameter is refused.
        """
        super().__init__("sim", namespace=namespace or None)
        self._values: dict[str, Any] = {}
        self._settings = SimulationSettings()
        self.add_on_set_parameters_callback(self._set)
        for name, option in options.OPTIONS.items():
            self.declare_parameter(name, option.default, _descriptor(option))
        # rclpy declares it without a description.
        about_time = "Unused: time is the system's, or that of /clock here, see publish_clock."
        self.set_descriptor(
            "use_sim_time",
            ParameterDescriptor(type=ParameterType.PARAMETER_BOOL, description=about_time),
        )

        values = self._values
        values["seed"] += len(fleet)
        start_pose = Pose2D(*values["start_pose"]) if values["start_pose"] else None
        if fleet:
            world = fleet[0]._simulation.world
            start_pose = fleet[0]._free_place(len(fleet))
        else:
            world = load_world(values["world"] or options.BUILDING)
        self._simulation = Simulation(
            world, self._settings, start_pose, values["seed"], values["obstacles"]
        )
        for node in fleet:
            node._simulation.others.append(self._simulation.robot)
            self._simulation.others.append(node._simulation.robot)
        self._is_simulated = values["publish_clock"]
        latched_at = 0 if self._is_simulated else start
        values["publish_clock"] &= not fleet  # one clock for all
        self._broadcaster = Broadcaster(RosPublishers(self), self._simulation, values, latched_at)
        self._navigation = Navigation(self, self._simulation)
        self._publish(start)

        if values["stamped_cmd_vel"]:
            self.create_subscription(TwistStamped, "cmd_vel", self._drive_stamped, 10)
        else:
            self.create_subscription(Twist, "cmd_vel", self._drive, 10)
        self.create_subscription(PoseStamped, "goal_pose", self._go, 10)
        self.create_subscription(PoseWithCovarianceStamped, "initialpose", self._put, 10)
        self.create_service(Empty, "reset_odom", self._reset_odometry)

    @property
    def period(self) -> float:
        """The length of a step in seconds."""
        return 1.0 / self._values["rate"]

    def step(self, now: int) -> None:
        """Advances by one period and publishes the messages that are due.

        Args:
            now: The time in nanoseconds, for the stamps; ignored with `publish_clock`.
        """
        self._simulation.step(self.period)
        self._navigation.step()
        self._publish(now)

    def _publish(self, now: int) -> None:
        simulated = self._is_simulated
        self._broadcaster.publish(round(self._simulation.time * 1e9) if simulated else now)

    def _set(self, parameters: list[Parameter]) -> SetParametersResult:
        """Take the values of parameters, unless one is refused."""
        values = self._values | {p.name: p.value for p in parameters}
        reason = options.refusal(values)
        if reason is None:
            self._values.update(values)
            for name in ("tour", "tour_speed", "cmd_vel_timeout", "odom_drift", "slip"):
                if name in values:
                    setattr(self._settings, name, values[name])
        return SetParametersResult(successful=reason is None, reason=reason or "")

    def _drive_stamped(self, message: TwistStamped) -> None:
        self._drive(message.twist)

    def _drive(self, twist: Twist) -> None:
        linear, angular = twist.linear.x, twist.angular.z
        if math.isfinite(linear) and math.isfinite(angular):
            self._simulation.command(linear, angular)
        else:
            self._warn("Ignored a /cmd_vel that is not finite.")

    def _go(self, message: PoseStamped) -> None:
        goal = messages.to_map_pose(message.header, message.pose)
        if isinstance(goal, str):
            self._warn(f"Ignored a /goal_pose {goal}.")
        elif not self._simulation.go_to(goal):
            self._warn(f"No path to the goal at x {goal.x:.2f} m, y {goal.y:.2f} m.")

    def _put(self, message: PoseWithCovarianceStamped) -> None:
        pose = messages.to_map_pose(message.header, message.pose.pose)
        if isinstance(pose, str):
            self._warn(f"Ignored an /initialpose {pose}.")
        elif not self._broadcaster.localization.put(pose):
            self._simulation.put(pose)

    def _free_place(self, robots: int) -> Pose2D:
        """Return the place for the next robot, as far as possible from those of so many robots.

        Raises:
            WorldError: The world has no other place.
        """
        simulation = self._simulation
        places = simulation.planner.spread(simulation.robot.pose, robots)
        if len(places) < robots:
            raise WorldError(f"The world has places for {len(places) + 1} robots only.")
        return places[-1]

    def _reset_odometry(self, _: Empty.Request, response: Empty.Response) -> Empty.Response:
        self._simulation.reset_odometry()
        return response

    def _warn(self, sentence: str) -> None:
        self.get_logger().warning(sentence)


def _descriptor(option: options.Option) -> ParameterDescriptor:
    """Return the descriptor that `ros2 param describe` shows."""
    # Typed dynamically, a rate of 10 is as good as one of 10.0.
    described = ParameterDescriptor(
        description=option.help, read_only=option.read_only, dynamic_typing=True
    )
    if option.range is not None:
        low, high = option.range
        if type(option.default) is int:
            limits = IntegerRange(from_value=int(low), to_value=int(high), step=0)
            described.integer_range = [limits]
        else:
            described.floating_point_range = [FloatingPointRange(from_value=low, to_value=high)]
    return described
