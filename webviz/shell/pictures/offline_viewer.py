"""A viewer without a thread: shows a bag at a time, and reports the statuses of displays."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass

import msgspec

from webviz import commands
from webviz.api.errors import Error
from webviz.api.frames import Frames
from webviz.api.group import DisplayGroup
from webviz.api.status import LOADING, Level, Status, worst
from webviz.api.views import FIXED_FRAME, FPS, TopDownOrtho, View
from webviz.engine.commands import Command
from webviz.engine.loop import FrameLoop
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.visibility import enabled, hidden_in
from webviz.engine.state import Row
from webviz.files.config import Config, nearest
from webviz.scene import ViserScene
from webviz.shell.pictures.times import seconds_from_start
from webviz.sources import Source
from webviz.sources.player import Player

LOOK_S = 0.05
LOADING_S = 60.0
"""Time in seconds for displays that load when the time is over: files and threads end by
themselves, and what a busy machine takes for meshes says nothing about the data."""


@dataclass(frozen=True)
class Readiness:
    """The statuses of a config at one time.

    Args:
        statuses: the worst status of each enabled display by name.
        general: statuses of the viewer as a whole, such as "Fixed Frame".
        awaited: names of the displays that must be OK.
        awaits: whether displays that load or wait may still become OK, unlike those that wait in a
            bag, whose time stands still.
    """

    statuses: Mapping[str, Status]
    general: Mapping[str, Status]
    awaited: tuple[str, ...]
    awaits: bool = False

    def __post_init__(self) -> None:
        for name in self.awaited:
            if name not in self.statuses:
                hint = nearest(name, self.statuses)
                raise Error(f"No enabled display is named {name!r}: {hint}")

    @property
    def is_ok(self) -> bool:
        """Return whether no awaited display has a problem.

        To load or to wait is none, but as long as more may come they are not OK.
        """
        levels = {self.statuses[name].level for name in self.awaited}
        return levels <= ({Level.OK} if self.awaits else {Level.OK, Level.IDLE})


class OfflineViewer:
    """A viewer without a thread of its own.

    Args:
        config: what to show.
        source: of the messages.
        scene: where to draw.
        show: called whenever pages should be updated.
    """

    def __init__(
        self,
        config: Config,
        source: Source,
        scene: ViserScene,
        show: Callable[[], object] = lambda: None,
    ) -> None:
        self._source = source
        self._scene = scene
        self._viewer = FrameLoop(config, source, scene, show)
        self._viewer.turn()

    def close(self) -> None:
        """Stop the displays and clear the scene."""
        self._viewer.close()
        self._scene.clear()
        self._scene.flush()

    @property
    def loop(self) -> FrameLoop:
        """The frame loop, which is turned by hand."""
        return self._viewer

    def do(self, command: Command) -> None:
        """Carry out a command, draw its effect and show it."""
        answer = self._viewer.enqueue(command)
        while not answer.done():
            self._viewer.turn()
        answer.result()

    def seek(self, source: Player, at_ns: int, deadline: float) -> None:
        """Show a bag at a time of recording.

        Args:
            source: the bag.
            at_ns: the time of recording.
            deadline: in seconds of `time.monotonic`.

        Raises:
            Error: the deadline passed before.
        """
        answer = self._viewer.enqueue(commands.Seek(seconds_from_start(at_ns, source.history)))
        while not answer.done():
            if time.monotonic() > deadline:
                reached, target = (
                    seconds_from_start(each, source.history) for each in (source.reached_ns, at_ns)
                )
                raise Error(
                    f"The time-out passed after {max(reached, 0.0):.1f} s of {target:.1f} s of "
                    "the bag. Choose a longer time-out or an earlier time."
                )
            source.inbox.arrived.clear()
            self._viewer.turn()
            if self._viewer.is_busy() and not answer.done():
                source.inbox.arrived.wait(LOOK_S)
        answer.result()

    def wait(self, names: Collection[str], deadline: float) -> Readiness:
        """Draw until nothing is loading and the named displays are OK, or the deadline passes.

        In a bag time stands still, so this waits for loading only, for some time longer if needed.

        Args:
            names: of displays.
            deadline: in seconds of `time.monotonic`.

        Raises:
            Error: no enabled display has such a name.
        """
        while True:
            self._source.inbox.arrived.clear()
            self._viewer.turn()
            rows = self._rows()
            is_bag = isinstance(self._source, Player)
            is_loading = any(LOADING in row.statuses for row in rows)
            is_loading |= is_bag and self._viewer.is_busy()  # such as with compressed depths
            late_s = time.monotonic() - deadline
            is_over = late_s > (LOADING_S if is_loading else 0.0)
            awaits = is_loading or not is_bag
            readiness = Readiness(_summaries(rows), self._viewer.statuses, tuple(names), awaits)
            if is_over or (not is_loading and (is_bag or readiness.is_ok)):
                return readiness
            self._source.inbox.arrived.wait(LOOK_S)

    def names(self) -> list[str]:
        """Names of all enabled displays except groups; duplicate names are numbered."""
        return list(_summaries(self._rows()))

    def hidden(self) -> dict[str, list[str]]:
        """Ids of the displays that panes with the scene leave out, by their own."""
        rows = self._rows()
        return hidden_in(rows, rows)

    def focused(self, view: View, frame: str) -> View:
        """Return a view of the current position of a frame, from the same direction and distance.

        Raises:
            Error: the frame is unknown, or the view has no focal point.
        """
        viewer = self._viewer
        frames = Frames(viewer.buffer, viewer.settings.fixed_frame, self._source.now_ns())
        pose = frames.latest(frame.removeprefix("/"))
        if pose is None:
            raise Error(frames.why_not(frame.removeprefix("/")))
        if isinstance(view, FPS):
            raise Error("A view of type FPS has no focal point. Focus another view.")
        x, y, _ = pose.position
        place = (
            {"x": x, "y": y} if isinstance(view, TopDownOrtho) else {"focal_point": pose.position}
        )
        return msgspec.structs.replace(view, target_frame=FIXED_FRAME, **place)

    def _rows(self) -> Sequence[Row]:
        self._viewer.update()
        return self._viewer.get(DisplaysPart).rows


def _summaries(rows: Sequence[Row]) -> dict[str, Status]:
    result: dict[str, Status] = {}
    for row in enabled(rows):
        if isinstance(row.display, DisplayGroup):
            continue
        name, number = row.name, 2
        while name in result:
            name, number = f"{row.name} ({number})", number + 1
        result[name] = summary(row.statuses)
    return result


def summary(statuses: Mapping[str, Status]) -> Status:
    """Return the worst level, with the texts of all statuses of that level."""
    level = worst(statuses.values())
    texts = [status.text for status in statuses.values() if status.level is level]
    return Status(level, "\n".join(texts))
