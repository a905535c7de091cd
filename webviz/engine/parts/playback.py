"""Playing of the source, if it has a past."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from webviz.api.errors import Error
from webviz.api.status import Level, Status
from webviz.data.names import problem_of
from webviz.data.words import joined
from webviz.engine.commands import (
    Command,
    OpenRecording,
    Play,
    RemoveBookmark,
    ReturnToLive,
    SaveBookmark,
    Seek,
    SelectSpan,
    Sender,
    SetLoop,
    SetRate,
    StepMessage,
)
from webviz.engine.commands.requests import Job
from webviz.engine.parts.black_box import FOLDER
from webviz.engine.parts.part import Batches, Core, Handler, Part
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.playback import DisplayEvents, PlaybackControl
from webviz.engine.playback.control import END_NS
from webviz.engine.state import Row
from webviz.files.config import nearest
from webviz.sources.bag.source import BagSource
from webviz.sources.past_state import Event, PlaybackState
from webviz.sources.switchable import Switchable

MIN_RATE, MAX_RATE = 0.01, 1000.0
BUCKETS = 500
"""Parts of the span whose messages are counted: about one for each three pixels of a wide page."""
LIVE = "Topics are live, so there is nothing to play. Seek to a past moment first."
REWOUND = "Nothing is sent to the robot while the page shows the past. Return to live first (L)."
NO_LIVE = "A bag is already open. Start webviz with --bag to play another one."
STOPPED = "The vehicle was stopped, because the page shows the past."


class PlaybackPart(Part):
    """Plays, seeks and steps.

    Args:
        core: shared by all parts.
        settings: has the bookmarks.
        control: of the source.
        start_over: discards the received data of all parts.
        stop: stops all vehicles that are driven; whether any was.
        autoplay: play as soon as a browser is connected, so that nobody misses the beginning.
        switchable: shows recordings in the place of live topics; None for a bag.
    """

    name = "Playback"

    def __init__(
        self,
        core: Core,
        settings: SettingsPart,
        control: PlaybackControl,
        start_over: Callable[[], None],
        stop: Callable[[], bool],
        autoplay: bool = False,
        switchable: Switchable | None = None,
    ) -> None:
        super().__init__(core)
        control.is_ready = autoplay and not control.is_live
        self._settings = settings
        self._control = control
        self._start_over = start_over
        self._stop = stop
        self._switchable = switchable
        self._first_events = self._display_events = DisplayEvents()

    @property
    def handles(self) -> Mapping[type[Command], Handler]:
        """The handler of each command."""
        return {
            OpenRecording: self._open,
            Play: self._play,
            ReturnToLive: self._return_to_live,
            Seek: self._seek,
            SetRate: self._set_rate,
            SetLoop: self._set_loop,
            SelectSpan: self._select,
            StepMessage: self._step,
            SaveBookmark: self._save_bookmark,
            RemoveBookmark: self._remove_bookmark,
        }

    @property
    def is_seeking(self) -> bool:
        """Return whether a position is being approached, so that nothing is to be drawn yet."""
        return self._control.is_seeking

    def advance(self, is_busy: bool) -> None:
        """Play what is due, before the messages of a turn are taken.

        Args:
            is_busy: whether displays have to catch up first.
        """
        if self._control.is_ready and self.core.is_watched():
            self._control.play()
        if self._control.advance(is_busy):
            self._start_over()

    def take(self, batches: Batches) -> None:
        """Remember where frames are while a seek passes them, since nothing is drawn."""
        if self.is_seeking:
            self.core.frames.pass_by()

    def state(self) -> Mapping[str, Any]:
        """Return the state of the control, and what is recorded when."""
        playback = self._control.playback
        if playback.absence:
            return {"playback": None, "recorded": {}, "logged": ()}
        recorded = playback.histogram(BUCKETS)
        return {
            "playback": _state_of(self._control, self._is_opened),
            "recorded": recorded,
            "logged": playback.logged(),
        }

    def warned(self, rows: Sequence[Row]) -> Sequence[Event]:
        """Note which displays began to warn at the position, and return all notes."""
        control, found = self._control, self._display_events
        # On the way to a position, and before the first message, displays lack their messages.
        if not control.is_seeking and control.playback.position_ns >= control.playback.start_ns:
            found.note(control.position_ns, rows)
        return found.events

    def statuses(self) -> Mapping[str, Status]:
        """Return what is missing, unusual or damaged in the recording."""
        warnings = self._control.playback.warnings
        return {"Bag": Status(Level.WARN, joined(*warnings))} if warnings else {}

    def close(self) -> None:
        """Close the recording that is shown in the place of live topics."""
        if self._switchable is not None and self._switchable.bag is not None:
            self._switchable.bag.close()

    # Commands

    def _play(self, command: Play, sender: Sender) -> None:
        control = self._known()
        if control.is_live:
            raise Error(LIVE)
        control.play()

    def _seek(self, command: Seek, sender: Sender) -> str:
        control = self._known()
        control.seek(self._at_ns(command.at_s))
        return self._stopped(control)

    def _return_to_live(self, command: ReturnToLive, sender: Sender) -> None:
        control = self._known()
        if self._switchable is not None and self._is_opened:
            control.switch(self._switchable.leave)
            self._display_events = self._first_events
            self._start_over()
        control.return_to_live()

    @property
    def _is_opened(self) -> bool:
        """Return whether a recording is shown in the place of live topics."""
        return self._switchable is not None and self._switchable.bag is not None

    def _open(self, command: OpenRecording, sender: Sender) -> Job[BagSource]:
        switchable, path = self._switchable, Path(command.path)
        if switchable is None:
            raise Error(NO_LIVE)
        if sender.browser is not None and path.absolute().parent != Path(FOLDER).absolute():
            raise Error(f"A page can open only recordings in {FOLDER}.")

        def then(bag: BagSource) -> str:
            self._control.switch(lambda: switchable.show(bag))
            self._display_events = DisplayEvents()
            self._start_over()
            self._control.play()
            return self._stopped(self._control)

        return Job(lambda: BagSource(path), then)

    def _set_rate(self, command: SetRate, sender: Sender) -> None:
        control, rate = self._known(), command.rate
        if rate and not MIN_RATE <= rate <= MAX_RATE:
            raise Error(
                f"The rate {rate:g} is out of range. Give {MIN_RATE:g} to {MAX_RATE:g}, or 0 for "
                "as fast as possible."
            )
        control.rate = rate or math.inf

    def _set_loop(self, command: SetLoop, sender: Sender) -> None:
        self._known().loop = command.loop

    def _select(self, command: SelectSpan, sender: Sender) -> None:
        control = self._known()
        playback = control.playback
        if command.first_s is None and command.last_s is None:
            control.selected = None
            return
        first, last = command.first_s, command.last_s
        first_ns = playback.start_ns if first is None else self._at_ns(first)
        last_ns = playback.end_ns if last is None else min(self._at_ns(last), playback.end_ns)
        if first_ns >= last_ns:
            raise Error("The selected span is empty. Choose an end later than its start.")
        control.selected = first_ns, last_ns

    def _step(self, command: StepMessage, sender: Sender) -> str:
        control = self._known()
        topic = command.topic
        try:
            topic = self.core.source.resolve(topic) if topic else ""
        except ValueError as error:
            raise Error(f"{error}.") from error
        control.pause()
        at_ns = control.playback.neighbour(topic, command.is_forward)
        if at_ns is None:
            where = "next" if command.is_forward else "previous"
            what = f"message on {topic}" if topic else "message of a displayed topic"
            raise Error(f"There is no {where} {what}. Step in the other direction.")
        control.seek(at_ns)
        return self._stopped(control)

    def _stopped(self, control: PlaybackControl) -> str:
        """Stop vehicles, whose drivers see the past from now on; a sentence if any moved."""
        return STOPPED if not control.is_live and self._stop() else ""

    def _save_bookmark(self, command: SaveBookmark, sender: Sender) -> None:
        control, at_s = self._known(), command.at_s
        if problem := problem_of(command.name):
            raise Error(problem)
        end_ns = control.playback.end_ns
        at_ns = control.position_ns if at_s is None else min(self._at_ns(at_s), end_ns)
        bookmarks = {**self._settings.settings.bookmarks, command.name: at_ns / 1e9}
        self._settings.set("bookmarks", bookmarks)

    def _remove_bookmark(self, command: RemoveBookmark, sender: Sender) -> None:
        bookmarks = dict(self._settings.settings.bookmarks)
        if bookmarks.pop(command.name, None) is None:
            raise Error(f"Unknown bookmark `{command.name}`: {nearest(command.name, bookmarks)}")
        self._settings.set("bookmarks", bookmarks)

    def _known(self) -> PlaybackControl:
        if absence := self._control.playback.absence:
            raise Error(absence)
        return self._control

    def _at_ns(self, seconds: float) -> int:
        """Return a position, not before the first message."""
        playback = self._known().playback
        if math.isnan(seconds):
            raise Error("NaN is not a valid time. Give seconds from the start of the recording.")
        origin_ns, end_ns = playback.origin_ns, playback.end_ns
        first_s, last_s = ((each - origin_ns) / 1e9 for each in (playback.start_ns, END_NS))
        at_ns = origin_ns + round(min(max(seconds, first_s), last_s) * 1e9)
        # Seconds of a recording of years are not accurate to a nanosecond.
        return end_ns if seconds == (end_ns - origin_ns) / 1e9 else at_ns


def _state_of(control: PlaybackControl, is_opened: bool) -> PlaybackState:
    playback = control.playback
    start_ns, is_bag = playback.origin_ns, bool(playback.names)
    return PlaybackState(
        names=tuple(playback.names),
        start_ns=start_ns,
        end_ns=playback.end_ns,
        first_s=(playback.start_ns - start_ns) / 1e9,
        is_live=None if is_bag else control.is_live,
        is_opened=is_opened,
        position_s=(control.position_ns - start_ns) / 1e9,
        rate=control.rate,
        is_playing=control.is_playing,
        is_seeking=control.is_seeking,
        loop=control.loop,
        selected=_seconds(control.selected, start_ns),
        gap=_seconds(playback.gap_ns, start_ns),
        counted=_seconds(playback.counted_ns, start_ns),
    )


def _seconds(span_ns: tuple[int, int] | None, start_ns: int) -> tuple[float, float] | None:
    """Return a span in seconds from the start."""
    return span_ns and ((span_ns[0] - start_ns) / 1e9, (span_ns[1] - start_ns) / 1e9)
