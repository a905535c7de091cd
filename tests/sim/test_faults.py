"""The simulator's faults, and the status of the viewer that names each."""

from __future__ import annotations

import functools
import time
from collections.abc import Callable, Iterator

import pytest

pytest.importorskip("rclpy", reason="rclpy is not installed", exc_type=ImportError)

from bench import Bench, benches
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, qos_profile_sensor_data

from webviz.ros.types import message_class
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.path import Path
from webviz_sim.broadcaster import Broadcaster
from webviz_sim.options import BUILDING, FAULT, OPTIONS
from webviz_sim.publishers import RosPublishers
from webviz_sim.simulation import Simulation, SimulationSettings
from webviz_sim.world import load_world

pytestmark = pytest.mark.usefixtures("webviz_domain")

SECOND = 1_000_000_000
PERIOD_S = 0.1
LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
TOPICS = {
    "/tf": ("tf2_msgs/msg/TFMessage", 100),
    "/tf_static": ("tf2_msgs/msg/TFMessage", LATCHED),
    "/map": ("nav_msgs/msg/OccupancyGrid", LATCHED),
    "/scan": ("sensor_msgs/msg/LaserScan", qos_profile_sensor_data),
    "/path": ("nav_msgs/msg/Path", 10),
}
DISPLAYS = Map, LaserScan, Path


@pytest.fixture(scope="module")
def context(webviz_domain: int) -> Iterator[Context]:
    context = Context()
    context.init(domain_id=webviz_domain)
    yield context
    context.try_shutdown()


class Demo:
    """A simulator that is stepped by hand, and a viewer that receives its messages by DDS."""

    def __init__(self, context: Context, bench: Bench, **faults: float) -> None:
        self.bench = bench
        self._node = node = Node("sim", context=context)
        self._executor = SingleThreadedExecutor(context=context)
        self._executor.add_node(node)
        for topic, (type_name, qos) in TOPICS.items():
            take = functools.partial(self._take, topic, type_name)
            node.create_subscription(message_class(type_name), topic, take, qos, raw=True)
        self._simulation = Simulation(load_world(BUILDING), SimulationSettings())
        values = {name: option.default for name, option in OPTIONS.items()}
        values |= {FAULT + name: value for name, value in faults.items()}
        self._sim = Broadcaster(RosPublishers(node), self._simulation, values, bench.source.now)
        self._received = 0
        while self._received < 2:  # the latched ones: all are connected
            self._executor.spin_once(timeout_sec=1.0)

    def _take(self, topic: str, type_name: str, cdr: bytes) -> None:
        self._received += 1
        self.bench.source.put(topic, type_name, bytes(cdr))

    def run(self, is_enough: Callable[[], bool], seconds: float = 60.0) -> None:
        """Let simulated time pass until something is so."""
        for _ in range(round(seconds / PERIOD_S)):
            self._simulation.step(PERIOD_S)
            self.bench.source.now += round(PERIOD_S * SECOND)
            self.bench.clock += PERIOD_S
            before = self._received
            self._sim.publish(self.bench.source.now)
            end = time.monotonic() + 1.0
            while self._received < before + 2 and time.monotonic() < end:  # /tf and /scan
                self._executor.spin_once(timeout_sec=0.01)
            self.bench.turn()
            if is_enough():
                return
        pytest.fail(str([self.bench.statuses(row) for row in range(len(DISPLAYS))]))

    def status(self, display: type, key: str) -> str:
        """Level and sentence of a status, "" without one."""
        level, text = self.bench.statuses(DISPLAYS.index(display)).get(key, ("", ""))
        return f"{level} {text}".strip()

    def measured(self, display: type, key: str) -> dict[str, float]:
        """The values of a status."""
        status = self.bench.states[-1].rows[DISPLAYS.index(display)].statuses[key]
        return {each.name: each.value for each in status.values}

    def close(self) -> None:
        self._executor.shutdown()
        self._node.destroy_node()


@pytest.fixture
def demo(context: Context) -> Iterator[Callable[..., Demo]]:
    with benches() as bench:
        demos: list[Demo] = []

        def make(**faults: float) -> Demo:
            demos.append(Demo(context, bench(*(display() for display in DISPLAYS)), **faults))
            return demos[-1]

        yield make
        for each in demos:
            each.close()


def test_without_a_fault_the_scan_lies_on_the_map(demo: Callable[..., Demo]) -> None:
    running_demo = demo()
    running_demo.run(lambda: "walls of /map" in running_demo.status(LaserScan, "Map"))
    assert running_demo.status(LaserScan, "Map").startswith(("OK 9", "OK 100"))
    running_demo.run(lambda: "Showing" in running_demo.status(Path, "Path"))
    assert running_demo.status(Path, "Obstacles") == ""


def test_a_turned_laser_is_named_with_its_angle(demo: Callable[..., Demo]) -> None:
    running_demo = demo(laser_yaw=0.5)
    running_demo.run(lambda: "rotating 'base_scan'" in running_demo.status(LaserScan, "Map"))
    text = running_demo.status(LaserScan, "Map")
    assert text.startswith("WARN Only")
    assert "Check the yaw of 'base_scan'" in text
    rotation = running_demo.measured(LaserScan, "Map")["rotation"]
    assert rotation == pytest.approx(-0.5, abs=0.07)


def test_a_misplaced_robot_is_named_with_its_shift(demo: Callable[..., Demo]) -> None:
    running_demo = demo(misplaced=2.0)
    running_demo.run(lambda: "a shift by" in running_demo.status(LaserScan, "Map"))
    result = running_demo.measured(LaserScan, "Map")
    assert (result["shift x"], result["shift y"]) == pytest.approx((0.0, -2.0), abs=0.25)
    assert "2D Pose Estimate" in running_demo.status(LaserScan, "Map")


def test_a_path_that_is_not_planned_again_is_named_with_its_age(
    demo: Callable[..., Demo],
) -> None:
    running_demo = demo(stale_path=1.0)
    running_demo.run(lambda: "not replanned" in running_demo.status(Path, "Obstacles"))
    assert "points of the laser scan and is" in running_demo.status(Path, "Obstacles")


def test_late_stamps_are_a_problem_of_clocks(demo: Callable[..., Demo]) -> None:
    running_demo = demo(clock=2.0)
    running_demo.run(lambda: "Clocks" in running_demo.bench.states[-1].statuses)
    assert "behind the clock" in running_demo.bench.states[-1].statuses["Clocks"].text
