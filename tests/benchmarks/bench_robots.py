"""The processor time of `webviz demo --robots N`, per robot: `bench_robots.py 1 5 20`.

The viewer sends to one client, which draws no page. The simulator steps 50 times a second; on a
machine with too much else to do it skips steps, so the rate of its odometry is shown as well.
"""

from __future__ import annotations

import os
import random
import sys
import tempfile
import time
from pathlib import Path

import psutil
from nav_msgs.msg import Odometry
from processes import command_lines
from program import Program
from rclpy.context import Context
from rclpy.executors import SingleThreadedExecutor
from rclpy.node import Node
from side_by_side.watchers import ViserWatcher

SETTLING_S, MEASURED_S = 15.0, 20.0


def main() -> int:
    """Measure one fleet after the other."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")  # as the demo does
    print("robots | viewer | simulator | each | odometry | to the client")
    for robots in map(int, sys.argv[1:] or ("1", "5", "20")):
        viewer, simulator, rate, sent = measure(robots)
        print(
            f"{robots:6} | {100 * viewer:4.1f} % | {100 * simulator:7.1f} % | "
            f"{100 * simulator / robots:.1f} % | {rate:5.1f} Hz | {sent / 1e3:.0f} kB/s",
            flush=True,
        )
    return 0


def measure(robots: int) -> tuple[float, float, float, float]:
    """Processor time of viewer and simulator as shares of a core, odometry in Hz, and bytes/s."""
    domain = random.SystemRandom().randrange(160, 220)
    env = {**os.environ, "ROS_DOMAIN_ID": str(domain), "PYTHONUNBUFFERED": "1"}
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "webviz", "demo", "--robots", str(robots), "--port", "0"]
        command.append("--no-autosave")
        program = Program(command, env, Path(folder) / "output.txt")
        context = Context()
        context.init(domain_id=domain)
        executor = SingleThreadedExecutor(context=context)
        try:
            client = ViserWatcher(int(program.url().rpartition(":")[2]), None)
            viewer = psutil.Process(program.process.pid)
            [simulator] = [p for p, line in command_lines(viewer.pid).items() if "sim" in line]
            node, heard = Node("counter", context=context), list[bytes]()
            topic = "/odom" if robots == 1 else "/robot1/odom"
            node.create_subscription(Odometry, topic, heard.append, 10, raw=True)
            executor.add_node(node)
            _spin(executor, SETTLING_S)

            def counts() -> tuple[float, float, float, float]:
                return _used(viewer), _used(simulator), len(heard), client.bytes

            before, began = counts(), time.monotonic()
            _spin(executor, MEASURED_S)
            after, seconds = counts(), time.monotonic() - began
            client.close()
        finally:
            program.end()
            executor.shutdown()
            context.try_shutdown()
    used, simulated, odometry, sent = (b - a for a, b in zip(before, after, strict=True))
    return used / seconds, simulated / seconds, odometry / seconds, sent / seconds


def _spin(executor: SingleThreadedExecutor, seconds: float) -> None:
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        executor.spin_once(timeout_sec=0.1)


def _used(process: psutil.Process) -> float:
    """The processor time of a process so far, in seconds."""
    times = process.cpu_times()
    return times.user + times.system


if __name__ == "__main__":
    sys.exit(main())
