"""From publication to painted frame, in the same headless Chromium.

    python -m side_by_side.browser [--scenes D E100k] [--systems webviz plain] [--seconds 15]

A script in the page (painted.js) looks at what is drawn before each animation frame: first points,
frames, textures, panes. A publication counts as painted at the start of the frame after the one in
which it was first there: only then has the browser handed on the frame that draws it. Long tasks
are those of the page's thread that take more than 50 ms, once everything is loaded. WebGL in
software is slow; how two viewers compare is what to read. What Rerun's page draws cannot be read by
a script, so that only its frames and long tasks are counted.
"""

from __future__ import annotations

import argparse
import base64
import sys
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from side_by_side import rerun_page, strip
from side_by_side.case import SETTLE_S, Case
from side_by_side.log import Sighting
from side_by_side.marks import Lane, Place
from side_by_side.scenes import SCENES
from side_by_side.systems.registry import SYSTEMS
from webviz.shell.pictures.browser import launched

if TYPE_CHECKING:
    from playwright.sync_api import Page

WIDTH, HEIGHT = 640, 480
PATIENCE_MS = 90_000
SCRIPT = Path(__file__).with_name("painted.js").read_text()
LOOKS = {
    Place.FIRST_POINT: "points",
    Place.FRAME: "frame",
    Place.LINK: "link",
    Place.PICTURE: "picture",
}
MARKED = {
    scene: next(lane for lane in SCENES[scene].lanes if lane.number == number)
    for scene, number in {
        "A": 0,
        "D": 0,
        "TF": 0,
        "B": 1,
        "F": 0,
        "E100k": 0,
        "E1M3": 0,
        "E5M1": 0,
        "held1M3": 0,
        "held5M1": 0,
        "M10k": 0,
        "image-hd": 0,
    }.items()
}
"""Pattern to recognise in each scene."""
NOW = "() => [performance.timeOrigin + performance.now(), window.__frames]"
HEAD = (
    "| scene | system | p50 ms | p99 ms | painted /s | frames /s | long tasks /s | longest ms "
    "| viewer's CPU % |\n| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |"
)


def measure(system: str, scene: str, seconds: float, folder: Path) -> str:
    """A row of the table."""
    lane = MARKED[scene]
    with Case(SYSTEMS[system], SCENES[scene], folder) as case, launched() as browser:
        page = browser.new_page(viewport={"width": WIDTH, "height": HEIGHT})
        page.set_default_timeout(PATIENCE_MS)
        page.add_init_script(SCRIPT)
        if system == "rerun":
            rerun_page.show(page, case.port)
        else:
            _show(page, case.port, lane.place)
        page.wait_for_timeout(1000 * SETTLE_S)
        start_ms, frames = page.evaluate(NOW)
        cpu = case.cpu()
        page.wait_for_timeout(1000 * seconds)
        cpu = case.cpu() - cpu
        end_ms, all_frames = page.evaluate(NOW)
        painted, tasks = page.evaluate("async () => [await window.readPainted(), window.__long]")
        sightings = [each for now, what in painted for each in _sightings(lane, now, what)]
        start_ns, end_ns = int(start_ms * 1e6), int(end_ms * 1e6)
        log = case.log()
        late = log.latencies(sightings, start_ns, end_ns).get(lane.number, [])
        took = (end_ms - start_ms) / 1000
        published = log.published(lane.number, start_ns, end_ns) / took
    times = " | ".join(f"{each:.0f}" for each in np.percentile(late, [50, 99])) if late else " | "
    count = "" if system == "rerun" else f"{len(late) / took:.1f} of "
    long = [took_ms for task_ms, took_ms in tasks if start_ms <= task_ms < end_ms]
    return (
        f"| {scene} | {SYSTEMS[system].title} | {times} | {count}{published:.1f} | "
        f"{(all_frames - frames) / took:.1f} | {len(long) / took:.1f} | "
        f"{max(long, default=0):.0f} | {100 * cpu / took:.1f} |"
    )


def _show(page: Page, port: int, place: Place) -> None:
    """Open the page of a viser server, and wait until publications are painted."""
    page.goto(f"http://127.0.0.1:{port}/?fixedDpr=1")
    page.wait_for_function("window.__viserMutable?.scene")
    page.evaluate("(place) => window.watchPainted(place)", LOOKS[place])
    page.wait_for_function("window.__painted.length > 3")
    pane = page.locator(".wv-pane canvas")
    if pane.count():
        pane.dblclick()  # as large as the plain viewer's, behind its scene


def _sightings(lane: Lane, now_ms: float, what: Any) -> list[Sighting]:
    """The publications of a lane in something that was painted."""
    now_ns = int(now_ms * 1e6)
    if isinstance(what, (int, float)):
        number = lane.decode(what)
        return [] if number is None else [Sighting(now_ns, lane.number, number, lane.cycle)]
    if "stamp" in what:
        return [Sighting(now_ns, None, round(what["stamp"] * 1e6) * 1000)]
    cycle = min(lane.cycle, strip.CYCLE)
    found = strip.read(base64.b64decode(what["picture"]))
    return [Sighting(now_ns, lane.number, n, cycle) for each, n in found if each == lane.number]


def main() -> int:
    """Print a table."""
    parser = argparse.ArgumentParser(prog="side_by_side.browser", description=__doc__)
    parser.add_argument("--scenes", nargs="+", default=list(MARKED), choices=MARKED)
    systems = ["webviz", "plain", "rerun"]
    parser.add_argument("--systems", nargs="+", default=systems, choices=systems)
    parser.add_argument("--seconds", type=float, default=15.0)
    parser.add_argument("--rounds", type=int, default=2)
    options = parser.parse_args()
    print(HEAD)
    for _ in range(options.rounds):
        for scene in options.scenes:
            for system in options.systems:
                with tempfile.TemporaryDirectory() as folder:
                    print(_row(system, scene, options.seconds, Path(folder)), flush=True)
    return 0


def _row(system: str, scene: str, seconds: float, folder: Path) -> str:
    from playwright.sync_api import TimeoutError

    try:
        return measure(system, scene, seconds, folder)
    except TimeoutError:
        return f"| {scene} | {SYSTEMS[system].title} | nothing within {PATIENCE_MS // 1000} s |"


if __name__ == "__main__":
    sys.exit(main())
