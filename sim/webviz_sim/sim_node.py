"""The node `/sim`: its parameters and commands."""

import math
from typing import Any

from geometry_msgs.msg import PoseStamped, PoseWithCovarianceStamped, Twist, TwistStamped
from rcl_interfaces.msg import (
    FloatingPointRange,
    IntegerRange,
    ParameterDescriptor,
    SetParametersResult,
)
from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Empty

from webviz_sim import messages, options
from webviz_sim.broadcaster import Broadcaster
from webviz_sim.navigation import Navigation
from webviz_sim.pose import Pose2D
from webviz_sim.simulation import Simulation, SimulationSettings
from webviz_sim.world import load_world


class SimNode(Node):
    """Steps a simulation, publishes what a real robot would, and receives commands."""

    def __init__(self, start: int):
        """Creates the node and publishes the latched messages.

        Args:
            start: The time in nanoseconds; ignored with `publish_clock`.

        Raises:
            WorldError: The world cannot be loaded, or has no room for the robot.
            rclpy.exceptions.InvalidParameterValueException: A parameter is refused.
        """
        super().__init__("sim")
        self._values: dict[str, Any] = {}
        self._settings = SimulationSettings()
        self.add_on_set_parameters_callback(self._check)
        self.add_post_set_parameters_callback(self._apply)
        for name, option in options.OPTIONS.items():
            self.declare_parameter(name, option.default, _descriptor(option))

        values = self._values
        world = load_world(values["world"] or options.BUILDING)
        start_pose = Pose2D(*values["start_pose"]) if values["start_pose"] else None
        self._simulation = Simulation(world, self._settings, start_pose, values["seed"])
        latched_at = 0 if values["publish_clock"] else start
        self._broadcaster = Broadcaster(self, self._simulation, values, latched_at)
        self._navigation = Navigation(self, self._simulation)
        self._publish(start)

        if values["stamped_cmd_vel"]:
            self.create_subscription(TwistStamped, "/cmd_vel", self._drive_stamped, 10)
        else:
            self.create_subscription(Twist, "/cmd_vel", self._drive, 10)
        self.create_subscription(PoseStamped, "/goal_pose", self._go, 10)
        self.create_subscription(PoseWithCovarianceStamped, "/initialpose", self._put, 10)
        self.create_service(Empty, "/reset_odom", self._reset_odometry)

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
        simulated = self._values["publish_clock"]
        self._broadcaster.publish(round(self._simulation.time * 1e9) if simulated else now)

    def _check(self, parameters: list[Parameter]) -> SetParametersResult:
        values = self._values | {p.name: p.value for p in parameters}
        reason = options.refusal(values)
        return SetParametersResult(successful=reason is None, reason=reason or "")

    def _apply(self, parameters: list[Parameter]) -> None:
        self._values.update({p.name: p.value for p in parameters})
        for name in ("tour", "tour_speed", "cmd_vel_timeout", "odom_drift"):
            if name in self._values:
                setattr(self._settings, name, self._values[name])

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
        else:
            self._simulation.put(pose)

    def _reset_odometry(self, _: Empty.Request, response: Empty.Response) -> Empty.Response:
        self._simulation.reset_odometry()
        return response

    def _warn(self, sentence: str) -> None:
        self.get_logger().warning(sentence)


def _descriptor(option: options.Option) -> ParameterDescriptor:
    """What `ros2 param describe` says about a parameter."""
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
