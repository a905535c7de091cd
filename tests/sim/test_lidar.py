import math
from dataclasses import replace

import numpy as np
import pytest

from webviz_sim.lidar import LidarSettings, Scan, scan
from webviz_sim.pose import Pose2D
from webviz_sim.world import World

EXACT = LidarSettings(beams=8, noise=0.0)


def measure(
    world: World,
    first: Pose2D,
    last: Pose2D | None = None,
    settings: LidarSettings = EXACT,
    seed: int = 0,
) -> Scan:
    return scan(world, first, last or first, settings, np.random.default_rng(seed))


def test_beams_begin_behind_and_go_round_to_the_left(room: World) -> None:
    # The walls begin at x = 0.1 and 5.1, y = 0.1 and 4.1.
    ranges = measure(room, Pose2D(2.0, 1.0)).ranges
    assert ranges[[0, 2, 4, 6]] == pytest.approx([1.9, 0.9, 3.1, 3.1], abs=1e-6)
    turned = measure(room, Pose2D(2.0, 1.0, math.pi / 2)).ranges
    assert turned[[0, 2, 4, 6]] == pytest.approx([0.9, 3.1, 3.1, 1.9], abs=1e-6)


def test_ranges_outside_the_limits_are_infinite(room: World) -> None:
    settings = LidarSettings(beams=8, noise=0.0, range_min=1.0, range_max=2.5)
    ranges, intensities = measure(room, Pose2D(2.0, 1.0), settings=settings)
    assert ranges[0] == pytest.approx(1.9, abs=1e-6)
    assert np.isinf(ranges[[2, 4, 6]]).all()
    assert (intensities[np.isinf(ranges)] == 0.0).all()


def test_noise_has_its_standard_deviation_and_its_seed(room: World) -> None:
    noisy = LidarSettings(beams=5000, noise=0.02)
    exact = measure(room, Pose2D(2.0, 1.0), settings=LidarSettings(beams=5000, noise=0.0)).ranges
    ranges = measure(room, Pose2D(2.0, 1.0), settings=noisy).ranges
    assert np.std(ranges - exact) == pytest.approx(0.02, rel=0.1)
    assert np.array_equal(ranges, measure(room, Pose2D(2.0, 1.0), settings=noisy).ranges)
    assert not np.array_equal(
        ranges, measure(room, Pose2D(2.0, 1.0), settings=noisy, seed=1).ranges
    )


def test_intensity_falls_with_distance_and_slant(room: World) -> None:
    intensities = measure(room, Pose2D(2.0, 1.0), settings=LidarSettings(noise=0.0)).intensities
    assert 0.0 < intensities.min() < intensities.max() <= 100.0
    assert intensities[90] > intensities[180]  # the nearer wall, both met at right angles
    assert intensities[90] > intensities[60]  # the same wall, slanting


def test_a_sweeping_scanner_measures_each_beam_from_where_it_is_then(room: World) -> None:
    first, last = Pose2D(2.0, 1.0, 0.0), Pose2D(2.4, 1.0, 0.0)
    ranges = measure(room, first, last).ranges
    # Beam 4 of 8 looks ahead half a revolution later, 0.2 m farther on.
    assert ranges[4] == pytest.approx(5.1 - 2.2, abs=1e-6)
    assert ranges[0] == pytest.approx(1.9, abs=1e-6)


def test_a_turn_through_pi_is_swept_the_short_way_round(room: World) -> None:
    steady = measure(room, Pose2D(2.0, 1.0, math.pi - 0.05), Pose2D(2.0, 1.0, -math.pi + 0.05))
    middle = measure(room, Pose2D(2.0, 1.0, math.pi))
    assert steady.ranges[4] == pytest.approx(middle.ranges[4], abs=1e-3)


def test_the_scanner_works_in_a_turned_and_shifted_map(room: World) -> None:
    turn = Pose2D(-3.0, 7.0, 2.0)
    turned = replace(room, origin=turn @ room.origin)
    settings = LidarSettings(noise=0.0)
    expected = measure(room, Pose2D(2.0, 1.0, 0.3), settings=settings).ranges
    ranges = measure(turned, turn @ Pose2D(2.0, 1.0, 0.3), settings=settings).ranges
    assert np.allclose(ranges, expected, atol=1e-5)
