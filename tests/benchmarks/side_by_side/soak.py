"""Growth over time: displays, frames, markers and browsers that come and go for minutes.

    make soak ARGS="--minutes 10"

Against a running viewer of the demo with more frames and markers, all at once: a client that adds
displays and undoes it, changes the fixed frame and pauses; clients that join, look at panels and
leave, or just vanish; one that never reads; and a page in a headless browser that stays. It ends
with 1 if something grows.
"""

from __future__ import annotations

import argparse
import contextlib
import itertools
import logging
import sys
import tempfile
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import playwright.sync_api as playwright
import psutil
from numpy.typing import NDArray

from side_by_side.case import Case
from side_by_side.memory import slope
from side_by_side.scenes import SCENES
from side_by_side.systems.registry import SYSTEMS
from side_by_side.watchers import ViserWatcher
from tests.attack.visitor import Visitor
from webviz.shell.pictures.browser import launched

EVERY_S = 2.0
WARM_UP = 0.3
"""Share of the time that does not count: buffers of every size have been needed once by then."""
PARTS = 10
ANSWER_S = 60.0
VISIT_S = 2.0
ADDED = ("Grid", "LaserScan", "Path", "TF", "Axes", "Map", "Odometry", "MarkerArray")
STORES = ("displays", "topics", "frames", "history", "traffic")
OBJECTS = """() => {
  let count = 0;
  window.__viserMutable.scene.traverse(() => { count += 1; });
  return count;
}"""
MAX_GROWTH = {
    "RSS MB": 1.0,
    "descriptors": 0.5,
    "threads": 0.3,
    "nodes": 2.0,
    "p50 ms": 2.0,
    "page's objects": 5.0,
    "page's heap MB": 2.0,
}
"""Growth per minute that passes as flat."""


def steer(port: int, ended: threading.Event, failures: list[str]) -> None:
    """Add displays and undo it, change the fixed frame and pause, until it is ended."""
    with contextlib.closing(Visitor(port)) as owner:

        def do(command: str, **arguments: object) -> None:
            level, text = owner.do(command, ANSWER_S, **arguments)
            if level == "error":
                failures.append(f"{command}: {text}")
            ended.wait(0.3)

        for name in itertools.cycle(ADDED):
            if ended.is_set():
                return
            do("AddDisplay", type=name)
            do("SetFixedFrame", frame="base_link")
            do("SetFixedFrame", frame="map")
            do("Pause", paused=True)
            do("Pause", paused=False)
            for _ in range(3):
                do("Undo")


def come_and_go(port: int, ended: threading.Event, failures: list[str]) -> None:
    """Joins, looks at panels and leaves, or just vanishes, until it is ended."""
    for number in itertools.count():
        if ended.is_set():
            return
        try:
            visitor = Visitor(port)
            for store in STORES:
                visitor.send("Watch", store=store)
            ended.wait(VISIT_S)
            if number % 2:
                visitor.viser.close()
            else:
                visitor.close()
        except Exception as error:
            failures.append(f"a visitor: {error}")


def sample(process: psutil.Process, reader: ViserWatcher, page: playwright.Page) -> list[float]:
    """The figures of one moment, but for the latency."""
    inspector = page.context.new_cdp_session(page)
    inspector.send("HeapProfiler.collectGarbage")
    heap = inspector.send("Runtime.getHeapUsage")["usedSize"] / 1e6
    inspector.detach()
    return [
        process.memory_info().rss / 1e6,
        process.num_fds(),
        process.num_threads(),
        len(reader.nodes),
        page.evaluate(OBJECTS),
        heap,
    ]


def run(minutes: float, folder: Path) -> tuple[NDArray[np.float64], NDArray[np.float64], list[str]]:
    """Times in s (N,), figures in the order of MAX_GROWTH (N, 7), and what went wrong."""
    failures: list[str] = []
    ended = threading.Event()
    times, rows, counts = [], [], []
    with contextlib.ExitStack() as stack:
        case = stack.enter_context(Case(SYSTEMS["webviz"], SCENES["soak"], folder))
        page = stack.enter_context(launched()).new_page(viewport={"width": 320, "height": 240})
        page.goto(f"http://127.0.0.1:{case.port}/?fixedDpr=1")
        page.wait_for_function("window.__viserMutable?.scene", timeout=60_000)
        reader = case.watch()
        assert isinstance(reader, ViserWatcher)
        stack.callback(reader.close)
        stack.callback(case.watch(recognise=False, stalls=True).close)
        crowd = [
            threading.Thread(target=target, args=(case.port, ended, failures))
            for target in (steer, come_and_go, come_and_go)
        ]
        for thread in crowd:
            thread.start()
            stack.callback(thread.join)
        stack.callback(ended.set)
        start = time.monotonic()
        while (now := time.monotonic() - start) < 60 * minutes:
            times.append(now)
            rows.append(sample(case.process, reader, page))
            counts.append((time.time_ns(), len(reader.sightings)))
            page.wait_for_timeout(1000 * EVERY_S)
            if not reader.is_connected or case.program.process.poll() is not None:
                failures.append(f"the viewer ended: {case.program.output()[-300:]}")
                break
        latencies = list(_latencies(case, reader, counts))
    figures = np.array(rows)
    return np.array(times), np.insert(figures, 4, latencies, axis=1), failures


def _latencies(case: Case, reader: ViserWatcher, counts: list[tuple[int, int]]) -> Iterator[float]:
    """The median latency in ms between each sample and the next, that of the last twice."""
    log, lane, median = case.log(), case.scene.lane, np.nan
    for (since, first), (until, last) in itertools.pairwise(counts):
        late = log.latencies(reader.sightings[first:last], since, until).get(lane)
        median = float(np.median(late)) if late else median
        yield median
    yield median


def main() -> int:
    """Print all figures over time, and which of them grow."""
    parser = argparse.ArgumentParser(prog="side_by_side.soak", description=__doc__)
    parser.add_argument("--minutes", type=float, default=10.0, help="(default: 10)")
    # Of visitors whose connections the viewer ends while they leave.
    logging.getLogger("websockets.client").setLevel(logging.CRITICAL)
    minutes = parser.parse_args().minutes
    with tempfile.TemporaryDirectory() as folder:
        times, figures, failures = run(minutes, Path(folder))
    print("| minutes | " + " | ".join(MAX_GROWTH) + " |")
    print("| ---: |" + " ---: |" * len(MAX_GROWTH))
    for part in np.array_split(np.arange(len(times)), PARTS):
        cells = (f"{value:.1f}" for value in np.median(figures[part], axis=0))
        print(f"| {times[part[-1]] / 60:.1f} | " + " | ".join(cells) + " |")
    counts = times > WARM_UP * times[-1]
    slopes = [slope(times[counts], column[counts]) for column in figures.T]
    print("| a minute | " + " | ".join(f"{each:+.2f}" for each in slopes) + " |\n")
    growing = [
        name for name, each in zip(MAX_GROWTH, slopes, strict=True) if each > MAX_GROWTH[name]
    ]
    for failure in dict.fromkeys(failures):
        print(f"failed: {failure}")
    print(f"grows: {', '.join(growing)}" if growing else "flat")
    return 1 if growing or failures else 0


if __name__ == "__main__":
    sys.exit(main())
