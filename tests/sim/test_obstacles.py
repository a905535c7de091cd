"""Obstacles no map has: people, boxes and other robots, for the scanner and the robot."""

import math

import numpy as np
import pytest

from webviz_sim.circles import NONE, cast, nearest
from webviz_sim.crowd import SPEED, Crowd
from webviz_sim.lidar import LidarSettings, scan
from webviz_sim.options import FAULT, OPTIONS, refusal
from webviz_sim.planner import Planner
from webviz_sim.pose import Pose2D
from webviz_sim.robot import RADIUS, DifferentialDrive
from webviz_sim.simulation import Simulation, SimulationSettings
from webviz_sim.world import World


def test_rays_end_where_they_enter_a_circle() -> None:
    circles = np.array([[3.0, 0.0, 1.0], [0.0, 5.0, 0.5]])
    angles = np.array([0.0, math.pi / 2, math.pi, math.asin(1.0 / 3.0) + 0.01])
    zeros = np.zeros(4)
    assert cast(circles, zeros, zeros, angles) == pytest.approx([2.0, 4.5, math.inf, math.inf])
    assert np.isinf(cast(NONE, zeros, zeros, angles)).all()
    # A scanner inside of one sees the others.
    assert cast(circles, zeros + 3.0, zeros, angles)[1] == math.inf


def test_the_nearest_circle_is_as_far_as_its_edge() -> None:
    assert nearest(np.array([[3.0, 4.0, 1.0], [9.0, 0.0, 1.0]]), 0.0, 0.0) == pytest.approx(4.0)
    assert nearest(NONE, 0.0, 0.0) == math.inf


def test_the_scanner_sees_a_person_before_the_wall(room: World) -> None:
    middle = Pose2D(2.6, 2.1, 0.0)
    settings = LidarSettings(beams=4, noise=0.0)
    person = np.array([[3.6, 2.1, 0.2]])
    random = np.random.default_rng(0)
    without = scan(room, middle, middle, settings, random).ranges
    ranges = scan(room, middle, middle, settings, random, person).ranges
    assert ranges[2] == pytest.approx(0.8, abs=1e-4)  # ahead
    assert np.delete(ranges, 2) == pytest.approx(np.delete(without, 2))


def test_a_robot_stops_in_front_of_a_person(room: World) -> None:
    robot = DifferentialDrive(room, Pose2D(1.0, 2.0, 0.0), np.random.default_rng(0))
    robot.circles = np.array([[2.0, 2.0, 0.2]])
    for _ in range(200):
        robot.step(0.5, 0.0, 0.02)
    assert robot.pose.x == pytest.approx(2.0 - 0.2 - RADIUS, abs=0.01)


def test_wheels_that_slip_count_more_than_the_robot_moves(room: World) -> None:
    robot = DifferentialDrive(room, Pose2D(1.0, 2.0, 0.0), np.random.default_rng(0), slip=0.25)
    for _ in range(100):
        robot.step(0.5, 0.0, 0.02)
    assert robot.odometry.x == pytest.approx(1.0)
    assert robot.pose.x - 1.0 == pytest.approx(0.75)


def test_people_walk_on_free_ground_and_the_same_way_for_a_seed(room: World) -> None:
    start = Pose2D(1.0, 1.0, 0.0)
    crowds = [Crowd(Planner(room), start, 3, seed) for seed in (4, 4, 5)]
    before = crowds[0].circles
    for _ in range(400):
        for crowd in crowds:
            crowd.step(0.05)
        steps = np.hypot(*(crowds[0].circles - before)[:, :2].T)
        assert (steps <= SPEED * 0.05 + 1e-9).all()
        before = crowds[0].circles
        assert all(room.clearance(Pose2D(*c[:2]), 0.1) > 0.0 for c in before)
    assert np.array_equal(crowds[0].circles, crowds[1].circles)
    assert not np.array_equal(crowds[0].circles, crowds[2].circles)


def test_unknown_values_of_options_are_refused() -> None:
    assert refusal({"localization": "gps"}) == "localization must be perfect, amcl or slam."
    faults = [name for name in OPTIONS if name.startswith(FAULT)]
    assert len(faults) == 4
    assert all(refusal({name: math.nan}) for name in faults)


class UnreadPublisher:
    """A publisher without subscribers."""

    def publish(self, cdr: bytes) -> None:
        """Do nothing."""


def test_the_map_of_slam_grows_with_the_scans(room: World) -> None:
    pytest.importorskip("rclpy", reason="rclpy is not installed", exc_type=ImportError)
    from webviz_sim.localization import Slam

    settings = LidarSettings(beams=720, noise=0.0, range_max=1.5)
    slam = Slam(room, UnreadPublisher())
    shares = [slam.share]
    for x in (1.0, 2.0, 3.0, 4.0):
        place = Pose2D(x, 2.1, 0.3)
        measured = scan(room, place, place, settings, np.random.default_rng(0))
        slam.see(place, measured, settings.range_max)
        shares.append(slam.share)
    assert shares[0] == 0.0
    assert np.diff(shares).min() > 0.05
    assert 0.5 < shares[-1] < 0.9


def test_robots_whose_ways_cross_get_around_each_other(room: World) -> None:
    starts = Pose2D(1.0, 2.0, 0.0), Pose2D(4.0, 2.0, math.pi)
    robots = [Simulation(room, SimulationSettings(tour=False), start) for start in starts]
    for one, other in (robots, robots[::-1]):
        one.others.append(other.robot)
        assert one.go_to(other.robot.pose)
    for _ in range(round(40.0 / 0.02)):
        for robot in robots:
            robot.step(0.02)
            assert nearest(robot.circles, *robot.robot.pose[:2]) >= RADIUS - 1e-9
    for robot, goal in zip(robots, starts[::-1], strict=True):
        assert math.dist(robot.robot.pose[:2], goal[:2]) < 0.5
