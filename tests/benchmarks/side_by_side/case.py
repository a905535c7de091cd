"""Runs one system on one scene, with one load after another."""

from __future__ import annotations

import contextlib
import os
import re
import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import psutil
from program import Program

from side_by_side.log import Log
from side_by_side.scenes import Scene
from side_by_side.small_computer import SmallComputer
from side_by_side.systems.registry import System
from side_by_side.watchers import Watcher
from webviz.shell.testing.domain import isolated_domain

SETTLE_S = 1.5
"""Time in seconds from the last change of the load to the first second that counts."""
GIVE_UP_S = 40.0
SAMPLES_PER_S = 2.0
QUIET = 0.2
"""Cores that other programs of a quiet machine use."""


class CaseFailed(Exception):
    """A system did not do its part; the text says what."""


@dataclass(frozen=True)
class Load:
    """Clients that watch.

    Args:
        clients: that read.
        stalled: that do not.
    """

    clients: int
    stalled: int = 0

    def __str__(self) -> str:
        return f"{self.clients}+stalled" if self.stalled else str(self.clients)


@dataclass
class Result:
    """Figures of one load. Times in ms, memory in MB, rates per second."""

    seconds: float
    cpu: float
    """Cores: CPU seconds per second of the process and its children."""
    rss: float
    rss_slope: float
    """MB per minute."""
    join_s: float | None = None
    """Time in seconds from the connection of the first client to the first publication it sees."""
    bytes: float = 0.0
    """Bytes to one client, per second."""
    published: dict[int, float] = field(default_factory=dict)
    drawn_per_s: dict[int, float] = field(default_factory=dict)
    latency: list[float] = field(default_factory=list)
    """Latency of every publication of the scene's first lane that was shown."""
    others: float = 0.0
    """Cores that other programs of the machine used meanwhile."""


@dataclass
class CaseResult:
    """Figures of one system on one scene."""

    start_s: float | None
    """Time in seconds from the start of the process to the first publication at a client."""
    start_cpu: float
    """CPU seconds of that."""
    loads: dict[str, Result]


class Case:
    """A publisher and a system that run, on a ROS domain of their own."""

    def __init__(
        self, system: System, scene: Scene, folder: Path, computer: SmallComputer | None = None
    ) -> None:
        self.system = system
        self.scene = scene
        self.folder = folder
        self._computer = computer
        self._log = folder / "publications.bin"
        self._log.touch()
        self._stack = contextlib.ExitStack()

    def __enter__(self) -> Case:
        self._stack.enter_context(isolated_domain())
        self.env = environment()
        python = [sys.executable, "-m", "side_by_side.publisher"]
        try:
            self._publisher = self._start([*python, self.scene.name, str(self._log)], "publisher")
            _line(self._publisher, "publishing")
            self.started = time.monotonic()
            self.program = self._start(self.system.command(self.scene, self.folder), "system")
            if self._computer is not None:
                self._computer.take(self.program.process.pid)
            self.port = int(_line(self.program, r"127\.0\.0\.1:(\d+)|listening").group(1) or 0)
            self.process = psutil.Process(self.program.process.pid)
        except BaseException:
            self._stack.close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def watch(self, recognise: bool = True, stalls: bool = False) -> Watcher:
        """A new client."""
        scene = self.scene if recognise else None
        return self.system.watch(self.port, self.folder, scene, stalls)

    def wait_until_steady(self) -> None:
        """Wait until the messages that are published in advance are out."""
        _line(self._publisher, "steady")

    def log(self) -> Log:
        """Return the log of publications so far."""
        return Log(self._log)

    def cpu(self) -> float:
        """CPU seconds of the system so far."""
        return sum(map(_cpu, (self.process, *self.process.children(recursive=True))))

    def rss(self) -> float:
        """Resident memory of the system in MB."""
        return self.process.memory_info().rss / 1e6

    def first_sight(self, seconds: float = GIVE_UP_S) -> tuple[float, float]:
        """Seconds and CPU seconds from the start of the system to the first publication."""
        watcher = self.watch()
        try:
            wait_for(lambda: watcher.sightings, "no publication was seen", seconds)
            return time.monotonic() - self.started, self.cpu()
        finally:
            watcher.close()

    def measure(self, load: Load, seconds: float, patience: float = 0.0) -> Result:
        """Figures with so many clients, after up to `patience` seconds for a quiet machine."""
        with contextlib.ExitStack() as stack:
            start = time.monotonic()
            watchers = [self.watch() for _ in range(min(1, load.clients))]
            for watcher in watchers:
                stack.callback(watcher.close)
            if watchers:
                wait_for(lambda: watchers[0].sightings, "a client that joined saw none", GIVE_UP_S)
            join_s = time.monotonic() - start if watchers else None
            for _ in range(load.stalled):
                stack.callback(self.watch(recognise=False, stalls=True).close)
            for _ in range(1, load.clients):
                stack.callback(self.watch(recognise=False).close)
            time.sleep(SETTLE_S)
            self._wait_until_quiet(patience)
            return replace(self._figures(watchers, seconds), join_s=join_s)

    def _figures(self, watchers: Sequence[Watcher], seconds: float) -> Result:
        start, start_ns, cpu = time.monotonic(), time.time_ns(), self.cpu()
        everybody, ours = _machine_cpu(), self._all_cpu()
        sizes = [watcher.bytes for watcher in watchers]
        memory = []
        while (now := time.monotonic() - start) < seconds:
            memory.append((now, self.rss()))
            time.sleep(min(1 / SAMPLES_PER_S, seconds - now))
        spent, end_ns, took = self.cpu() - cpu, time.time_ns(), time.monotonic() - start
        if self.program.process.poll() is not None:
            raise CaseFailed(f"it ended: {self.program.output()[-300:]}")
        if not all(watcher.is_connected for watcher in watchers):
            raise CaseFailed("a client was disconnected")
        times, sizes_mb = np.array(memory).T
        slope = float(np.polyfit(times, sizes_mb, 1)[0]) if len(times) > 2 else 0.0
        result = Result(took, spent / took, float(np.median(sizes_mb)), 60 * slope)
        everybody, ours = _machine_cpu() - everybody, self._all_cpu() - ours
        result.others = max(0.0, (everybody - ours) / took)
        time.sleep(0.3)  # for what is on its way
        log = self.log()
        for lane in self.scene.lanes:
            result.published[lane.number] = (
                log.published(lane.number, start_ns, end_ns) / result.seconds
            )
        if watchers:
            result.bytes = (watchers[0].bytes - sizes[0]) / (took + 0.3)
            late = log.latencies(watchers[0].sightings, start_ns, end_ns)
            result.drawn_per_s = {lane: len(each) / result.seconds for lane, each in late.items()}
            result.latency = late.get(self.scene.lane, [])
        return result

    def _wait_until_quiet(self, patience: float) -> None:
        deadline = time.monotonic() + patience
        while time.monotonic() < deadline:
            start, everybody, ours = time.monotonic(), _machine_cpu(), self._all_cpu()
            time.sleep(1.0)
            others = (_machine_cpu() - everybody) - (self._all_cpu() - ours)
            if others / (time.monotonic() - start) < QUIET:
                return

    def _all_cpu(self) -> float:
        """CPU seconds of the system, the publisher and this process."""
        mine = (os.getpid(), self._publisher.process.pid)
        return self.cpu() + sum(_cpu(psutil.Process(pid)) for pid in mine)

    def _start(self, command: Sequence[str], name: str) -> Program:
        program = Program(command, self.env, self.folder / f"{name}.txt")
        self._stack.callback(_end, program)
        return program


def run(
    system: System,
    scene: Scene,
    loads: Sequence[Load],
    seconds: float,
    folder: Path,
    patience: float = 0.0,
    computer: SmallComputer | None = None,
) -> CaseResult:
    """Start everything, the system on a `computer` of its own, measure each load, end all."""
    with Case(system, scene, folder, computer) as case:
        if any(load.clients for load in loads):
            start_s, start_cpu = case.first_sight()
        else:
            start_s, start_cpu = None, 0.0
            time.sleep(2 * SETTLE_S)
        case.wait_until_steady()
        results = {str(load): case.measure(load, seconds, patience) for load in loads}
    return CaseResult(start_s, start_cpu, results)


def wait_for(condition: Callable[[], object], otherwise: str, seconds: float) -> None:
    """Wait until it holds.

    Raises:
        CaseFailed: it does not within `seconds`.
    """
    deadline = time.monotonic() + seconds
    while not condition():
        if time.monotonic() > deadline:
            raise CaseFailed(f"{otherwise} within {seconds:g} s")
        time.sleep(0.005)


def environment() -> dict[str, str]:
    """Return the environment of a case's processes, on the ROS domain of this one."""
    here = Path(__file__).parents[1]
    path = [str(here), str(here.parent / "support"), os.environ.get("PYTHONPATH", "")]
    inherited = dict(os.environ)
    # An installed program does not compile its modules at each start.
    inherited.pop("PYTHONDONTWRITEBYTECODE", None)
    return {
        **inherited,
        "PYTHONPATH": os.pathsep.join(filter(None, path)),
        "PYTHONUNBUFFERED": "1",
    }


def _cpu(process: psutil.Process) -> float:
    """CPU seconds of all threads of a process so far, by the scheduler's clock.

    `cpu_times` counts ticks of 10 ms, that is 0.3 % of a core in 3 s: as much as idle viewers take.
    """
    scheduled = 2  # CPUCLOCK_SCHED; see clock_getcpuclockid(3)
    return time.clock_gettime(~process.pid << 3 | scheduled)


def _machine_cpu() -> float:
    """CPU seconds that the machine's programs used so far."""
    times = psutil.cpu_times()
    return times.user + times.nice + times.system


def _line(program: Program, pattern: str) -> re.Match[str]:
    try:
        return program.wait_for(pattern, GIVE_UP_S)
    except AssertionError as error:
        raise CaseFailed(str(error)[-400:]) from error


def _end(program: Program) -> None:
    with contextlib.suppress(Exception):  # it is killed if it does not end
        program.end()
