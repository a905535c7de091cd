"""Processor time of "Stamp to screen", open and closed by turns, in one run.

    python tests/benchmarks/bench_latency.py

A viewer of the simulated robot and a page in a headless browser, as in the demo, with the page
sending vitals and probes. The clock is that of the thread of the frame loop, and of all threads of
the viewer. Of the rounds the medians are shown; the budget while open is 1 % of a core.
"""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import threading
import time

import playwright.sync_api as playwright

import webviz
from webviz.shell.pictures.browser import launched
from webviz.shell.testing.domain import isolated_domain

ROUNDS, SECONDS, SETTLING_S = 15, 4.0, 1.0
STATES = ("closed", "open")


def clock_of_loop() -> int:
    """Return the processor clock of the thread of the frame loop."""
    (loop,) = [each for each in threading.enumerate() if each.name == "webviz-viewer"]
    assert loop.ident is not None
    return time.pthread_getcpuclockid(loop.ident)


def shares(clock: int) -> tuple[float, float]:
    """Return the shares of a core that the loop and the process take for some seconds."""
    began, loop_s, process_s = time.monotonic(), time.clock_gettime(clock), time.process_time()
    time.sleep(SECONDS)
    passed = time.monotonic() - began
    return (time.clock_gettime(clock) - loop_s) / passed, (time.process_time() - process_s) / passed


def show_doctor(page: playwright.Page) -> playwright.Locator:
    """Open the panel; its folded section."""
    page.locator(".wv-tree").wait_for()
    page.keyboard.press("Control+k")
    page.keyboard.type("Doctor")
    page.keyboard.press("Enter")
    return page.get_by_text("Stamp to screen")


def measure(page: playwright.Page) -> dict[str, list[tuple[float, float]]]:
    """Return the shares of each round by the state of the section."""
    section, clock = show_doctor(page), clock_of_loop()
    found: dict[str, list[tuple[float, float]]] = {state: [] for state in STATES}
    for _ in range(ROUNDS):
        for state in STATES:
            page.wait_for_timeout(1000 * SETTLING_S)
            found[state].append(shares(clock))
            section.click()
    return found


def main() -> None:
    """Print percent of a core, and the difference."""
    with (
        isolated_domain(),
        subprocess.Popen([sys.executable, "-m", "webviz_sim"], env=os.environ) as robot,
        webviz.Viewer(port=0, fixed_frame="map") as viewer,
        launched() as browser,
    ):
        page = browser.new_page(viewport={"width": 1000, "height": 700})
        page.goto(viewer.url)
        found = measure(page)
        robot.terminate()
    for name, place in (("frame loop", 0), ("all threads", 1)):
        shut, is_open = ([each[place] for each in found[state]] for state in STATES)
        cost = statistics.median(b - a for a, b in zip(shut, is_open, strict=True))
        print(
            f"{name:12} closed {statistics.median(shut):6.2%}, "
            f"open {statistics.median(is_open):6.2%}, costs {cost:6.2%} of a core"
        )


if __name__ == "__main__":
    main()
