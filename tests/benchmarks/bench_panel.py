"""How long a page with a hundred displays takes to load, next to one with five, in one run.

    python tests/benchmarks/bench_panel.py

The page is there when the browser shows rows of the tree and answers. Five and a hundred take
turns in fresh browser sessions; the least of all rounds and the median are shown. Seconds depend on
the machine, on whether it has a GPU, and on the hour; the ratio is what to compare.
"""

from __future__ import annotations

import functools
import statistics
import time
import timeit
from concurrent.futures import Future

import playwright.sync_api as playwright

from webviz.api.declared import make
from webviz.api.registry import display_types
from webviz.api.status import Level, Status
from webviz.edges.page.content.displays import displays
from webviz.edges.page.pages import Pages
from webviz.edges.page.stores import Stores
from webviz.edges.scene import open_server
from webviz.engine.commands import Command, Sender
from webviz.engine.state import Row, State
from webviz.shell.pictures.browser import launched

FEW, MANY = 5, 100
ROUNDS = 7


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


def load(browser: playwright.Browser, url: str, pages: Pages, state: State) -> float:
    """Seconds from the request until the page shows the first rows of the tree."""
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    page = context.new_page()
    began = time.perf_counter()
    page.goto(url)
    while page.get_by_role("treeitem").count() == 0:
        pages.update(state)
        page.wait_for_timeout(10)
    page.evaluate("() => new Promise(requestAnimationFrame)")
    seconds = time.perf_counter() - began
    context.close()
    return seconds


def loads(browser: playwright.Browser) -> None:
    """Print how long pages take."""
    servers = {count: open_server(port=0) for count in (FEW, MANY)}
    pages = {count: Pages(server.channel, ignore) for count, server in servers.items()}
    times: dict[int, list[float]] = {FEW: [], MANY: []}
    for _ in range(ROUNDS):
        for count, server in servers.items():
            url = f"http://127.0.0.1:{server.get_port()}/?fixedDpr=1"
            times[count].append(load(browser, url, pages[count], state_of(count)))
    for server in servers.values():
        server.stop()
    for name, reduce in (("least", min), ("median", statistics.median)):
        few, many = reduce(times[FEW]), reduce(times[MANY])
        ratio = many / few
        print(f"page, {name:<7} {FEW}: {few:.2f} s   {MANY}: {many:.2f} s   ratio {ratio:.2f}")


def ignore(command: Command, sender: Sender) -> Future[str]:
    """Do nothing of what pages ask."""
    return Future()


def updates() -> None:
    """Print what an update that changes nothing costs, in processor time."""
    for count in (FEW, MANY):
        stores, state = Stores(), state_of(count)
        update = functools.partial(
            lambda s, v: s.replace("displays", displays(v, "")), stores, state
        )
        seconds = timeit.repeat(update, timer=time.thread_time, number=200, repeat=ROUNDS)
        print(f"update, {count:>3} displays: {min(seconds) / 200 * 1e6:.0f} us")


def main() -> None:
    """Print both."""
    updates()
    with launched() as browser:
        loads(browser)


if __name__ == "__main__":
    main()
