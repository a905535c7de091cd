"""Bug reports of bags and of live topics, without a page."""

from __future__ import annotations

import base64
import contextlib
import math
import time
from collections.abc import Callable, Sequence
from pathlib import Path

from webviz import commands
from webviz.api.status import LOADING
from webviz.commands import Refresh
from webviz.engine.commands import Command
from webviz.engine.loop import FrameLoop
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.state import Row
from webviz.files.config import Config
from webviz.shell.doctor.scene import NoScene
from webviz.shell.pictures.times import At, TimeError, position_ns, seconds_from_start
from webviz.shell.report.scenes import Pictured
from webviz.sources import Source
from webviz.sources.past_state import Event
from webviz.sources.player import Player

REST_S = 0.05
COMPARED_S = 1.5
"""Time in seconds in which displays are compared with each other, also while time stands still."""
SETTLED_S = 30.0
"""Time in seconds for displays that load, such as the meshes of a robot."""

Progress = Callable[[str, float], object]
"""Called with what is done and the share of it that is."""


def make_report(
    config: Config,
    source: Source,
    pictured: Pictured,
    path: Path | None,
    *,
    span: tuple[At, At] = ("start", "end"),
    at: At | None = None,
    name: str = "",
    seconds: float = 10.0,
    with_names: bool = False,
    progress: Progress = lambda what, share: None,
) -> str:
    """Write a report, or list what it would contain.

    Args:
        config: the displays to show.
        source: a bag, or live topics.
        pictured: the scene.
        path: of the zip file; None to list its content.
        span: first and last time of a bag.
        at: the moment of the bag to show, None for the last.
        name: of the bag, for errors.
        seconds: to listen to live topics.
        with_names: keep names of hosts, users and home folders.
        progress: called now and then.

    Returns:
        The answer, or one line per member.

    Raises:
        Error: a time is outside of the bag, or the report cannot be written.
    """
    times = _times(source, span, at, name) if isinstance(source, Player) else None
    maker = _Maker(FrameLoop(config, source, pictured.scene), source, progress)
    with contextlib.closing(maker):
        if times is not None:
            maker.play(*times)
        else:
            maker.listen(seconds)
        if path is None:
            return maker.do(commands.ListReport(with_names))
        picture = base64.b64encode(pictured.png()).decode()
        return maker.do(commands.SaveReport(picture, (), with_names, str(path.absolute())))


def play_through(config: Config, bag: Player, at_s: float) -> tuple[Sequence[Row], Sequence[Event]]:
    """Play a bag from its start to its end without a browser, and show a moment of it.

    Args:
        config: the displays to show.
        bag: the bag.
        at_s: in seconds from the start; of a shorter bag its end.

    Returns:
        The displays then, and when findings began.
    """
    end_s = seconds_from_start(bag.history.end_ns, bag.history)
    loop = FrameLoop(config, bag, NoScene())
    with contextlib.closing(_Maker(loop, bag, lambda what, share: None)) as maker:
        maker.play(0.0, end_s, min(at_s, end_s))
        loop.update()
        return loop.get(DisplaysPart).rows, loop.doctor.events


def _times(
    bag: Player, span: tuple[At, At], at: At | None, name: str
) -> tuple[float, float, float]:
    """First, last and shown time of a bag, in seconds from its start."""
    first_ns, last_ns = (position_ns(each, bag.history, name) for each in span)
    at_ns = last_ns if at is None else position_ns(at, bag.history, name)
    first, last, moment = (
        seconds_from_start(each, bag.history) for each in (first_ns, last_ns, at_ns)
    )
    if not first < last:
        raise TimeError(f"--from {first:g} s must be before --to {last:g} s.")
    if not first <= moment <= last:
        raise TimeError(
            f"--at {moment:g} s must be between --from {first:g} s and --to {last:g} s."
        )
    return first, last, moment


class _Maker:
    def __init__(self, loop: FrameLoop, source: Source, progress: Progress) -> None:
        self._loop = loop
        self._source = source
        self._progress = progress

    def close(self) -> None:
        """End all threads."""
        self._loop.close()

    def do(self, command: Command) -> str:
        """Carry out a command; its answer."""
        answer = self._loop.enqueue(command)
        while not answer.done():
            self._turn()
        return answer.result()

    def play(self, first_s: float, last_s: float, shown_s: float) -> None:
        """Play a span of a bag to its end, so that the doctor sees it, and show a moment of it."""
        self.do(commands.SelectSpan(first_s, last_s))
        self.do(commands.Seek(first_s))
        self._loop.doctor.slice_s = math.inf
        self.do(commands.SetRate(0.0))
        self.do(commands.Play())
        self._loop.update()
        while (played := self._loop.fact("playback")) is not None and played.is_playing:
            self._progress("playing", (played.position_s - first_s) / (last_s - first_s))
            self._loop.turn()
            self._loop.update()
        self.do(commands.Seek(shown_s))
        self._settle()

    def listen(self, seconds: float) -> None:
        """Receive live topics for some seconds."""
        began_s = time.monotonic()
        while (passed := time.monotonic() - began_s) < seconds:
            self._progress("listening", passed / seconds)
            self._loop.doctor.ask()
            self._turn()
        self._settle()

    def _settle(self) -> None:
        """Turn until everything is loaded and compared, and panels would show it."""
        began_s = time.monotonic()
        while (passed := time.monotonic() - began_s) < SETTLED_S:
            if not self._is_loading() and passed > COMPARED_S:
                break
        self.do(Refresh())

    def _is_loading(self) -> bool:
        self._turn()
        self._loop.update()
        rows = self._loop.get(DisplaysPart).rows
        return self._loop.is_busy() or any(LOADING in row.statuses for row in rows)

    def _turn(self) -> None:
        self._source.inbox.arrived.wait(REST_S)
        self._source.inbox.arrived.clear()
        self._loop.turn()
