"""Playing of recordings and of the past of live topics, and the timeline.

The player is `webviz.sources.player.Player`; the moment that is shown is noted by
`webviz.engine.parts.time.TimePart`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.api.status import LOADING, Level, Status, worst_status
from webviz.data.names import problem_of
from webviz.engine.commands import Sender
from webviz.engine.feature import Feature, command, store
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.part import PartContext
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import TimePart
from webviz.engine.state import Row
from webviz.features.playback.stores import (
    BookmarksStore,
    DensityStore,
    EventsStore,
    PlaybackStore,
    RecordedStore,
    bookmarks_store,
    counted,
    density_store,
    events_of,
    playback_store,
)
from webviz.files.config import nearest
from webviz.sources.past_state import Event, PlaybackState

MAX_EVENTS = 500
SECOND_NS = 1_000_000_000


class DisplayEvents:
    """Notes when the worst level of a display rises, as far as the recording was shown.

    Loading is not noted, since it ends. A display is noted once per sentence and second of
    the recording, and forgotten when it is removed. The oldest notes give way to new ones.
    """

    def __init__(self) -> None:
        self._levels: dict[str, Level] = {}
        self._noted: dict[tuple[str, str, int], Event] = {}
        self.events: Sequence[Event] = ()
        """All notes by time; the same sequence until something changes."""

    def note(self, at_ns: int, rows: Sequence[Row]) -> None:
        """Compare displays with the last call.

        Args:
            at_ns: position in the recording.
            rows: all displays; groups are ignored, since they repeat what is in them.
        """
        rows = [row for row in rows if row.type != "Group"]
        worst = {row.id: _worst(row) for row in rows}
        before, self._levels = self._levels, {id: status.level for id, status in worst.items()}
        noted = {key: event for key, event in self._noted.items() if key[0] in self._levels}
        for row in rows:
            status = worst[row.id]
            # A problem from the beginning is of the config, not of a moment of the recording.
            if status.level < Level.WARN or status.level <= before.get(row.id, status.level):
                continue
            event = Event(at_ns, status.level, row.name, status.text)
            noted.setdefault((row.id, status.text, at_ns // SECOND_NS), event)
        if noted.keys() != self._noted.keys():
            self._noted = dict(list(noted.items())[-MAX_EVENTS:])
            self.events = tuple(sorted(self._noted.values(), key=lambda event: event.at_ns))


def _worst(row: Row) -> Status:
    return worst_status(status for key, status in row.statuses.items() if key != LOADING)


MIN_RATE, MAX_RATE = 0.01, 1000.0
LIVE = "Nothing to play while live. Seek back first."


class PlaybackFeature(Feature):
    """Plays, seeks and steps."""

    name = "Playback"
    module = "playback.js"

    def __init__(self, context: PartContext) -> None:
        super().__init__(context)
        self._time = context.get(TimePart)
        self._settings = context.get(SettingsPart)
        self._first_history = self._history = context.player.history
        self._first_events = self._display_events = DisplayEvents()
        self._leader: int | None = None
        """The browser that looked back last, None for a program."""

    def update(self) -> None:
        """Note which displays began to warn at the position."""
        player = self.context.player
        if player.history is not self._history:
            is_first = player.history is self._first_history
            self._display_events = self._first_events if is_first else DisplayEvents()
            self._history = player.history
        # On the way to a position, and before the first message, displays lack their messages.
        if not player.is_seeking and player.reached_ns >= player.history.start_ns:
            self._display_events.note(player.position_ns, self.context.get(DisplaysPart).rows)

    def state(self) -> Mapping[str, Any]:
        """Return when displays began to warn, as far as it was shown, by time."""
        return {"warned": self._display_events.events}

    # Stores

    @property
    def playback(self) -> PlaybackState | None:
        """The recording or the memory, as of the last turn."""
        return self._time.playback

    @property
    def recorded(self) -> Mapping[str, Sequence[int]]:
        """Counts of its messages in equal parts of its span, by topic."""
        return self._time.recorded

    @property
    def events(self) -> tuple[int | None, Sequence[Event], Sequence[Event], Sequence[Event]]:
        """The start of the recording, and what was logged, of displays, and found by the doctor."""
        start_ns = self.playback.start_ns if self.playback else None
        warned = self._display_events.events
        return start_ns, self._time.logged, warned, self.context.fact("found", ())

    @store(name="playback")
    def playback_store(self, argument: str) -> PlaybackStore | None:
        """Return the recording or the memory, None without either."""
        if self.playback is None:
            return None
        memory_s = self._settings.settings.memory.seconds
        return playback_store(self.playback, memory_s, self._time.times.wall_s, self._leader)

    @store()
    def bookmarks(self, argument: str) -> BookmarksStore | None:
        """Return the bookmarks of this recording."""
        recording = self.playback
        return recording and bookmarks_store(recording, self._settings.settings.bookmarks)

    @store(of=lambda part: (part.recorded and counted(part.playback), part.recorded))
    def density(self, argument: str) -> DensityStore:
        """Return counts of all messages."""
        return density_store(self.playback, self.recorded)

    @store(name="recorded", of=lambda part: part.recorded)
    def recorded_by_topic(self, argument: str) -> RecordedStore:
        """Return counts of messages by topic."""
        return RecordedStore(self.recorded)

    @store(name="events", of=lambda part: part.events)
    def events_in_recording(self, argument: str) -> EventsStore | None:
        """Return warnings and errors in the recording; None without one."""
        start_ns, *events = self.events
        if start_ns is None:
            return None
        return EventsStore(*(events_of(each, start_ns) for each in events))

    # Commands

    @command(Role.OPERATOR)
    def play(self) -> None:
        """Play from the position, at the end of the span from its start; `Pause` stops it."""
        player = self._time.known_player()
        if player.is_live:
            raise Error(LIVE)
        player.play()

    @command(Role.OPERATOR)
    def seek(self, at_s: float, sender: Sender) -> str:
        """Show the recording at a time; answered when the scene shows it."""
        player = self._time.known_player()
        self._leader = sender.browser
        player.seek(self._time.at_ns(at_s))
        return self._time.stop_vehicles()

    @command(Role.OPERATOR)
    def return_to_live(self) -> None:
        """Show what arrives again, instead of the past of live topics or a recording."""
        if self._time.known_player().return_to_live():
            self._time.start_over()

    @command(Role.OPERATOR)
    def set_rate(self, rate: float) -> None:
        """Set how fast to play: seconds of the recording per second, 0 is as fast as possible."""
        player = self._time.known_player()
        if rate and not MIN_RATE <= rate <= MAX_RATE:
            raise Error(
                f"The rate {rate:g} is out of range. Give {MIN_RATE:g} to {MAX_RATE:g}, or 0 for "
                "as fast as possible."
            )
        player.rate = rate or math.inf

    @command(Role.OPERATOR)
    def set_loop(self, loop: bool = True) -> None:
        """Choose whether the span starts over at its end."""
        self._time.known_player().loop = loop

    @command(Role.OPERATOR)
    def select_span(self, first_s: float | None = None, last_s: float | None = None) -> None:
        """Choose the part of the recording to play; without times, all of it.

        Args:
            first_s: its start, None for that of the recording.
            last_s: its end, None for that of the recording.
        """
        player, at_ns = self._time.known_player(), self._time.at_ns
        history = player.history
        if first_s is None and last_s is None:
            player.selected = None
            return
        first_ns = history.start_ns if first_s is None else at_ns(first_s)
        last_ns = history.end_ns if last_s is None else min(at_ns(last_s), history.end_ns)
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
        player = self._time.known_player()
        try:
            topic = player.resolve(topic) if topic else ""
        except ValueError as error:
            raise Error(f"{error}.") from error
        if not player.step(topic, is_forward):
            where = "next" if is_forward else "previous"
            what = f"message on {topic}" if topic else "message of a displayed topic"
            raise Error(f"There is no {where} {what}. Step in the other direction.")
        self._leader = sender.browser
        return self._time.stop_vehicles()

    @command(Role.OPERATOR)
    def save_bookmark(self, name: str, at_s: float | None = None) -> None:
        """Give a moment of the recording a name, in place of a moment of that name.

        Args:
            name: of the bookmark.
            at_s: the moment, None for the position.
        """
        player = self._time.known_player()
        if problem := problem_of(name):
            raise Error(problem)
        end_ns = player.history.end_ns
        at_ns = player.position_ns if at_s is None else min(self._time.at_ns(at_s), end_ns)
        bookmarks = {**self._settings.settings.bookmarks, name: at_ns / 1e9}
        self._settings.set("bookmarks", bookmarks)

    @command(Role.OPERATOR)
    def remove_bookmark(self, name: str) -> None:
        """Remove a bookmark."""
        bookmarks = dict(self._settings.settings.bookmarks)
        if bookmarks.pop(name, None) is None:
            raise Error(f"Unknown bookmark `{name}`: {nearest(name, bookmarks)}")
        self._settings.set("bookmarks", bookmarks)
