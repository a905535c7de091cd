"""From publication to painted frame, in the same headless Chromium.

    python -m side_by_side.browser [--scenes D E100k] [--systems webviz plain] [--seconds 15]

A script in the page looks at every drawn cloud before each animation frame. A publication counts as
painted at the start of the frame after the one in which its points were first there: only then has
the browser handed on the frame that draws them. Long tasks are those
of the page's thread that take more than 50 ms, once everything is loaded. WebGL in software is
slow; how two viewers compare is what to read. foxglove-sdk and rerun-sdk bring no page of their
own, so they are left out.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

from side_by_side.case import SETTLE_S, Case
from side_by_side.log import Sighting
from side_by_side.marks import CYCLE
from side_by_side.scenes import SCENES
from side_by_side.systems.registry import SYSTEMS
from webviz.shell.pictures.browser import launched

WIDTH, HEIGHT = 640, 480
MARKED = ["A", "D", "E100k", "E1M3"]
"""Scenes whose first lane is one of points."""
LONG_TASKS = """
window.__long = [];
new PerformanceObserver((list) => window.__long.push(
  ...list.getEntries().map((task) => [performance.timeOrigin + task.startTime, task.duration]),
)).observe({ type: "longtask", buffered: true });
"""
WATCH = """() => {
  const known = new Map();
  let fresh = [];
  window.__painted = [];
  window.__frames = 0;
  const step = () => {
    const now = performance.timeOrigin + performance.now();
    window.__painted.push(...fresh.map((x) => [now, x]));
    fresh = [];
    window.__frames += 1;
    window.__viserMutable.scene.traverse((node) => {
      const x = node.isPoints && node.geometry.attributes.position?.array[0];
      if (typeof x === "number" && known.get(node.uuid) !== x) {
        known.set(node.uuid, x);
        fresh.push(x);
      }
    });
    requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}"""
NOW = "() => [performance.timeOrigin + performance.now(), window.__frames]"


def measure(system: str, scene: str, seconds: float, folder: Path) -> str:
    """A row of the table."""
    lane = SCENES[scene].lanes[0]
    with Case(SYSTEMS[system], SCENES[scene], folder) as case, launched() as browser:
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        page.add_init_script(LONG_TASKS)
        page.goto(f"http://127.0.0.1:{case.port}/?fixedDpr=1")
        page.wait_for_function("window.__viserMutable?.scene", timeout=60_000)
        page.evaluate(WATCH)
        page.wait_for_function("window.__painted.length > 3", timeout=60_000)
        page.wait_for_timeout(1000 * SETTLE_S)
        start_ms, frames = page.evaluate(NOW)
        cpu = case.cpu()
        page.wait_for_timeout(1000 * seconds)
        cpu = case.cpu() - cpu
        end_ms, all_frames = page.evaluate(NOW)
        painted, tasks = page.evaluate("() => [window.__painted, window.__long]")
        sightings = [
            Sighting(int(now * 1e6), lane.number, number, CYCLE)
            for now, x in painted
            if (number := lane.decode(x)) is not None
        ]
        start_ns, end_ns = int(start_ms * 1e6), int(end_ms * 1e6)
        log = case.log()
        late = log.latencies(sightings, start_ns, end_ns).get(lane.number, [])
        took = (end_ms - start_ms) / 1000
        published = log.published(lane.number, start_ns, end_ns) / took
    p50, p99 = np.percentile(late, [50, 99]) if late else (np.nan, np.nan)
    long = [took_ms for task_ms, took_ms in tasks if start_ms <= task_ms < end_ms]
    return (
        f"| {scene} | {SYSTEMS[system].title} | {p50:.0f} | {p99:.0f} | {len(late) / took:.1f} of "
        f"{published:.1f} | {(all_frames - frames) / took:.1f} | {len(long) / took:.1f} | "
        f"{max(long, default=0):.0f} | {100 * cpu / took:.1f} |"
    )


def main() -> int:
    """Print a table."""
    parser = argparse.ArgumentParser(prog="side_by_side.browser", description=__doc__)
    parser.add_argument("--scenes", nargs="+", default=MARKED, choices=MARKED)
    parser.add_argument(
        "--systems", nargs="+", default=["webviz", "plain"], choices=["webviz", "plain"]
    )
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--rounds", type=int, default=2)
    options = parser.parse_args()
    print(
        "| scene | system | p50 ms | p99 ms | painted /s | frames /s | long tasks /s | longest ms "
        "| viewer's CPU % |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
    )
    for _ in range(options.rounds):
        for scene in options.scenes:
            for system in options.systems:
                with tempfile.TemporaryDirectory() as folder:
                    print(measure(system, scene, options.seconds, Path(folder)), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
