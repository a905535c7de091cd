"""The toolbar of every page: shows the tools, and passes strokes on to the frame loop."""

from __future__ import annotations

import threading
import time
from collections import deque
from collections.abc import Callable, Mapping
from concurrent.futures import Future
from dataclasses import fields
from typing import Any

import msgspec

from webviz.api.status import Level, Status
from webviz.engine.commands import Command, Sender, UseTool
from webviz.engine.state import State, ToolButton
from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import Published, Result, StrokeDone, Tools

MAX_PER_SECOND = 20
"""Strokes of a browser within a second; people make one or two."""

_SENT = [field.name for field in fields(ToolButton) if field.name != "tool"]


class Toolbar:
    """The tools on every page. Which one is active, only the page itself knows.

    Args:
        channel: to the pages.
        enqueue: takes commands, from any thread.
        note: is told what browsers sent with tools, from any thread.
        clock: monotonic time in seconds.
    """

    def __init__(
        self,
        channel: Channel,
        enqueue: Callable[[Command, Sender], Future[str]],
        note: Callable[[int, str], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self._channel = channel
        self._enqueue = enqueue
        self._note = note
        self._clock = clock
        self._recent: dict[int, deque[float]] = {}
        """When each browser made its last strokes."""
        self._shown: Tools | None = None
        channel.on(StrokeDone, self._use)

    def update(self, state: State) -> None:
        """Show the tools of a viewer; sends only what is new."""
        tools = Tools(tuple({name: getattr(each, name) for name in _SENT} for each in state.tools))
        if tools != self._shown:
            self._shown = tools
            self._channel.send(tools)

    def _use(self, browser: int, stroke: StrokeDone) -> None:
        is_noted = threading.Event()

        def tell(status: Status) -> None:
            level = Level(status.level).name.lower()
            if status.level is not Level.ERROR and not is_noted.is_set():
                is_noted.set()  # what comes later is how it goes on
                self._note(browser, status.text)
            self._channel.send(Result(stroke.number, level, status.text), browser)

        def published(topic: str, type: str, values: Mapping[str, Any]) -> None:
            encoded = msgspec.Raw(msgspec.json.encode(values, enc_hook=_plain))
            self._channel.send(Published(stroke.number, topic, type, encoded), browser)

        def finish(used: Future[str]) -> None:
            if not used.cancelled() and (error := used.exception()):
                tell(Status(Level.ERROR, str(error)))

        if self._is_flood(browser):
            text = f"Not sent: more than {MAX_PER_SECOND} gestures within a second. Wait a moment."
            tell(Status(Level.ERROR, text))
            return
        keys = frozenset(stroke.keys)
        command = UseTool(
            stroke.tool,
            stroke.points,
            stroke.yaw,
            keys,
            stroke.yaws,
            stroke.several,
            report=tell,
            published=published,
        )
        self._enqueue(command, Sender(browser)).add_done_callback(finish)

    def _is_flood(self, browser: int) -> bool:
        """Return whether a browser makes strokes faster than people do; if not, counts this one."""
        now = self._clock()
        recent = {id: times for id, times in self._recent.items() if times[-1] > now - 1.0}
        times = recent.setdefault(browser, deque(maxlen=MAX_PER_SECOND))
        self._recent = recent
        is_flood = len(times) == MAX_PER_SECOND and times[0] > now - 1.0
        if not is_flood:
            times.append(now)
        return is_flood


def _plain(value: Any) -> Any:
    """Numbers and arrays of numpy, and for all else its text."""
    return value.tolist() if hasattr(value, "tolist") else str(value)
