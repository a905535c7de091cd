"""The robot falls silent: its simulator is stopped for a while, as by a debugger."""

from __future__ import annotations

import contextlib
import signal
import time
from random import Random

import psutil
from processes import command_lines

from tests.attack.attack import Attack, Case, Outcome
from tests.attack.target import Target


class Simulator(Attack):
    """Stops the simulator and lets it go on.

    Args:
        target: the viewer.
    """

    kind = "simulator"

    def __init__(self, target: Target) -> None:
        self._target = target

    def draw(self, random: Random) -> Case:
        return Case("SIGSTOP", str(random.uniform(0.1, 1.5)).encode())

    def strike(self, case: Case) -> Outcome:
        running = command_lines(self._target.process.pid)
        robots = [process for process, line in running.items() if "webviz_sim" in line]
        assert robots, "the simulator runs"
        for robot in robots:
            robot.send_signal(signal.SIGSTOP)
        try:
            time.sleep(float(case.data))
            self._target.wait_until_answered()
        finally:
            for robot in robots:
                with contextlib.suppress(psutil.NoSuchProcess):
                    robot.send_signal(signal.SIGCONT)
        self._target.wait_until_answered()
        return Outcome.SURVIVED
