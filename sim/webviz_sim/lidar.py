"""The laser scanner."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from webviz_sim.circles import NONE, Circles, cast
from webviz_sim.pose import Pose2D
from webviz_sim.raycast import cast_rays
from webviz_sim.world import World


@dataclass
class LidarSettings:
    """Properties of a scanner."""

    beams: int = 360
    """Beams of one revolution; the first looks backwards (-pi), the others follow to the left."""
    range_min: float = 0.12
    range_max: float = 10.0
    """Distances in metres outside of which nothing is measured."""
    noise: float = 0.01
    """Standard deviation of a range in metres."""


class Scan(NamedTuple):
    """One revolution, as in sensor_msgs/LaserScan."""

    ranges: NDArray[np.float32]
    """Shape (beams,), metres; infinite if nothing is within range (REP 117)."""
    intensities: NDArray[np.float32]
    """Shape (beams,), 0 to 100."""


def scan(
    world: World,
    first: Pose2D,
    last: Pose2D,
    settings: LidarSettings,
    random: np.random.Generator,
    circles: Circles = NONE,
) -> Scan:
    """Measures one revolution.

    Args:
        world: The world to scan.
        first: The scanner in the map frame at the first beam.
        last: The scanner one revolution later; in between it moves steadily.
        settings: The scanner.
        random: Source of the noise.
        circles: Obstacles that are not in the world.
    """
    fractions = np.arange(settings.beams) / settings.beams
    start, end = world.to_grid(first), world.to_grid(last)
    turned = math.remainder(end.yaw - start.yaw, math.tau)
    x = start.x + fractions * (end.x - start.x)
    y = start.y + fractions * (end.y - start.y)
    angles = start.yaw + fractions * turned - math.pi + math.tau * fractions
    reach = settings.range_max / world.resolution
    distances, incidence = cast_rays(world.occupied, x, y, angles, reach)
    if len(circles):
        centres = world.to_cells(circles[:, :2])
        scaled = np.column_stack([centres, circles[:, 2] / world.resolution])
        met = cast(scaled, x, y, angles)
        incidence[met < distances] = 1.0
        distances = np.minimum(distances, met)
    ranges = distances * world.resolution
    # A matt surface returns less of a beam that is flat or comes from far away.
    intensities = 100.0 * incidence / (1.0 + (ranges / 4.0) ** 2)
    ranges = ranges + settings.noise * random.standard_normal(settings.beams)
    ranges[(ranges < settings.range_min) | (ranges > settings.range_max)] = np.inf
    intensities[np.isinf(ranges)] = 0.0
    return Scan(ranges.astype(np.float32), intensities.astype(np.float32))
