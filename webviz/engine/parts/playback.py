"""Playing of the source, if it has a past."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.api.status import Level, Status
from webviz.data.names import problem_of
from webviz.data.words import joined
from webviz.engine.commands import Sender
from webviz.engine.parts.declaring import command, store
from webviz.engine.parts.display_events import DisplayEvents
from webviz.engine.parts.part import Batches, Core, Part
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.timeline import (
    BookmarksStore,
    DensityStore,
    PlaybackStore,
    RecordedStore,
    bookmarks_store,
    counted,
    density_store,
    playback_store,
)
from webviz.engine.requests import Job
from webviz.engine.state import Row
from webviz.files.config import nearest
from webviz.sources.bag.history import BagHistory
from webviz.sources.past_state import Event, PlaybackState
from webviz.sources.player import END_NS, Player

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
        player: of what is shown.
        start_over: discards the received data of all parts.
        stop: stops all vehicles that are driven; whether any was.
        autoplay: play as soon as a browser is connected, so that nobody misses the beginning.
    """

    name = "Playback"

    def __init__(
        self,
        core: Core,
        settings: SettingsPart,
        player: Player,
        start_over: Callable[[], None],
        stop: Callable[[], bool],
        autoplay: bool = False,
    ) -> None:
        super().__init__(core)
        player.is_ready = autoplay and not player.is_live
        self._settings = settings
        self._player = player
        self._start_over = start_over
        self._stop = stop
        self._first_events = self._display_events = DisplayEvents()
        self.playback: PlaybackState | None = None
        """The recording that is played, as of the last turn; None for live topics alone."""
        self.recorded: Mapping[str, Sequence[int]] = {}
        """Counts of its messages in equal parts of its span, by topic."""
        self.logged: Sequence[Event] = ()
        """Warnings and errors that its nodes logged, by time."""
        self._leader: int | None = None
        """The browser that looked back last, None for a program."""

    @property
    def is_seeking(self) -> bool:
        """Return whether a position is being approached, so that nothing is to be drawn yet."""
        return self._player.is_seeking

    def advance(self, is_busy: bool) -> None:
        """Play what is due, before the messages of a turn are taken.

        Args:
            is_busy: whether displays have to catch up first.
        """
        if self._player.is_ready and self.core.is_watched():
            self._player.play()
        if self._player.advance(is_busy):
            self._start_over()

    def open(
        self, path: Path, opened: Callable[[Path], BagHistory] = BagHistory
    ) -> Job[BagHistory]:
        """Play a recording in the place of live topics.

        Args:
            path: of it.
            opened: reads it; called in a thread.

        Raises:
            Error: there are none.
        """
        player = self._player
        if player.live is None:
            raise Error(NO_LIVE)

        def then(bag: BagHistory) -> str:
            player.show(bag)
            self._display_events = DisplayEvents()
            self._start_over()
            player.play()
            return self._stopped(player)

        return Job(lambda: opened(path), then)

    def take(self, batches: Batches) -> None:
        """Remember where frames are while a seek passes them, since nothing is drawn."""
        if self.is_seeking:
            self.core.frames.pass_by()

    def update(self) -> None:
        """Note the state of the player, and what is recorded when."""
        player, history = self._player, self._player.history
        if player.absence:
            self.playback, self.recorded, self.logged = None, {}, ()
        else:
            self.recorded = history.histogram(BUCKETS)  # before the span that it counts is read
            self.playback, self.logged = _state_of(player), history.logged()

    @store(name="playback")
    def shown(self, argument: str) -> PlaybackStore | None:
        """Return the recording or the memory, None without either."""
        if self.playback is None:
            return None
        memory_s = self._settings.settings.memory.seconds
        wall_s = self.core.get(TimePart).times.wall_s
        return playback_store(self.playback, memory_s, wall_s, self._leader)

    @store()
    def bookmarks(self, argument: str) -> BookmarksStore | None:
        """Return the bookmarks of this recording."""
        recording = self.playback
        return recording and bookmarks_store(recording, self._settings.settings.bookmarks)

    @store(of=lambda part: (counted(part.playback), part.recorded))
    def density(self, argument: str) -> DensityStore:
        """Return counts of all messages."""
        return density_store(self.playback, self.recorded)

    @store(name="recorded", of=lambda part: part.recorded)
    def recorded_by_topic(self, argument: str) -> RecordedStore:
        """Return counts of messages by topic."""
        return RecordedStore(self.recorded)

    @property
    def is_recording(self) -> bool:
        """Return whether a recording is shown, and no live topics or their past."""
        return self.playback is not None and self.playback.is_live is None

    @property
    def warned(self) -> Sequence[Event]:
        """When displays began to warn, as far as it was shown, by time."""
        return self._display_events.events

    def note_warnings(self, rows: Sequence[Row]) -> None:
        """Note which displays began to warn at the position."""
        player, found = self._player, self._display_events
        # On the way to a position, and before the first message, displays lack their messages.
        if not player.is_seeking and player.reached_ns >= player.history.start_ns:
            found.note(player.position_ns, rows)

    def state(self) -> Mapping[str, Any]:
        """Return the recording, the counts of its messages, and its events."""
        return {
            "playback": self.playback,
            "recorded": self.recorded,
            "logged": self.logged,
            "warned": self.warned,
        }

    def statuses(self) -> Mapping[str, Status]:
        """Return what is missing, unusual or damaged in the recording."""
        warnings = self._player.warnings
        return {"Bag": Status(Level.WARN, joined(*warnings))} if warnings else {}

    def close(self) -> None:
        """Close the recording that is shown in the place of live topics."""
        if self._player.is_opened:
            self._player.history.close()

    # Commands

    @command(Role.OPERATOR)
    def play(self) -> None:
        """Play from the position, at the end of the span from its start; `Pause` stops it."""
        player = self._known()
        if player.is_live:
            raise Error(LIVE)
        player.play()

    @command(Role.OPERATOR)
    def seek(self, at_s: float, sender: Sender) -> str:
        """Show the recording at a time; answered when the scene shows it."""
        player = self._known()
        self._leader = sender.browser
        player.seek(self.at_ns(at_s))
        return self._stopped(player)

    @command(Role.OPERATOR)
    def return_to_live(self) -> None:
        """Show what arrives again, instead of the past of live topics or a recording."""
        if self._known().return_to_live():
            self._display_events = self._first_events
            self._start_over()

    @command(Role.OPERATOR)
    def set_rate(self, rate: float) -> None:
        """Set how fast to play: seconds of the recording per second, 0 is as fast as possible."""
        player = self._known()
        if rate and not MIN_RATE <= rate <= MAX_RATE:
            raise Error(
                f"The rate {rate:g} is out of range. Give {MIN_RATE:g} to {MAX_RATE:g}, or 0 for "
                "as fast as possible."
            )
        player.rate = rate or math.inf

    @command(Role.OPERATOR)
    def set_loop(self, loop: bool = True) -> None:
        """Choose whether the span starts over at its end."""
        self._known().loop = loop

    @command(Role.OPERATOR)
    def select_span(self, first_s: float | None = None, last_s: float | None = None) -> None:
        """Choose the part of the recording to play; without times, all of it.

        Args:
            first_s: its start, None for that of the recording.
            last_s: its end, None for that of the recording.
        """
        player = self._known()
        history = player.history
        if first_s is None and last_s is None:
            player.selected = None
            return
        first_ns = history.start_ns if first_s is None else self.at_ns(first_s)
        last_ns = history.end_ns if last_s is None else min(self.at_ns(last_s), history.end_ns)
        if first_ns >= last_ns:
            raise Error("The selected span is empty. Choose an end later than its start.")
        player.selected = first_ns, last_ns

    @command(Role.OPERATOR)
    def step_message(self, sender: Sender, topic: str = "", is_forward: bool = True) -> str:
        """Pause, and show the recording at the next or previous message of a topic.

        Args:
            topic: its name; "" is every displayed topic.
            is_forward: whether to the next message.
        """
        player = self._known()
        try:
            topic = self.core.player.resolve(topic) if topic else ""
        except ValueError as error:
            raise Error(f"{error}.") from error
        if not player.step(topic, is_forward):
            where = "next" if is_forward else "previous"
            what = f"message on {topic}" if topic else "message of a displayed topic"
            raise Error(f"There is no {where} {what}. Step in the other direction.")
        self._leader = sender.browser
        return self._stopped(player)

    def _stopped(self, player: Player) -> str:
        """Stop vehicles, whose drivers see the past from now on; a sentence if any moved."""
        return STOPPED if not player.is_live and self._stop() else ""

    @command(Role.OPERATOR)
    def save_bookmark(self, name: str, at_s: float | None = None) -> None:
        """Give a moment of the recording a name, in place of a moment of that name.

        Args:
            name: of the bookmark.
            at_s: the moment, None for the position.
        """
        player = self._known()
        if problem := problem_of(name):
            raise Error(problem)
        end_ns = player.history.end_ns
        at_ns = player.position_ns if at_s is None else min(self.at_ns(at_s), end_ns)
        bookmarks = {**self._settings.settings.bookmarks, name: at_ns / 1e9}
        self._settings.set("bookmarks", bookmarks)

    @command(Role.OPERATOR)
    def remove_bookmark(self, name: str) -> None:
        """Remove a bookmark."""
        bookmarks = dict(self._settings.settings.bookmarks)
        if bookmarks.pop(name, None) is None:
            raise Error(f"Unknown bookmark `{name}`: {nearest(name, bookmarks)}")
        self._settings.set("bookmarks", bookmarks)

    def _known(self) -> Player:
        if absence := self._player.absence:
            raise Error(absence)
        return self._player

    def at_ns(self, seconds: float) -> int:
        """Return a position of what people count as seconds, not before the first message."""
        history = self._known().history
        if math.isnan(seconds):
            raise Error("NaN is not a valid time. Give seconds from the start of the recording.")
        origin_ns, end_ns = history.origin_ns, history.end_ns
        first_s, last_s = ((each - origin_ns) / 1e9 for each in (history.start_ns, END_NS))
        at_ns = origin_ns + round(min(max(seconds, first_s), last_s) * 1e9)
        # Seconds of a recording of years are not accurate to a nanosecond.
        return end_ns if seconds == (end_ns - origin_ns) / 1e9 else at_ns


def _state_of(player: Player) -> PlaybackState:
    history = player.history
    start_ns = history.origin_ns
    return PlaybackState(
        names=tuple(history.names),
        start_ns=start_ns,
        end_ns=history.end_ns,
        first_s=(history.start_ns - start_ns) / 1e9,
        is_live=player.is_live if history.is_growing else None,
        is_opened=player.is_opened,
        position_s=(player.position_ns - start_ns) / 1e9,
        rate=player.rate,
        is_playing=player.is_playing,
        is_seeking=player.is_seeking,
        loop=player.loop,
        selected=_seconds(player.selected, start_ns),
        gap=_seconds(history.gap_ns, start_ns),
        counted=_seconds(history.counted_ns, start_ns),
    )


def _seconds(span_ns: tuple[int, int] | None, start_ns: int) -> tuple[float, float] | None:
    """Return a span in seconds from the start."""
    return span_ns and ((span_ns[0] - start_ns) / 1e9, (span_ns[1] - start_ns) / 1e9)
