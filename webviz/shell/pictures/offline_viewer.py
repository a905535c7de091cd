"""A viewer in a studio: brings a config to a moment, and says how well it is shown."""

from __future__ import annotations

import time
from collections.abc import Collection, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass

import msgspec

from webviz.api.errors import Error
from webviz.api.frames import Frames
from webviz.api.group import Group
from webviz.api.status import Level, Status
from webviz.api.views import FIXED_FRAME, FPS, TopDownOrtho, View
from webviz.engine.loop import FrameLoop
from webviz.engine.sources import Source
from webviz.engine.sources.bag import BagSource
from webviz.engine.state import Row, State
from webviz.files.config import Config, nearest
from webviz.shell.pictures.studio import Studio
from webviz.shell.pictures.times import seconds_from_start

LOOK_S = 0.05
LOADING = "Loading"
"""Status of a display that waits for slow work."""


@dataclass(frozen=True)
class Readiness:
    """How well a config is shown at one moment.

    Args:
        statuses: of the enabled displays by name, each the worst of its statuses.
        general: what holds for the viewer as a whole, such as "Fixed Frame".
        awaited: names of the displays that were to be OK.
    """

    statuses: Mapping[str, Status]
    general: Mapping[str, Status]
    awaited: tuple[str, ...]

    def __post_init__(self) -> None:
        for name in self.awaited:
            if name not in self.statuses:
                hint = nearest(name, self.statuses)
                raise Error(f"No enabled display is named {name!r}: {hint}")

    @property
    def is_ok(self) -> bool:
        """Whether all that was awaited is there."""
        return all(self.statuses[name].level is Level.OK for name in self.awaited)


class OfflineViewer:
    """One config at work, without a thread of its own.

    Args:
        config: what to show.
        source: where messages come from.
        studio: where to draw.
    """

    def __init__(self, config: Config, source: Source, studio: Studio) -> None:
        self._source = source
        self._studio = studio
        self._viewer = FrameLoop(config, source, studio.scene, clock=self._clock)
        self._viewer.turn()

    def close(self) -> None:
        """End slow work, and leave the studio empty."""
        self._viewer.close()
        self._studio.clear()

    def play(self, source: BagSource, until_ns: int, deadline: float) -> None:
        """Let a bag run to a time of recording, drawing nothing on the way.

        Args:
            source: the bag.
            until_ns: the time of recording.
            deadline: when to give up, in seconds of `time.monotonic`.

        Raises:
            Error: the bag did not get there by the deadline.
        """
        with self._unwatched():
            while source.position_ns < until_ns:
                if time.monotonic() > deadline:
                    reached, wanted = (
                        seconds_from_start(at_ns, source)
                        for at_ns in (source.position_ns, until_ns)
                    )
                    raise Error(
                        f"The bag was played to {max(reached, 0.0):.1f} s of {wanted:.1f} s when "
                        "the time-out passed. Choose a longer time-out or an earlier time."
                    )
                source.play_step(until_ns)
                self._viewer.turn()

    def wait(self, names: Collection[str], deadline: float) -> Readiness:
        """Draw until nothing is loaded any more and the named displays are OK.

        Args:
            names: of displays.
            deadline: when to give up, in seconds of `time.monotonic`. In a bag time stands still,
                so only what loads is waited for.

        Returns:
            How far it came.

        Raises:
            Error: no enabled display has such a name; one sentence.
        """
        while True:
            self._source.inbox.arrived.clear()
            self._viewer.turn()
            state = self._state()
            shown = Readiness(self._statuses(state), state.statuses, tuple(names))
            is_loading = any(LOADING in row.statuses for row in state.rows)
            is_final = shown.is_ok or isinstance(self._source, BagSource)
            if (is_final and not is_loading) or time.monotonic() > deadline:
                return shown
            self._source.inbox.arrived.wait(LOOK_S)

    def names(self) -> list[str]:
        """Of the displays that are enabled, unsupported ones too, without groups.

        Several of one name are numbered.
        """
        return list(self._statuses(self._state()))

    def focused(self, view: View, frame: str) -> View:
        """A view that looks at a frame, where that is now, from the same side and distance.

        Raises:
            Error: the frame is not known, or the view looks at no point; one sentence.
        """
        frames = self._frames()
        pose = frames.latest(frame.removeprefix("/"))
        if pose is None:
            raise Error(frames.why_not(frame.removeprefix("/")))
        if isinstance(view, FPS):
            raise Error("A view of type FPS looks at no point: focus another view.")
        x, y, _ = pose.position
        place = (
            {"x": x, "y": y} if isinstance(view, TopDownOrtho) else {"focal_point": pose.position}
        )
        return msgspec.structs.replace(view, target_frame=FIXED_FRAME, **place)

    def _statuses(self, state: State) -> dict[str, Status]:
        result: dict[str, Status] = {}
        for row in _enabled(state.rows):
            name, number = row.name, 2
            while name in result:
                name, number = f"{row.name} ({number})", number + 1
            result[name] = summary(row.statuses)
        return result

    def _state(self) -> State:
        return self._viewer.state()

    def _frames(self) -> Frames:
        viewer = self._viewer
        return Frames(viewer.buffer, viewer.settings.fixed_frame, self._source.now_ns())

    def _clock(self) -> float:
        """Seconds for ages and rates: a bag's are the same in every run."""
        if isinstance(self._source, BagSource):
            return self._source.position_ns / 1e9
        return time.monotonic()

    @contextmanager
    def _unwatched(self) -> Iterator[None]:
        self._studio.scene.is_watched = False
        try:
            yield
        finally:
            self._studio.scene.is_watched = True


def summary(statuses: Mapping[str, Status]) -> Status:
    """The worst of some statuses, with what all that are as bad say, a line each."""
    level = max((status.level for status in statuses.values()), default=Level.OK)
    texts = [status.text for status in statuses.values() if status.level is level]
    return Status(level, "\n".join(texts))


def _enabled(rows: Collection[Row]) -> Iterator[Row]:
    hidden_below: int | None = None
    for row in rows:
        if hidden_below is not None and row.depth > hidden_below:
            continue
        hidden_below = None if row.enabled else row.depth
        if row.enabled and not isinstance(row.display, Group):
            yield row
