"""The simulation without ROS: commands, goals, the tour, and what happens in one step."""

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from webviz_sim.circles import NONE, Circles
from webviz_sim.crowd import Crowd
from webviz_sim.planner import Planner
from webviz_sim.pose import Pose2D, wrap
from webviz_sim.robot import RADIUS, DifferentialDrive
from webviz_sim.world import World, WorldError

LOOKAHEAD = 0.35  # m
TOLERANCE = 0.12  # m from the end of the path at which it counts as reached
ACCELERATION = 0.6  # m/s^2
ANGULAR_ACCELERATION = 4.0  # rad/s^2
TURN_RATE = 1.2  # rad/s, at most
TURN_FIRST = 1.0  # rad of heading error from which the robot turns on the spot


class Follower:
    """Drives along one path.

    Pure pursuit (Coulter, "Implementation of the Pure Pursuit Path Tracking Algorithm", 1992):
    steer along the arc that meets the path at a fixed distance ahead, whose curvature is
    2 sin(heading error) / distance. Velocities change no faster than a small robot's do.
    """

    def __init__(self, path: NDArray[np.float64], yaw: float | None = None) -> None:
        """Start at the beginning of the path.

        Args:
            path: Points in the map frame, shape (n, 2), n at least 2.
            yaw: Heading at the end in rad; None for any.
        """
        self._path = path
        self._yaw = yaw
        self._passed = 0
        self.is_done = False

    def remaining(self) -> NDArray[np.float64]:
        """Return the points still ahead, shape (n, 2); none when the robot has arrived."""
        return self._path[self._passed :] if not self.is_done else self._path[:0]

    def step(
        self, pose: Pose2D, velocity: tuple[float, float], speed: float, seconds: float
    ) -> tuple[float, float]:
        """Return the linear and angular velocity for the next step, in m/s and rad/s.

        Args:
            pose: The robot in the map frame.
            velocity: Its current linear and angular velocity.
            speed: Maximum linear velocity in m/s.
            seconds: Length of the step.
        """
        linear, angular = self._velocity_to(pose, speed)
        return (
            _approach(velocity[0], linear, ACCELERATION * seconds),
            _approach(velocity[1], angular, ANGULAR_ACCELERATION * seconds),
        )

    def _velocity_to(self, pose: Pose2D, speed: float) -> tuple[float, float]:
        here = pose.x, pose.y
        # Look ahead a little only, so that a path that crosses itself is not cut short.
        window = self._path[self._passed : self._passed + 30]
        distances = np.hypot(*(window - here).T)
        nearest = int(distances.argmin())
        self._passed += nearest
        ahead = window[nearest:][distances[nearest:] >= LOOKAHEAD]
        target = ahead[0] if len(ahead) else window[-1]
        to_end = math.dist(here, self._path[-1])
        at_end = self._passed + len(window) - nearest >= len(self._path)
        if at_end and to_end < TOLERANCE:
            return 0.0, self._final_turn(pose)
        error = wrap(math.atan2(target[1] - pose.y, target[0] - pose.x) - pose.yaw)
        turn = min(max(2.5 * error, -TURN_RATE), TURN_RATE)
        if abs(error) > TURN_FIRST:
            return 0.0, turn
        distance = max(math.dist(here, target), TOLERANCE)
        curvature = 2.0 * math.sin(error) / distance
        # Slow enough to take the curve, and to stop at the end.
        linear = min(speed, TURN_RATE / max(abs(curvature), 1e-6))
        if at_end:
            linear = min(linear, math.sqrt(2.0 * 0.5 * ACCELERATION * to_end))
        return linear, curvature * linear

    def _final_turn(self, pose: Pose2D) -> float:
        error = 0.0 if self._yaw is None else wrap(self._yaw - pose.yaw)
        self.is_done = abs(error) < 0.05
        return 0.0 if self.is_done else min(max(2.5 * error, -TURN_RATE), TURN_RATE)


def _approach(value: float, target: float, step: float) -> float:
    return min(max(target, value - step), value + step)


RESUME_AFTER = 10.0  # s without a command after which the tour continues: a driver looks around
REST = 1.0  # s at each place of the tour
REST_AT_GOAL = 5.0  # s at a goal before the tour continues
PATIENCE = 6.0  # s without progress after which a path is abandoned
PROGRESS = 0.05  # m
NEARBY = 1.5  # m; paths lead around what moves as near as this
ROOM = 0.12  # m that it keeps to what moves ahead of it
BESIDE_GOAL = 0.5  # m; a free place this near to an occupied goal is accepted


@dataclass
class SimulationSettings:
    """Settings that may change while the simulation runs."""

    tour: bool = True
    """True if the robot tours the world while no commands arrive."""
    tour_speed: float = 0.35
    """Speed along a path in m/s."""
    cmd_vel_timeout: float = 0.5
    """Validity of a velocity command, in seconds."""
    odom_drift: float = 0.0
    """See `Robot.drift`."""
    slip: float = 0.0
    """See `Robot.slip`."""


class Simulation:
    """A robot in a world, simulated in steps of fixed length.

    Commands take precedence over goals, goals over the tour. A command drops the goal; after
    `RESUME_AFTER` without commands the tour continues, if enabled. Equal calls in equal order give
    equal states, whatever the speed of the machine.
    """

    def __init__(
        self,
        world: World,
        settings: SimulationSettings,
        start: Pose2D | None = None,
        seed: int = 0,
        obstacles: int = 0,
    ) -> None:
        """Put the robot into the world.

        Args:
            world: The world.
            settings: May be changed between steps.
            start: Start of the robot in the map frame; None for a place with room near the middle
                of the free space.
            seed: Of the odometry's drift, and of the obstacles' ways.
            obstacles: How many people walk about.

        Raises:
            WorldError: The world has no room for the robot.
        """
        self.world = world
        self.settings = settings
        self.planner = Planner(world)
        start = start or self.planner.roomy_pose()
        if start is None:
            raise WorldError(
                f"The world has no free place with {RADIUS:g} m around it for the robot to start."
            )
        self.robot = DifferentialDrive(world, start, np.random.default_rng(seed))
        self.crowd = Crowd(self.planner, start, obstacles, seed)
        self.others: list[DifferentialDrive] = []
        """Robots in the same world, each of a simulation of its own."""
        self.boxes: Circles = NONE
        """Obstacles that stay where they are."""
        self.time = 0.0
        self.places = self.planner.spread(start, count=12)
        """The places of the tour, the next one first."""
        self._command = (0.0, 0.0)
        self._commanded_at = -math.inf
        self._follower: Follower | None = None
        self._touring = False
        self._rest_until = 0.0
        self._goal: Pose2D | None = None
        self._turns = True
        self.reached: Pose2D | None = None
        """The last goal that was reached."""
        self._progress = (start, 0.0)

    @property
    def circles(self) -> Circles:
        """All obstacles that are not in the world."""
        return np.vstack([self._moving, self.boxes])

    @property
    def _moving(self) -> Circles:
        """The obstacles that move: people and other robots."""
        others = [(*other.pose[:2], RADIUS) for other in self.others]
        return np.vstack([self.crowd.circles, np.reshape(others, (-1, 3))])

    @property
    def path(self) -> NDArray[np.float64]:
        """The planned path from here on, in the map frame, shape (n, 2)."""
        return self._follower.remaining() if self._follower else np.empty((0, 2))

    @property
    def goal(self) -> Pose2D | None:
        """The goal it drives to."""
        return self._goal if self._follower and not self._touring else None

    def command(self, linear: float, angular: float) -> None:
        """Drives with velocities in m/s and rad/s for `cmd_vel_timeout`."""
        self._command = linear, angular
        self._commanded_at = self.time
        self._follower = None

    def go_to(self, goal: Pose2D, turn: bool = True) -> bool:
        """Plans a path to a goal in the map frame and follows it; False if there is none.

        Args:
            goal: The goal.
            turn: Whether to turn to its heading at the end.
        """
        path = self._plan(goal)
        if path is None or math.dist(path[-1], goal[:2]) > BESIDE_GOAL:
            return False
        self._follow(Follower(path, goal.yaw if turn else None), touring=False)
        self._goal, self._turns = goal, turn
        self._commanded_at = -math.inf
        return True

    def stop(self) -> None:
        """Drop the goal; the tour continues after a rest."""
        self._follower = None
        self._rest_until = self.time + REST_AT_GOAL

    def put(self, pose: Pose2D) -> None:
        """Move the robot to a place in the map; its odometry does not change."""
        self.robot.pose = pose
        self._follower = None

    def reset_odometry(self) -> None:
        """Make the robot's place the origin of the odom frame."""
        self.robot.odometry = Pose2D()

    def step(self, seconds: float) -> None:
        """Advances the simulation."""
        linear, angular = self._velocity(seconds)
        self.crowd.step(seconds)
        self.robot.circles = self.circles
        self.robot.drift, self.robot.slip = self.settings.odom_drift, self.settings.slip
        self.robot.step(linear, angular, seconds)
        self.time += seconds

    def _velocity(self, seconds: float) -> tuple[float, float]:
        since = self.time - self._commanded_at
        if since < self.settings.cmd_vel_timeout:
            return self._command
        if since < RESUME_AFTER:
            return 0.0, 0.0
        if self._follower is None and self._touring_now():
            self._next_place()
        follower = self._follower
        if follower is None:
            return 0.0, 0.0
        if self._touring and not self.settings.tour:
            self._follower = None
            return 0.0, 0.0
        robot = self.robot
        velocity = follower.step(
            robot.pose, (robot.linear, robot.angular), self.settings.tour_speed, seconds
        )
        if follower.is_done:
            self._arrive()
        elif self._is_stuck() and not self._goes_around():
            self._follower = None
        return (0.0, velocity[1]) if self._waits() else velocity

    def _touring_now(self) -> bool:
        return self.settings.tour and bool(self.places) and self.time >= self._rest_until

    def _next_place(self) -> None:
        """Set out for the place of the tour after the last one."""
        place = self.places.pop(0)
        self.places.append(place)
        path = self._plan(place)
        if path is not None:
            self._follow(Follower(path), touring=True)
        else:
            self._rest_until = self.time + REST

    def _plan(self, goal: Pose2D) -> NDArray[np.float64] | None:
        """Return a path around walls and moving people, whom it passes on the right."""
        near = self._near
        x, y = (near[:, :2] - self.robot.pose[:2]).T
        left = np.column_stack([-y, x]) / np.maximum(np.hypot(x, y), RADIUS)[:, None]
        beside = np.column_stack([near[:, :2] + RADIUS * left, near[:, 2]])
        return self.planner.plan(self.robot.pose, goal, np.vstack([near, beside]))

    @property
    def _near(self) -> Circles:
        """The moving obstacles nearby; those farther away will have moved."""
        moving, here = self._moving, self.robot.pose
        return moving[np.hypot(moving[:, 0] - here.x, moving[:, 1] - here.y) < NEARBY]

    def _waits(self) -> bool:
        """Return whether something that moves is so near that there would be no room to turn."""
        near, here = self._near, self.robot.pose
        x, y = (near[:, :2] - here[:2]).T
        ahead = x * math.cos(here.yaw) + y * math.sin(here.yaw)
        distance = np.hypot(x, y)
        is_close = distance - near[:, 2] < RADIUS + ROOM
        return bool((is_close & (ahead > 0.5 * distance)).any())

    def _goes_around(self) -> bool:
        """Return whether it can go on to its goal around what moves and stands in the way."""
        goal = self.goal
        return goal is not None and len(self._near) > 0 and self.go_to(goal, self._turns)

    def _follow(self, follower: Follower, touring: bool) -> None:
        self._follower, self._touring = follower, touring
        self._progress = (self.robot.pose, self.time)

    def _arrive(self) -> None:
        self._rest_until = self.time + (REST if self._touring else REST_AT_GOAL)
        if not self._touring:
            self.reached = self._goal
        self._follower = None

    def _is_stuck(self) -> bool:
        """Return whether the robot has not moved for a while although it had a path."""
        pose, since = self._progress
        here = self.robot.pose
        if math.dist(pose[:2], here[:2]) > PROGRESS:
            self._progress = (here, self.time)
        return self.time - since > PATIENCE
