"""How long a page with a hundred displays takes to load, next to one with five, in one run.

    python tests/benchmarks/bench_panel.py

The page is there when the browser shows every row of the list and answers. Five and a hundred take
turns in fresh browser sessions; the least of all rounds and the median are shown. Seconds depend on
the machine, on whether it has a GPU, and on the hour; the ratio is what to compare.
"""

from __future__ import annotations

import statistics
import time
import timeit
from collections.abc import Callable

import playwright.sync_api as playwright

from webviz.api.declared import make
from webviz.api.registry import display_types
from webviz.api.status import Level, Status
from webviz.edges.gui import Panels
from webviz.edges.scene import open_server
from webviz.engine.state import Row, State
from webviz.shell.pictures.browser import launched

FEW, MANY = 5, 100
ROUNDS = 7
ROWS = "() => document.querySelectorAll(':has(> div > .webviz-list) input').length"


def state_of(count: int) -> State:
    """A viewer with so many displays of several types."""
    types = sorted(display_types().items())
    rows = []
    for i in range(count):
        name, cls = types[i % len(types)]
        display = make(cls, {"name": f"{name} {i}"})
        statuses = {"Topic": Status(Level.OK, "10.0 Hz"), "Transform": Status(Level.OK, "OK")}
        rows.append(Row(f"display{i}", name, display, display.name, statuses))
    return State(rows=tuple(rows), frames=("map", "odom"))


def load(browser: playwright.Browser, url: str, rows: int) -> float:
    """Seconds from the request until the page shows so many rows."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    began = time.perf_counter()
    page.goto(url)
    page.wait_for_function(f"({ROWS})() === {rows}", timeout=120_000)
    page.evaluate("() => new Promise(requestAnimationFrame)")
    seconds = time.perf_counter() - began
    context.close()
    return seconds


def loads(browser: playwright.Browser) -> None:
    """Print how long pages take."""
    servers = {count: open_server(port=0) for count in (FEW, MANY)}
    for count, server in servers.items():
        Panels(server, lambda command, sender: None).update(state_of(count))
    times: dict[int, list[float]] = {FEW: [], MANY: []}
    for _ in range(ROUNDS):
        for count, server in servers.items():
            url = f"http://127.0.0.1:{server.get_port()}/?fixedDpr=1"
            times[count].append(load(browser, url, count))
    for server in servers.values():
        server.stop()
    for name, reduce in (("least", min), ("median", statistics.median)):
        few, many = reduce(times[FEW]), reduce(times[MANY])
        ratio = many / few
        print(f"page, {name:<7} {FEW}: {few:.2f} s   {MANY}: {many:.2f} s   ratio {ratio:.2f}")


def updates() -> None:
    """Print what an update that changes nothing costs, in processor time."""
    server = open_server(port=0)
    for count in (FEW, MANY):
        panel, state = Panels(server, lambda command, sender: None), state_of(count)
        update = updater(panel, state)
        seconds = timeit.repeat(update, timer=time.thread_time, number=200, repeat=ROUNDS)
        print(f"update, {count:>3} displays: {min(seconds) / 200 * 1e6:.0f} us")
    server.stop()


def updater(panel: Panels, state: State) -> Callable[[], None]:
    """An update that changes nothing."""
    panel.update(state)
    return lambda: panel.update(state)


def main() -> None:
    """Print both."""
    updates()
    with launched() as browser:
        loads(browser)


if __name__ == "__main__":
    main()
