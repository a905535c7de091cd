"""Cost of the page with five and with a hundred displays, in one run.

    python tests/benchmarks/bench_page.py

Updates: processor time of the viewer for all stores, which it spends five times a second, and of
what sends them to one page or ten, without the network; nothing new, and one display with a new
status. Page: seconds from the request until the tree of displays is filled, in fresh browser
sessions that take turns; the least of all rounds and the median. Then changes of the page's
elements in ten seconds in which nothing new is shown.

Times depend on the machine, on whether it has a GPU, and on the hour; compare them within a run.
"""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import logging
import statistics
import threading
import time
import timeit
from collections.abc import Iterator
from concurrent.futures import Future

import msgspec
import playwright.sync_api as playwright
from msgspec.structs import replace

from webviz.api.declared import make
from webviz.api.registry import display_types
from webviz.api.status import Level, Status
from webviz.api.vehicle import Velocity
from webviz.engine.commands import Command, Sender
from webviz.engine.driving import DrivingAnswer
from webviz.engine.state import Row, State, Traffic
from webviz.page.pages import Pages
from webviz.scene import open_server
from webviz.scene.server import Server
from webviz.server.access.access import EVERYBODY
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Hello, Watch
from webviz.server.sending.congestion import CongestionControl, InFlightWindow
from webviz.shell.pictures.browser import launched
from webviz.sources import Offer, Publisher

FEW, MANY = 5, 100
ROUNDS = 7
FEW_PAGES, MANY_PAGES = 1, 10
UPDATES = 100
UPDATE_S = 0.2
SETTLE_S = 3.0
"""For what a page shows only once it is loaded."""
STILL_S = 10.0
STORES = {
    *("clock", "displays", "file", "frames", "graph", "history", "legend", "settings"),
    *(
        "topics",
        "traffic",
        "types",
        "views",
        "watchers",
        "properties:display0",
        "statuses:display0",
    ),
}
FILLED = """(count) => {
  const tree = document.querySelector("[role=tree]");
  const items = [...document.querySelectorAll("[role=tree] [role=treeitem]")];
  if (!tree || !items.length) return false;
  const bottom = Math.max(...items.map((item) => item.getBoundingClientRect().bottom));
  const end = Math.min(innerHeight, tree.parentElement.getBoundingClientRect().bottom);
  return items.length >= count || bottom >= end;
}"""
WATCH = """() => {
  window.changes = {};
  const options = { subtree: true, childList: true, attributes: true, characterData: true };
  new MutationObserver((found) => {
    for (const { target } of found) {
      const element = target.closest ? target : target.parentElement;
      const name = element.className || element.tagName;
      window.changes[name] = (window.changes[name] ?? 0) + 1;
    }
  }).observe(document.querySelector("#webviz"), options);
}"""


class Reader:
    """A page that watches all stores and reads whatever it is sent.

    Args:
        key: of the page.
    """

    def __init__(self, key: str) -> None:
        self.logger = logging.getLogger(__name__)
        self.transport = self
        self.latency = 0.0
        self.window = InFlightWindow(CongestionControl())
        self.is_expelled = False
        self.grant = EVERYBODY
        self.address = ""
        said = (Hello(key), *(Watch(store) for store in sorted(STORES)))
        self._said = [msgspec.json.encode(message).decode() for message in said]

    async def recv(self) -> str:
        """Return the page's message once, then wait for ever."""
        return self._said.pop(0) if self._said else await asyncio.Future()

    async def send(self, message: str | bytes, /) -> None:
        """Take it."""

    async def send_in_time(self, message: bytes, /) -> None:
        """Take it."""

    async def close(self, code: int = 1000, reason: str = "") -> None:
        """Do nothing."""

    def abort(self) -> None:
        """Do nothing."""


@contextlib.contextmanager
def watched(count: int) -> Iterator[Channel]:
    """A channel to so many pages."""
    channel, ended = Channel(), asyncio.Event()

    async def serve() -> None:
        keys = [channel.join(number, CongestionControl()) for number in range(count)]
        pages = [
            asyncio.create_task(channel.serve(Reader(key), contextlib.nullcontext)) for key in keys
        ]
        await ended.wait()
        for page in pages:
            page.cancel()
        await asyncio.gather(*pages, return_exceptions=True)

    loop = asyncio.new_event_loop()
    thread = threading.Thread(target=lambda: loop.run_until_complete(serve()))
    thread.start()
    while channel.watched() != STORES:
        time.sleep(UPDATE_S / 10)
    yield channel
    loop.call_soon_threadsafe(ended.set)
    thread.join()
    loop.close()


def state_of(count: int) -> State:
    """A viewer with so many displays of several types, and a topic for each."""
    types = sorted(display_types().items())
    rows, offers, traffic = [], {}, {}
    for i in range(count):
        name, cls = types[i % len(types)]
        display = make(cls, {"name": f"{name} {i}"})
        statuses = {"Topic": Status(Level.OK, "10.0 Hz"), "Transform": Status(Level.OK, "OK")}
        rows.append(Row(f"display{i}", name, display, display.name, statuses))
        publisher = Publisher("/driver", "sensor_msgs/msg/LaserScan", "reliable", "volatile")
        offers[f"/topic{i}"] = Offer((publisher,))
        traffic[f"/topic{i}"] = Traffic(10.0, 1000.0)
    topics = dict.fromkeys(offers, ("sensor_msgs/msg/LaserScan",))
    return State(
        rows=tuple(rows), frames=("map", "odom"), topics=topics, offers=offers, traffic=traffic
    )


def with_status(state: State, text: str) -> State:
    """The state with another status of its last display."""
    *rows, last = state.rows
    last = replace(last, statuses={**last.statuses, "Topic": Status(Level.WARN, text)})
    return replace(state, rows=(*rows, last))


def updates() -> None:
    """Print what an update costs, in processor time."""
    for count, pages in itertools.product((FEW, MANY), (FEW_PAGES, MANY_PAGES)):
        state = state_of(count)
        same = cost(pages, state)
        news = cost(pages, *(with_status(state, word) for word in ("late", "lost")))
        print(
            f"update, {count:>3} displays, pages {pages:>2}: {same:.0f} us"
            f"   with a new status: {news:.0f} us"
        )


def cost(readers: int, *states: State) -> float:
    """Microseconds per update with these states in turn: the least of all rounds."""
    with watched(readers) as channel:
        pages, turns = Pages(channel, ignored, unsteered), itertools.cycle(states)
        for _ in states:
            pages.update(next(turns))
        timer = timeit.Timer(lambda: pages.update(next(turns)), timer=time.process_time)
        seconds = timer.repeat(ROUNDS, UPDATES)
    return min(seconds) / UPDATES * 1e6


def ignored(command: Command, sender: Sender) -> Future[str]:
    """Leave a command undone."""
    return Future()


def unsteered(tool: str, browser: int, share: Velocity, seen: float | None) -> DrivingAnswer:
    """Leave a vehicle alone."""
    return DrivingAnswer()


class Viewer:
    """A server with a state that is shown to every page."""

    def __init__(self, count: int) -> None:
        self.count = count
        self.server: Server = open_server(port=0)
        self._pages = Pages(self.server.channel, ignored, unsteered)
        self._state = state_of(count)

    def update(self) -> None:
        """Update as the frame loop does five times a second."""
        self._pages.update(self._state)

    def play(self, page: playwright.Page, seconds: float) -> None:
        """Update an open page for some time."""
        for _ in range(round(seconds / UPDATE_S)):
            self.update()
            page.wait_for_timeout(1000 * UPDATE_S)

    def load(self, browser: playwright.Browser) -> tuple[playwright.Page, float]:
        """A page whose tree is filled, and how many seconds it took."""
        page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
        began = time.perf_counter()
        page.goto(f"http://127.0.0.1:{self.server.get_port()}/?fixedDpr=1")
        while not page.evaluate(FILLED, self.count):
            if time.perf_counter() - began > 120:
                raise TimeoutError("The tree of displays was not filled within two minutes.")
            self.update()
            page.wait_for_timeout(10)
        page.evaluate("() => new Promise(requestAnimationFrame)")
        return page, time.perf_counter() - began


def loads(browser: playwright.Browser, viewers: list[Viewer]) -> None:
    """Print how long pages take."""
    times: dict[int, list[float]] = {viewer.count: [] for viewer in viewers}
    for _ in range(ROUNDS):
        for viewer in viewers:
            page, seconds = viewer.load(browser)
            page.context.close()
            times[viewer.count].append(seconds)
    for name, reduce in (("least", min), ("median", statistics.median)):
        few, many = reduce(times[FEW]), reduce(times[MANY])
        ratio = many / few
        print(f"page, {name:<7} {FEW}: {few:.2f} s   {MANY}: {many:.2f} s   ratio {ratio:.2f}")


def stillness(browser: playwright.Browser, viewer: Viewer) -> None:
    """Print how often a page changes while nothing new is shown."""
    page, _ = viewer.load(browser)
    viewer.play(page, SETTLE_S)
    page.evaluate(WATCH)
    viewer.play(page, STILL_S)
    changes = page.evaluate("() => window.changes")
    page.context.close()
    print(f"changes of elements in {STILL_S:g} s, {viewer.count:>3} displays: {changes or 'none'}")


def main() -> None:
    """Print all."""
    updates()
    with launched() as browser:
        viewers = [Viewer(FEW), Viewer(MANY)]
        loads(browser, viewers)
        for viewer in viewers:
            stillness(browser, viewer)
            viewer.server.stop()


if __name__ == "__main__":
    main()
