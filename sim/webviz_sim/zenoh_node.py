"""The simulated robot over Zenoh, without ROS: `python -m webviz_sim.zenoh_node`."""

import argparse
import math
import os
import queue
import signal
import sys
import threading
import time
from collections.abc import Callable, Sequence
from typing import Any

from webviz.data.messages import MessageError, decode
from webviz_sim.broadcaster import Broadcaster
from webviz_sim.messages import to_map_pose
from webviz_sim.options import BUILDING, OPTIONS, fault_parameter, refusal
from webviz_sim.simulation import Simulation, SimulationSettings
from webviz_sim.world import WorldError, load_world
from webviz_sim.zenoh_wire import ZenohNode, open_session

MAX_COMMANDS = 100
"""Messages that wait for the next step; of more, the oldest are dropped."""
MAX_BYTES = 10_000
"""Limit in bytes of a command."""


class ZenohSim:
    """Steps a simulation, publishes what a real robot would, and receives commands.

    Args:
        session: That is open.
        domain: Number of the ROS domain.
        namespace: Of its topics, such as "/robot1"; "" for none.
        values: Of the options by name.
        fleet: Of other robots in the same world.
    """

    def __init__(
        self,
        session: Any,
        domain: int,
        namespace: str,
        values: dict[str, Any],
        fleet: Sequence["ZenohSim"] = (),
    ) -> None:
        self._values = values
        self._node = ZenohNode(session, domain, namespace, "sim")
        self._commands: queue.Queue[tuple[Callable[[Any], None], str, bytes]] = queue.Queue()
        self._simulation = self._placed(fleet)
        self._broadcaster = Broadcaster(self._node, self._simulation, values, time.time_ns())
        self._subscribe("cmd_vel", "geometry_msgs/msg/Twist", self._drive)
        self._subscribe("goal_pose", "geometry_msgs/msg/PoseStamped", self._go)
        pose = "geometry_msgs/msg/PoseWithCovarianceStamped"
        self._subscribe("initialpose", pose, self._put)

    def _placed(self, fleet: Sequence["ZenohSim"]) -> Simulation:
        """Return a simulation, with a place for the robot among others.

        Raises:
            WorldError: The world has no other place.
        """
        values, start = self._values, None
        if fleet:
            first = fleet[0]._simulation
            world = first.world
            places = first.planner.spread(first.robot.pose, len(fleet))
            if len(places) < len(fleet):
                raise WorldError(f"The world has places for {len(places) + 1} robots only.")
            start = places[-1]
        else:
            world = load_world(values["world"] or BUILDING)
        seed = values["seed"] + len(fleet)
        simulation = Simulation(world, SimulationSettings(), start, seed, values["obstacles"])
        for each in fleet:
            each._simulation.others.append(simulation.robot)
            simulation.others.append(each._simulation.robot)
        return simulation

    @property
    def period(self) -> float:
        """The length of a step in seconds."""
        return 1.0 / self._values["rate"]

    def step(self, now: int) -> None:
        """Take the commands, advance by one period and publish.

        Args:
            now: The time in nanoseconds, for the stamps.
        """
        for _ in range(self._commands.qsize()):
            take, type, cdr = self._commands.get_nowait()
            try:
                take(decode(type, cdr))
            except MessageError:
                print("Ignored a command that cannot be read.", file=sys.stderr)
        self._simulation.step(self.period)
        self._broadcaster.publish(now)

    def _subscribe(self, topic: str, type: str, take: Callable[[Any], None]) -> None:
        def arrive(payload: Any) -> None:
            if len(payload) <= MAX_BYTES:
                if self._commands.qsize() >= MAX_COMMANDS:
                    self._commands.get_nowait()
                self._commands.put((take, type, payload.to_bytes()))

        self._node.subscribe(type, topic, arrive)

    def _drive(self, twist: Any) -> None:
        linear, angular = twist.linear.x, twist.angular.z
        if math.isfinite(linear) and math.isfinite(angular):
            self._simulation.command(linear, angular)

    def _go(self, message: Any) -> None:
        goal = to_map_pose(message.header, message.pose)
        if not isinstance(goal, str):
            self._simulation.go_to(goal)

    def _put(self, message: Any) -> None:
        pose = to_map_pose(message.header, message.pose.pose)
        if not isinstance(pose, str) and not self._broadcaster.localization.put(pose):
            self._simulation.put(pose)


def main(args: list[str] | None = None) -> int:
    """Run the simulator until its standard input closes, or SIGINT or SIGTERM.

    Args:
        args: Command line without the program's name; None takes that of the process.

    Returns:
        The exit status: 0 after a signal, 1 if the simulator cannot run.
    """
    parser = argparse.ArgumentParser("webviz_sim.zenoh_node", description=__doc__)
    parser.add_argument("--connect", required=True, metavar="ENDPOINT", help="of the router")
    parser.add_argument("--robots", type=int, default=0, choices=range(1, 21), metavar="N")
    parser.add_argument("--fault", action="append", default=[], metavar="NAME=VALUE")
    options = parser.parse_args(args)
    values: dict[str, Any] = {name: option.default for name, option in OPTIONS.items()}
    for fault in options.fault:
        name, _, value = fault_parameter(fault).partition(":=")
        values[name] = float(value)
    if (reason := refusal(values)) is not None:
        print(f"Invalid parameter: {reason}", file=sys.stderr)
        return 1
    stopping = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stopping.set())
    threading.Thread(target=_until_stdin_closes, args=(stopping,), daemon=True).start()
    session = open_session("client", options.connect)
    domain = int(os.environ.get("ROS_DOMAIN_ID") or 0)
    try:
        robots: list[ZenohSim] = []
        for number in range(max(options.robots, 1)):
            namespace = f"/robot{number + 1}" if options.robots else ""
            fleet = tuple(robots)
            robots.append(ZenohSim(session, domain, namespace, values, fleet))
        due = time.time_ns()
        while not stopping.wait(max(0.0, (due - time.time_ns()) * 1e-9)):
            for robot in robots:
                robot.step(due)
            due = max(due + round(robots[0].period * 1e9), time.time_ns() - 500_000_000)
    except WorldError as error:
        print(error, file=sys.stderr)
        return 1
    finally:
        session.close()
    return 0


def _until_stdin_closes(stopping: threading.Event) -> None:
    while os.read(sys.stdin.fileno(), 1024):
        pass
    stopping.set()


if __name__ == "__main__":
    sys.exit(main())
