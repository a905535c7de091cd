import math
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from webviz_sim.description import demo_description
from webviz_sim.options import BUILDING
from webviz_sim.pose import Pose2D, wrap
from webviz_sim.robot import RADIUS, WHEEL_RADIUS, WHEEL_SEPARATION, DifferentialDrive, drive
from webviz_sim.world import World, load_world

coordinates = st.floats(-100, 100)
angles = st.floats(-math.pi, math.pi)
poses = st.builds(Pose2D, coordinates, coordinates, angles)


def robot_at(world: World, pose: Pose2D, drift: float = 0.0, seed: int = 0) -> DifferentialDrive:
    return DifferentialDrive(world, pose, np.random.default_rng(seed), drift)


@settings(deadline=None)
@given(poses, poses)
def test_a_pose_composed_with_its_inverse_is_the_identity(a: Pose2D, b: Pose2D) -> None:
    x, y, yaw = a.inverse() @ (a @ b)
    assert (x, y) == pytest.approx((b.x, b.y), abs=1e-9)
    assert wrap(yaw - b.yaw) == pytest.approx(0.0, abs=1e-9)


@settings(deadline=None)
@given(poses, st.floats(-1, 1), st.floats(0.1, 3), st.floats(0, 10))
def test_an_arc_keeps_its_distance_from_the_centre_of_turning(
    start: Pose2D, linear: float, angular: float, seconds: float
) -> None:
    end = drive(start, linear, angular, seconds)
    radius = linear / angular
    centre = start @ Pose2D(0.0, radius)
    assert math.dist(end[:2], centre[:2]) == pytest.approx(abs(radius), abs=1e-9)
    assert wrap(end.yaw - start.yaw - angular * seconds) == pytest.approx(0.0, abs=1e-9)


def test_arcs_have_their_closed_form() -> None:
    assert drive(Pose2D(), 0.5, 0.0, 2.0) == pytest.approx((1.0, 0.0, 0.0))
    quarter = drive(Pose2D(), math.pi / 2, math.pi / 2, 1.0)
    assert quarter == pytest.approx((1.0, 1.0, math.pi / 2))
    assert drive(Pose2D(3.0, 4.0), 1.0, 1.0, math.tau)[:2] == pytest.approx((3.0, 4.0))


@settings(deadline=None)
@given(st.floats(-1, 1), st.floats(-3, 3), st.integers(1, 50))
def test_many_small_steps_make_the_same_arc_as_one(
    linear: float, angular: float, count: int
) -> None:
    pose = Pose2D()
    for _ in range(count):
        pose = drive(pose, linear, angular, 1.0 / count)
    assert pose[:2] == pytest.approx(drive(Pose2D(), linear, angular, 1.0)[:2], abs=1e-9)


def test_odometry_equals_the_motion_in_the_frame_of_the_start(room: World) -> None:
    start = Pose2D(1.0, 2.0, 0.7)
    robot = robot_at(room, start)
    for _ in range(50):
        robot.step(0.3, 0.4, 0.02)
    assert start @ robot.odometry == pytest.approx(robot.pose)
    assert robot.odometry == pytest.approx(drive(Pose2D(), 0.3, 0.4, 1.0))


def test_wheels_roll_as_far_as_the_ground_below_them(room: World) -> None:
    robot = robot_at(room, Pose2D(1.0, 2.0))
    for _ in range(100):
        robot.step(0.2, 0.5, 0.01)
    left, right = (0.2 - 0.5 * WHEEL_SEPARATION / 2), (0.2 + 0.5 * WHEEL_SEPARATION / 2)
    assert robot.wheels == pytest.approx([left / WHEEL_RADIUS, right / WHEEL_RADIUS])
    assert robot.wheel_speeds == pytest.approx((left / WHEEL_RADIUS, right / WHEEL_RADIUS))


def test_the_dimensions_are_those_of_the_bundled_robot() -> None:
    root = ElementTree.fromstring(demo_description())
    wheel = root.find("link[@name='wheel_left_link']/collision/geometry/cylinder")
    origin = root.find("joint[@name='wheel_left_joint']/origin")
    box = root.find("link[@name='base_link']/collision/geometry/box")
    assert wheel is not None
    assert float(wheel.attrib["radius"]) == WHEEL_RADIUS
    assert origin is not None
    assert origin.attrib["xyz"].split() == ["0", str(WHEEL_SEPARATION / 2), str(WHEEL_RADIUS)]
    assert box is not None
    assert float(box.attrib["size"].split()[0]) / 2 <= RADIUS


@pytest.mark.parametrize("seconds", [0.02, 0.1, 1.0, 10.0])
def test_a_wall_stops_the_robot_where_it_touches(room: World, seconds: float) -> None:
    robot = robot_at(room, Pose2D(4.0, 2.0))
    for _ in range(math.ceil(10.0 / seconds)):
        robot.step(0.5, 0.0, seconds)
    # The wall begins at x = 5.1 m.
    assert robot.pose.x == pytest.approx(5.1 - RADIUS, abs=1e-3)
    assert room.clearance(robot.pose, 1.0) >= RADIUS - 1e-9
    assert robot.odometry.x == pytest.approx(robot.pose.x - 4.0)


def test_a_robot_at_a_wall_can_turn_and_drive_away(room: World) -> None:
    robot = robot_at(room, Pose2D(4.85, 2.0))
    robot.step(0.5, 0.0, 1.0)
    robot.step(0.5, 1.0, 1.0)
    assert robot.pose.yaw == pytest.approx(1.0)
    robot.step(-0.5, 0.0, 1.0)
    assert robot.pose.x < 4.7


@pytest.mark.parametrize("x", [5.0, 5.15, 50.0])
def test_a_robot_put_into_a_wall_or_outside_can_leave(room: World, x: float) -> None:
    robot = robot_at(room, Pose2D(x, 2.0))
    robot.step(-0.5, 0.0, 0.2)
    assert robot.pose.x == pytest.approx(x - 0.1)


@settings(deadline=None)
@given(st.integers(0, 1000))
def test_no_command_brings_the_robot_into_a_wall(seed: int) -> None:
    world = load_world(BUILDING)
    random = np.random.default_rng(seed)
    robot = robot_at(world, Pose2D(0.0, 0.0))
    for _ in range(40):
        robot.step(random.uniform(-2, 2), random.uniform(-2, 2), 0.3)
        assert world.clearance(robot.pose, 1.0) >= RADIUS - 1e-9


def test_drift_moves_the_odometry_away_from_the_truth_and_nothing_else(room: World) -> None:
    exact, drifting = robot_at(room, Pose2D(1.0, 2.0)), robot_at(room, Pose2D(1.0, 2.0), drift=0.1)
    for robot in (exact, drifting):
        for _ in range(100):
            robot.step(0.3, 0.1, 0.02)
    assert drifting.pose == exact.pose
    assert 1e-4 < math.dist(drifting.odometry[:2], exact.odometry[:2]) < 0.1
