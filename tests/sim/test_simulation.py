import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from worlds import draw_world

from webviz_sim.pose import Pose2D
from webviz_sim.robot import MAX_LINEAR, RADIUS, drive
from webviz_sim.simulation import RESUME_AFTER, Simulation, SimulationSettings
from webviz_sim.world import World, WorldError

STEP = 0.02
Simulations = Callable[..., Simulation]


@pytest.fixture
def simulate(building: World) -> Simulations:
    """Make a simulation which starts in the corridor and stands still unless told otherwise."""

    def make(start: Pose2D = Pose2D(), seed: int = 0, **settings: Any) -> Simulation:  # noqa: B008
        return Simulation(building, SimulationSettings(**{"tour": False, **settings}), start, seed)

    return make


def run(simulation: Simulation, seconds: float, step: float = STEP) -> None:
    for _ in range(round(seconds / step)):
        simulation.step(step)


@pytest.fixture
def simulation(simulate: Simulations) -> Simulation:
    """A robot that stands still."""
    return simulate()


def test_a_command_moves_the_robot_by_its_velocity_times_its_duration(
    simulation: Simulation,
) -> None:
    for _ in range(20):
        simulation.command(0.3, 0.2)
        run(simulation, 0.1)
    assert simulation.robot.pose == pytest.approx(drive(Pose2D(), 0.3, 0.2, 2.0))


def test_a_command_holds_for_its_timeout_only(simulate: Simulations) -> None:
    simulation = simulate(cmd_vel_timeout=0.5)
    simulation.command(0.2, 0.0)
    run(simulation, 3.0)
    assert simulation.robot.pose.x == pytest.approx(0.1, abs=0.2 * STEP)
    assert simulation.robot.linear == 0.0


def test_commands_are_clamped_to_the_limits_of_the_robot(simulation: Simulation) -> None:
    simulation.command(100.0, 0.0)
    run(simulation, 0.4)
    assert simulation.robot.pose.x == pytest.approx(0.4 * MAX_LINEAR)


def test_without_a_tour_the_robot_stays_where_it_is(simulation: Simulation) -> None:
    run(simulation, 10.0)
    assert simulation.robot.pose == Pose2D()
    assert len(simulation.path) == 0


def test_the_tour_goes_on_a_while_after_the_last_command(simulate: Simulations) -> None:
    simulation = simulate(tour=True)
    simulation.command(0.0, 0.0)
    run(simulation, RESUME_AFTER - 0.1)
    assert simulation.robot.pose == Pose2D()
    run(simulation, 5.0)
    assert simulation.robot.pose != Pose2D()
    assert len(simulation.path) > 1


def test_a_command_interrupts_the_tour_at_once(simulate: Simulations) -> None:
    simulation = simulate(tour=True)
    run(simulation, 5.0)
    before = simulation.robot.pose
    simulation.command(0.0, 0.5)
    run(simulation, 0.4)
    assert simulation.robot.pose == pytest.approx(drive(before, 0.0, 0.5, 0.4))


def test_switching_the_tour_off_stops_the_robot(simulate: Simulations) -> None:
    simulation = simulate(tour=True)
    run(simulation, 5.0)
    simulation.settings.tour = False
    run(simulation, STEP)
    before = simulation.robot.pose
    run(simulation, 2.0)
    assert simulation.robot.pose == before


def test_a_goal_is_reached_with_its_heading(simulation: Simulation) -> None:
    goal = Pose2D(1.2, 2.5, -2.0)
    assert simulation.go_to(goal)
    run(simulation, 30.0)
    pose = simulation.robot.pose
    assert math.dist(pose[:2], goal[:2]) < 0.15
    assert pose.yaw == pytest.approx(goal.yaw, abs=0.1)


def test_a_goal_goes_before_the_tour(simulate: Simulations) -> None:
    simulation = simulate(tour=True)
    run(simulation, 3.0)
    goal = Pose2D(-1.0, 0.0)
    assert simulation.go_to(goal)
    assert simulation.path[-1] == pytest.approx(goal[:2])
    distances = []
    for _ in range(100):
        run(simulation, 0.2)
        distances.append(math.dist(simulation.robot.pose[:2], goal[:2]))
    assert min(distances) < 0.15


def test_a_goal_without_a_path_is_refused_and_changes_nothing() -> None:
    rows = [("." * 30 + "##" + "." * 30)] * 40
    simulation = Simulation(
        draw_world("\n".join(rows), 0.1), SimulationSettings(tour=False), Pose2D(1.0, 1.0)
    )
    assert not simulation.go_to(Pose2D(5.0, 1.0))
    run(simulation, 1.0)
    assert simulation.robot.pose == Pose2D(1.0, 1.0)


def test_a_goal_far_from_any_free_place_is_refused(simulation: Simulation) -> None:
    assert not simulation.go_to(Pose2D(1000.0, 0.0))
    assert len(simulation.path) == 0


def test_putting_the_robot_elsewhere_does_not_move_its_odometry(simulation: Simulation) -> None:
    simulation.command(0.3, 0.0)
    run(simulation, 0.4)
    odometry = simulation.robot.odometry
    simulation.put(Pose2D(2.0, 0.0, 1.0))
    assert simulation.robot.pose == Pose2D(2.0, 0.0, 1.0)
    assert simulation.robot.odometry == odometry


def test_resetting_the_odometry_does_not_move_the_robot(simulation: Simulation) -> None:
    simulation.command(0.3, 0.0)
    run(simulation, 0.4)
    pose = simulation.robot.pose
    simulation.reset_odometry()
    assert simulation.robot.odometry == Pose2D()
    assert simulation.robot.pose == pose


def test_the_tour_goes_on_from_wherever_the_robot_is_put(simulate: Simulations) -> None:
    simulation = simulate(tour=True)
    run(simulation, 5.0)
    simulation.put(Pose2D(-5.95, 3.9))  # into the desk
    run(simulation, 60.0)
    assert simulation.world.clearance(simulation.robot.pose, 1.0) >= RADIUS
    simulation.put(Pose2D(100.0, 100.0))
    run(simulation, 10.0)


def test_the_tour_visits_every_place_again_and_again_for_an_hour(
    simulate: Simulations, building: World
) -> None:
    simulation = simulate(tour=True)
    places = list(simulation.places)
    visits = [0] * len(places)
    near = [False] * len(places)
    step = 0.2
    while simulation.time < 3600.0:
        simulation.step(step)
        for index, place in enumerate(places):
            is_near = math.dist(simulation.robot.pose[:2], place[:2]) < 0.15
            visits[index] += is_near and not near[index]
            near[index] = is_near
    assert len(places) == 12
    assert min(visits) >= 8
    assert building.clearance(simulation.robot.pose, 1.0) >= RADIUS


@pytest.mark.parametrize("step", [0.1, 0.02, 0.005])
def test_the_tour_keeps_clear_of_walls_at_any_step(
    simulate: Simulations, building: World, step: float
) -> None:
    simulation = simulate(tour=True)
    clearances = []
    for _ in range(100):
        run(simulation, 0.5, step)
        clearances.append(building.clearance(simulation.robot.pose, 1.0))
    assert min(clearances) > RADIUS + 0.02


def test_the_same_seed_gives_the_same_simulation_and_another_does_not(
    simulate: Simulations,
) -> None:
    def trace(seed: int) -> NDArray[np.float64]:
        simulation = simulate(tour=True, odom_drift=0.05, seed=seed)
        poses = []
        for _ in range(40):
            run(simulation, 0.5)
            poses.append((*simulation.robot.pose, *simulation.robot.odometry))
        return np.array(poses)

    assert np.array_equal(trace(1), trace(1))
    assert not np.array_equal(trace(1), trace(2))


def test_the_robot_starts_where_there_is_room(building: World) -> None:
    simulation = Simulation(building, SimulationSettings())
    assert building.clearance(simulation.robot.pose, 1.0) > 0.5


def test_a_world_without_room_is_refused_in_one_sentence() -> None:
    with pytest.raises(WorldError, match=r"^The world has no free place .* to start\.$"):
        Simulation(draw_world("#####\n#...#\n#####", 0.05), SimulationSettings())
