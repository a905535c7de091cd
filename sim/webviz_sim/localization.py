"""Stand-ins for what places a robot in its map: none, AMCL and slam_toolbox.

They publish what those publish, with errors of their kind, from the truth of the simulation.
"""

import math

import numpy as np
from numpy.typing import NDArray

from webviz.data.map_file import UNKNOWN
from webviz_sim import messages
from webviz_sim.lidar import Scan
from webviz_sim.pose import Pose2D, wrap
from webviz_sim.publishers import SimPublisher, SimPublishers
from webviz_sim.world import World

PARTICLES = 300
STEADY = 0.04  # m, the standard deviation of a filter that has converged
CAPTURE = 1.0, 0.7  # m and rad; from farther away the filter does not find the robot
CONVERGENCE = 2.0  # s; of an error within that, a third remains after this time
TURN = 0.5  # rad of standard deviation for each metre of it


class Perfect:
    """Knows where the robot is."""

    def update(self, truth: Pose2D, seconds: float) -> None:
        """Take a measurement, so long after the last one."""
        self.pose = truth

    def publish(self, now: int) -> None:
        """Publish it, at a time in nanoseconds."""

    def see(self, scanner: Pose2D, scan: Scan, range_max: float) -> None:
        """Take a scan, and the true pose of the scanner in the map."""

    def put(self, pose: Pose2D) -> bool:
        """Return whether a pose on /initialpose is an estimate, not the robot's new place."""
        return False


class Amcl(Perfect):
    """Publishes amcl_pose and particle_cloud as nav2_amcl, and starts anew at an initial pose.

    Args:
        outputs: Creates the publishers.
        truth: Where the robot starts.
        seed: Of its errors.
    """

    def __init__(self, outputs: SimPublishers, truth: Pose2D, seed: int) -> None:
        self.pose = self._truth = truth
        self._random = np.random.default_rng([seed, 3])
        self._error = Pose2D()
        self._spread = 0.25
        type = "geometry_msgs/msg/PoseWithCovarianceStamped"
        self._pose = outputs.publisher(type, "amcl_pose", 1, "transient_local")
        self._cloud = outputs.publisher("nav2_msgs/msg/ParticleCloud", "particle_cloud", 0)

    def update(self, truth: Pose2D, seconds: float) -> None:
        """See `Perfect.update`."""
        x, y, yaw = self._error
        if math.hypot(x, y) < CAPTURE[0] and abs(yaw) < CAPTURE[1]:
            rest = math.exp(-seconds / CONVERGENCE)
            jitter = STEADY * math.sqrt(1.0 - rest * rest) * self._random.standard_normal(3)
            dx, dy, turn = (jitter * (1.0, 1.0, TURN)).tolist()
            self._error = Pose2D(x * rest + dx, y * rest + dy, yaw * rest + turn)
            self._spread = STEADY + (self._spread - STEADY) * rest
        self.pose = self._estimate(truth)
        self._truth = truth

    def put(self, pose: Pose2D) -> bool:
        """See `Perfect.put`."""
        x, y, yaw = pose.x - self._truth.x, pose.y - self._truth.y, pose.yaw - self._truth.yaw
        self._error, self._spread = Pose2D(x, y, wrap(yaw)), 0.5
        return True

    def publish(self, now: int) -> None:
        """See `Perfect.publish`."""
        sigma = np.array([self._spread, self._spread, TURN * self._spread])
        covariance = np.zeros((6, 6))
        covariance[[0, 1, 5], [0, 1, 5]] = sigma**2
        self._pose.publish(messages.pose_with_covariance(self.pose, covariance, now))
        offsets = sigma * self._random.standard_normal((PARTICLES, 3))
        self._cloud.publish(messages.particle_cloud(np.array(self.pose) + offsets, now))

    def _estimate(self, truth: Pose2D) -> Pose2D:
        x, y, yaw = self._error
        return Pose2D(truth.x + x, truth.y + y, wrap(truth.yaw + yaw))


class Slam(Perfect):
    """Publishes the part of the map that the scanner has seen, as slam_toolbox does.

    Args:
        world: What there is.
        publisher: Of the map.
    """

    def __init__(self, world: World, publisher: SimPublisher) -> None:
        self._world = world
        self._publisher = publisher
        self._cells = np.full_like(world.cells, UNKNOWN)

    @property
    def share(self) -> float:
        """The share of the known cells of the world that it has found."""
        return float((self._cells != UNKNOWN).sum() / max((self._world.cells != UNKNOWN).sum(), 1))

    def see(self, scanner: Pose2D, scan: Scan, range_max: float) -> None:
        """See `Perfect.see`."""
        world = self._world
        x, y, yaw = world.to_grid(scanner)
        count = len(scan.ranges)
        angles = yaw - math.pi + math.tau * np.arange(count) / count
        # A cell beyond what was hit belongs to the wall.
        ends = np.where(np.isfinite(scan.ranges), scan.ranges + world.resolution, range_max)
        steps = np.arange(0.0, float(ends.max()) / world.resolution, 0.7)
        rows, columns = _cells(x, y, angles, steps, ends / world.resolution)
        height, width = world.cells.shape
        inside = (rows >= 0) & (rows < height) & (columns >= 0) & (columns < width)
        cells = rows[inside], columns[inside]
        self._cells[cells] = world.cells[cells]

    def publish(self, now: int) -> None:
        """See `Perfect.publish`."""
        world = World(self._cells, self._world.resolution, self._world.origin)
        self._publisher.publish(messages.occupancy_grid(world, now))


def _cells(
    x: float,
    y: float,
    angles: NDArray[np.float64],
    steps: NDArray[np.float64],
    ends: NDArray[np.float64],
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Rows and columns of the cells at steps along rays, in cells, up to their ends."""
    is_before = steps < ends[:, None]
    columns = (x + np.cos(angles)[:, None] * steps)[is_before]
    rows = (y + np.sin(angles)[:, None] * steps)[is_before]
    return np.floor(rows).astype(np.intp), np.floor(columns).astype(np.intp)
