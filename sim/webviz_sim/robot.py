"""A differential drive: how it moves, and how walls stop it."""

import math
from dataclasses import dataclass, field

import numpy as np

from webviz_sim.circles import NONE, Circles, nearest
from webviz_sim.pose import Pose2D
from webviz_sim.world import World

# Of the bundled robot (webviz_urdf/demo/robot.urdf), in metres.
WHEEL_RADIUS = 0.05
WHEEL_SEPARATION = 0.30
RADIUS = 0.20  # of the circle around base_link that contains the robot

MAX_LINEAR = 0.6  # m/s
MAX_ANGULAR = 2.0  # rad/s


def drive(pose: Pose2D, linear: float, angular: float, seconds: float) -> Pose2D:
    """Move a pose with constant velocities, exactly: along a circular arc.

    Args:
        pose: The start.
        linear: Forward velocity in m/s.
        angular: Counter-clockwise velocity in rad/s.
        seconds: Duration.
    """
    half = 0.5 * angular * seconds
    # The chord of the arc; np.sinc(x) is sin(pi x) / (pi x) and well behaved at 0.
    chord = linear * seconds * float(np.sinc(half / math.pi))
    return pose @ Pose2D(chord * math.cos(half), chord * math.sin(half), 2.0 * half)


@dataclass
class DifferentialDrive:
    """A kinematic differential-drive robot in a world."""

    world: World
    pose: Pose2D
    """base_link in the map frame: the truth."""
    random: np.random.Generator
    drift: float = 0.0
    """Standard deviation of the odometry's error, as a fraction of the motion of one step."""
    odometry: Pose2D = field(default_factory=Pose2D)
    """base_link in the odom frame, as measured by the wheels."""
    linear: float = 0.0
    angular: float = 0.0
    """The velocities of the last step, in m/s and rad/s, after limits and walls."""
    wheels: list[float] = field(default_factory=lambda: [0.0, 0.0])
    """Angles of the left and the right wheel, in radians."""
    circles: Circles = field(default_factory=lambda: NONE)
    """Obstacles that are not in the world."""
    slip: float = 0.0
    """Share of the wheels' motion that the robot does not make."""

    def step(self, linear: float, angular: float, seconds: float) -> None:
        """Move with the commanded velocities, as far as limits and walls allow.

        At a wall the wheels stall: the robot stops where it touches, and can still turn on the
        spot or drive away.
        """
        linear = min(max(linear, -MAX_LINEAR), MAX_LINEAR)
        angular = min(max(angular, -MAX_ANGULAR), MAX_ANGULAR)
        grip = 1.0 - self.slip
        linear *= self._free_fraction(linear * grip, angular * grip, seconds)
        self.pose = drive(self.pose, linear * grip, angular * grip, seconds)
        stretch, skew = (1.0 + self.drift * self.random.standard_normal(2)).tolist()
        self.odometry = drive(self.odometry, linear * stretch, angular * skew, seconds)
        self.linear, self.angular = linear, angular
        for wheel, side in enumerate((-0.5, 0.5)):
            speed = (linear + side * WHEEL_SEPARATION * angular) / WHEEL_RADIUS
            self.wheels[wheel] += speed * seconds

    @property
    def wheel_speeds(self) -> tuple[float, float]:
        """Angular velocities of the left and the right wheel in rad/s."""
        turn = 0.5 * WHEEL_SEPARATION * self.angular
        return (self.linear - turn) / WHEEL_RADIUS, (self.linear + turn) / WHEEL_RADIUS

    def _clearance(self, pose: Pose2D) -> float:
        """Distance in metres from a pose to what is in the way, at most `RADIUS`."""
        beside = nearest(self.circles, pose.x, pose.y)
        return min(beside, self.world.clearance(pose, RADIUS))

    def _free_fraction(self, linear: float, angular: float, seconds: float) -> float:
        """Return the possible share of a step's forward motion, less than 1 at a wall."""
        if linear == 0.0 or self._clearance(self.pose) < RADIUS:
            return 1.0  # a robot placed inside a wall may leave it

        def fits(fraction: float) -> bool:
            pose = drive(self.pose, linear * fraction, angular, seconds)
            return self._clearance(pose) >= RADIUS

        # A step is split so finely that no wall fits between two checked places.
        pieces = math.ceil(abs(linear) * seconds / (0.5 * self.world.resolution))
        blocked = next((i for i in range(1, pieces + 1) if not fits(i / pieces)), None)
        if blocked is None:
            return 1.0
        free, wall = (blocked - 1) / pieces, blocked / pieces
        for _ in range(8):
            middle = 0.5 * (free + wall)
            free, wall = (middle, wall) if fits(middle) else (free, middle)
        return free
