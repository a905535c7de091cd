"""The time that is shown, as in RViz's Time panel."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.errors import Error
from webviz.api.roles import Role
from webviz.api.status import Level, Status
from webviz.data.words import counted, joined
from webviz.engine.parts.declaring import command, store
from webviz.engine.parts.part import Batches, Part, PartContext
from webviz.engine.pipeline.clock_rate import ClockRateMeter, Rate
from webviz.engine.pipeline.ros_time import RosTime
from webviz.engine.state import PanelTimes
from webviz.engine.store import PageStore
from webviz.sources.history import History
from webviz.sources.past_state import Event, PlaybackState
from webviz.sources.player import END_NS, Player
from webviz.sources.recording.entries_history import EntriesHistory

BUCKETS = 500
"""Parts of the span whose messages are counted: about one for each three pixels of a wide page."""
REWOUND = "Nothing is sent to the robot while the page shows the past. Return to live first (L)."
STOPPED = "The vehicle was stopped, because the page shows the past."


class ClockStore(PageStore, frozen=True):
    """The times, in seconds.

    Args:
        pace: ROS time, wall time of the same moment, and how fast ROS time runs from there.
        began: both times at the start or the last reset.
        is_known: whether there is a ROS time.
        is_paused, is_simulated: see `webviz.engine.state.PanelTimes`.
        hz: rate of /clock to two digits.
    """

    pace: tuple[float, float, float]
    began: tuple[float, float]
    is_known: bool
    is_paused: bool
    is_simulated: bool
    hz: float


class TimePart(Part):
    """ROS time, which can be paused and can start over, and the moment of the past that is shown.

    Args:
        context: shared by all parts; its player is paused, or the inbox while topics are live.
        autoplay: play as soon as a browser is connected, so that the beginning is seen.
    """

    name = "Time"

    def __init__(self, context: PartContext, autoplay: bool = False) -> None:
        super().__init__(context)
        context.player.is_ready = autoplay and not context.player.is_live
        self._paused_ns: int | None = None
        self._time_rate = ClockRateMeter()
        self._clock_rate = Rate()
        self._start()
        self.missed = 0
        """Number of messages dropped while paused."""
        self.ros = RosTime(context.clock)
        """Detects that time went back."""
        self.times = PanelTimes()
        """Both clocks, as of the last turn."""
        self.playback: PlaybackState | None = None
        """The recording that is played, as of the last turn; None for live topics alone."""
        self.recorded: Mapping[str, Sequence[int]] = {}
        """Counts of its messages in equal parts of its span, by topic."""
        self.logged: Sequence[Event] = ()
        """Warnings and errors that its nodes logged, by time."""

    @property
    def is_paused(self) -> bool:
        """Return whether messages wait in the inbox."""
        return self._paused_ns is not None

    @property
    def shown_ns(self) -> int:
        """ROS time to show."""
        return self.context.now_ns if self._paused_ns is None else self._paused_ns

    @property
    def is_recording(self) -> bool:
        """Return whether a recording is shown, and no live topics or their past."""
        return self.playback is not None and self.playback.is_live is None

    def advance(self, is_busy: bool) -> None:
        """Play what is due, before the messages of a turn are taken.

        Args:
            is_busy: whether displays have to catch up first.
        """
        player = self.context.player
        if player.is_ready and self.context.is_watched():
            player.play()
        if player.advance(is_busy):
            self.start_over()

    def take(self, batches: Batches) -> None:
        """Remember where frames are while a seek passes them, since nothing is drawn."""
        if self.context.player.is_seeking:
            self.context.frames.pass_by()

    def update(self) -> None:
        """Read both clocks, and note the state of the player, and what is recorded when."""
        ros_ns, wall_s = self.context.frames.now_ns, time.time()
        if not 0 < self._began_ns <= ros_ns:  # time may have gone back while paused
            self._began_ns = ros_ns
        messages = self.context.player.clock_messages()
        player, history = self.context.player, self.context.player.history
        is_paused = self.is_paused if player.is_live else not player.is_playing
        self.times = PanelTimes(
            ros_ns,
            ros_ns - self._began_ns,
            wall_s,
            wall_s - self._began_s,
            is_paused,
            self._time_rate.step(ros_ns, wall_s, is_paused),
            messages is not None,
            self._clock_rate.step(messages or 0, self.context.clock()),
        )
        if player.absence:
            self.playback, self.recorded, self.logged = None, {}, ()
        else:
            self.recorded = history.histogram(BUCKETS)  # before the span that it counts is read
            self.playback, self.logged = _state_of(player), history.logged()

    @store()
    def clock(self, argument: str) -> ClockStore:
        """Return both clocks; changes only if one of them does not go on as before."""
        times = self.times
        clock_rate = times.clock_rate
        return ClockStore(
            pace=(clock_rate.ros_ns / 1e9, clock_rate.wall_s, clock_rate.rate),
            began=(
                round((times.ros_ns - times.ros_elapsed_ns) / 1e9, 3),
                round(times.wall_s - times.wall_elapsed_s, 3),
            ),
            is_known=times.ros_ns != 0,
            is_paused=times.is_paused,
            is_simulated=times.is_simulated,
            hz=float(f"{times.clock_hz:.2g}"),
        )

    def is_attended(self) -> bool:
        """Return whether a past is shown, whose position pages follow."""
        return not self.context.player.is_live

    def state(self) -> Mapping[str, Any]:
        """Return the time, the recording, the counts of its messages, and what was logged."""
        return {
            "clock": self.times,
            "playback": self.playback,
            "recorded": self.recorded,
            "logged": self.logged,
        }

    def statuses(self) -> Mapping[str, Status]:
        """Return whether time runs, and what is missing, unusual or damaged in the recording."""
        status = self.ros.status(self.context.offers)
        if self.is_paused and self.missed and not status:
            text = f"{counted(self.missed, 'message')} dropped while paused; the newest are kept."
            status = Status(Level.OK, text)
        warnings = self.context.player.warnings
        bag = {"Bag": Status(Level.WARN, joined(*warnings))} if warnings else {}
        return {"Time": status, **bag} if status else bag

    def reset(self) -> None:
        """Restart elapsed time."""
        self._start()

    def start_over(self) -> None:
        """Discard all received data, since another position is played from now on."""
        self._paused_ns = None
        self.context.buffer.forget()  # also static transforms that come later in the recording
        self.context.reset()
        self.ros.restart(self.context.player.now_ns())

    def known_player(self) -> Player:
        """Return the player.

        Raises:
            Error: there is no past to play; with the reason.
        """
        if absence := self.context.player.absence:
            raise Error(absence)
        return self.context.player

    def at_ns(self, seconds: float) -> int:
        """Return a position of what people count as seconds, not before the first message.

        Raises:
            Error: there is no past to play, or the time is NaN.
        """
        history = self.known_player().history
        if math.isnan(seconds):
            raise Error("NaN is not a valid time. Give seconds from the start of the recording.")
        origin_ns, end_ns = history.origin_ns, history.end_ns
        first_s, last_s = ((each - origin_ns) / 1e9 for each in (history.start_ns, END_NS))
        at_ns = origin_ns + round(min(max(seconds, first_s), last_s) * 1e9)
        # Seconds of a recording of years are not accurate to a nanosecond.
        return end_ns if seconds == (end_ns - origin_ns) / 1e9 else at_ns

    def show(self, history: History) -> str:
        """Play a recording in the place of live topics; a sentence if vehicles had to stop."""
        self.context.player.show(history)
        self.start_over()
        self.context.player.play()
        return self.stop_vehicles()

    def stop_vehicles(self) -> str:
        """Stop vehicles whose drivers see the past from now on; a sentence if any moved."""
        is_past = not self.context.player.is_live
        return STOPPED if is_past and self.context.controllers.halt() else ""

    def close(self) -> None:
        """Close the recording that is shown in the place of live topics."""
        if self.context.player.is_opened:
            self.context.player.history.close()

    def _start(self) -> None:
        self._began_ns = 0  # set when ROS time is known
        self._began_s = time.time()

    @command(Role.OPERATOR, name="Reset")
    def reset_viewer(self) -> None:
        """Discard transforms and messages, as RViz's Reset does."""
        self.context.reset()

    @command(Role.OPERATOR)
    def pause(self, paused: bool = True) -> None:
        """Pause or resume; messages wait while paused."""
        player = self.context.player
        if player.is_live:
            self._paused_ns = self.context.frames.now_ns if paused else None
        elif paused:
            player.pause()
        else:
            player.play()


def _state_of(player: Player) -> PlaybackState:
    history = player.history
    start_ns = history.origin_ns
    return PlaybackState(
        names=tuple(history.names),
        start_ns=start_ns,
        end_ns=history.end_ns,
        first_s=(history.start_ns - start_ns) / 1e9,
        is_live=player.is_live if history.is_growing else None,
        is_memory=isinstance(history, EntriesHistory),
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
