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
from processes import command_lines
from program import Program
from side_by_side.watchers import ViserWatcher

SETTLING_S, MEASURED_S = 15.0, 20.0


def main() -> int:
    """Measure one fleet after the other."""
    print("robots | viewer | simulator | simulator per robot | client")
    for robots in map(int, sys.argv[1:] or ("1", "5", "20")):
        viewer, simulator, rate = measure(robots)
        print(
            f"{robots:6} | {100 * viewer:4.1f} % | {100 * simulator:7.1f} % | "
            f"{100 * simulator / robots:17.1f} % | {rate / 1e3:.0f} kB/s",
            flush=True,
        )
    return 0


def measure(robots: int) -> tuple[float, float, float]:
    """Processor time of viewer and simulator as shares of a core, and bytes per second sent."""
    domain = str(random.SystemRandom().randrange(160, 220))
    env = {**os.environ, "ROS_DOMAIN_ID": domain, "PYTHONUNBUFFERED": "1"}
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "webviz", "demo", "--robots", str(robots), "--port", "0"]
        program = Program(command, env, Path(folder) / "output.txt")
        try:
            client = ViserWatcher(int(program.url().rpartition(":")[2]), None)
            viewer = psutil.Process(program.process.pid)
            [simulator] = [p for p, line in command_lines(viewer.pid).items() if "sim" in line]
            time.sleep(SETTLING_S)
            before = _used(viewer), _used(simulator), client.bytes, time.monotonic()
            time.sleep(MEASURED_S)
            after = _used(viewer), _used(simulator), client.bytes, time.monotonic()
            client.close()
        finally:
            program.end()
    *used, seconds = (b - a for a, b in zip(before, after, strict=True))
    return used[0] / seconds, used[1] / seconds, used[2] / seconds


def _used(process: psutil.Process) -> float:
    """The processor time of a process so far, in seconds."""
    times = process.cpu_times()
    return times.user + times.system


if __name__ == "__main__":
    sys.exit(main())
