"""Reports of pages: how they draw, and when they have painted what was sent."""

from __future__ import annotations

import itertools
import threading
import time
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated

from msgspec import Meta

from webviz.api.browser import BrowserSeen
from webviz.engine.pipeline.browsers import Painted
from webviz.scene.adapter import Adapter
from webviz.scene.cameras import ViserCameras
from webviz.server.access.visitors import Visitor
from webviz.server.channel.links import reduced
from webviz.server.channel.messages import FromPage, Number

MAX_PROBES = 32
"""Probes whose answers count; a browser that answers later is too slow to be measured."""
MAX_ANSWERS = 1000
MAX_NAME = 60
Seconds = Annotated[float, Meta(ge=0, le=86_400)]


class Vitals(FromPage, frozen=True):
    """Says how a page draws, every few seconds; not of watchers, as others see findings about it.

    Args:
        renderer: of its graphics, as the browser names it.
        is_software: whether the processor draws.
        is_hidden: whether its tab is in the background.
        frame_s: median time that a frame took since the last report, 0 if none was drawn.
        late_s: longest time by which its timers were late since the last report.
    """

    renderer: Annotated[str, Meta(max_length=200)]
    is_software: bool
    is_hidden: bool
    frame_s: Seconds
    late_s: Seconds


class HasPainted(FromPage, frozen=True):
    """Answers a probe once the frame with what came before it is on the screen.

    Args:
        probe: its number.
        waited_s: time from the probe to that frame.
    """

    probe: Number
    waited_s: Seconds


class ViserBrowsers:
    """The browsers of a scene.

    Args:
        link: to them.
        cameras: of them.
        points: by id of the browser, the number that it draws 20 times a second.
    """

    def __init__(
        self, link: Adapter, cameras: ViserCameras, points: Callable[[], Mapping[int, int]]
    ) -> None:
        self._link = link
        self._cameras = cameras
        self._points = points
        self._lock = threading.Lock()
        self._vitals: dict[int, tuple[float, Vitals]] = {}
        """Vitals of browsers with the time of reception."""
        self._came: dict[int, float] = {}
        self._numbers = itertools.count(1)
        self._open: deque[int] = deque(maxlen=MAX_PROBES)
        self._answers: deque[Painted] = deque(maxlen=MAX_ANSWERS)
        link.channel.on(Vitals, self._hear)
        link.channel.on(HasPainted, self._hear_painted)

    def reports(self) -> Sequence[BrowserSeen]:
        """All browsers as they reported last."""
        now = time.monotonic()
        channel = self._link.channel
        browsers, visitors, views = channel.browsers(), channel.visitors(), self._cameras.views()
        points = self._points()
        with self._lock:
            self._came = {each: self._came.get(each, now) for each in browsers}
            self._vitals = {i: each for i, each in self._vitals.items() if i in browsers}
            vitals = dict(self._vitals)
        observations: list[BrowserSeen] = []
        for browser in sorted(browsers):
            heard_s, report = vitals.get(browser, (self._came[browser], None))
            congestion = channel.congestion(browser)
            view = views.get(browser)
            observations.append(
                BrowserSeen(
                    id=browser,
                    name=_name(visitors.get(browser)),
                    waited_s=0.0 if browser in visitors else now - self._came[browser],
                    silent_s=now - heard_s,
                    renderer=report.renderer if report else "",
                    is_software=report is not None and report.is_software,
                    is_hidden=report is not None and report.is_hidden,
                    frame_s=report.frame_s if report else 0.0,
                    late_s=report.late_s if report else 0.0,
                    points=points.get(browser, 0),
                    rate=congestion.rate if congestion else None,
                    reduced=reduced(congestion) if congestion else "",
                    view=view,
                    size=self._cameras.size(browser) if view else (0.0, 0.0),
                )
            )
        return observations

    def probe(self) -> int:
        """Ask all browsers when they paint what was flushed; the number of the probe."""
        number = next(self._numbers)
        with self._lock:
            self._open.append(number)
        self._link.probe(number)
        return number

    def take_painted(self) -> Sequence[Painted]:
        """Return the answers to probes since the last call."""
        with self._lock:
            answers = tuple(self._answers)
            self._answers.clear()
        return answers

    def count_bytes(self, is_wanted: bool) -> None:
        """Count the bytes that are sent from now on, or no longer."""
        self._link.count_bytes(is_wanted)

    def bytes_sent(self) -> Mapping[int, Mapping[str, int]]:
        """Return the bytes sent since `count_bytes`, by id of the browser and of the display."""
        return self._link.bytes_sent()

    # Called on viser's event loop

    def _hear(self, browser: int, report: Vitals) -> None:
        with self._lock:
            self._vitals[browser] = time.monotonic(), report

    def _hear_painted(self, browser: int, answer: HasPainted) -> None:
        now = time.monotonic()
        visitor = self._link.channel.visitors().get(browser)
        # The clocks of pages are not needed: the answer took half of a round trip.
        painted_s = now - ((visitor.latency_s or 0.0) / 2.0 if visitor else 0.0)
        with self._lock:
            if answer.probe in self._open:
                begun_s = painted_s - answer.waited_s
                self._answers.append(Painted(answer.probe, browser, begun_s, painted_s))


def _name(visitor: Visitor | None) -> str:
    """Return the name of a browser in sentences."""
    if visitor is None:
        return "a browser"
    return f"the browser of {(visitor.name or visitor.address)[:MAX_NAME]}"
