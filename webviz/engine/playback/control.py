"""Playback of a recording, or of the past of live topics, in step with wall time."""

from __future__ import annotations

import math
import time
from collections.abc import Callable

from webviz.sources.playable import Playable

NEAR_NS = 1_000_000_000
"""A position this far ahead is played to; one that is further on or back is looked up."""
END_NS = 2**63
"""A position after all others."""
MAX_STEP_S = 0.25
"""Wall time that one step makes up for: playing slows down where drawing is slow."""
RETURNING_S = 3.0
"""After which topics are live although displays have not caught up: they may never, if more comes
than they can take. Of what was missed, queues drop what they would of live topics."""


class PlaybackControl:
    """Position, rate and span of what is played; moves on with each call of `advance`.

    Args:
        playback: what to play.
    """

    def __init__(self, playback: Playable) -> None:
        self.playback = playback
        self.rate = 1.0
        """Seconds of the recording per second; infinity is as fast as possible."""
        self.loop = False
        """True if the span starts over at its end."""
        self.selected: tuple[int, int] | None = None
        """The first and the last position to play; None plays all."""
        self.is_ready = False
        """True to play as soon as a browser is connected, until somebody plays or pauses."""
        self._is_playing = False
        self._target_ns: int | None = None
        self._is_returning = False
        self._returns_s = 0.0
        """When topics are live at the latest, if it is returning."""
        self._has_to_jump = False
        self._stepped_s = 0.0
        self._offset_ns = 0

    @property
    def is_playing(self) -> bool:
        """Return whether the position moves on by itself."""
        return self._is_playing

    @property
    def is_seeking(self) -> bool:
        """Return whether a position is being approached; until then there is nothing to draw."""
        return self._target_ns is not None

    @property
    def is_live(self) -> bool:
        """Return whether what arrives is shown, and nothing else is on its way."""
        return self.playback.is_live and self._target_ns is None

    @property
    def span_ns(self) -> tuple[int, int]:
        """The first and the last position that is played."""
        return self.selected or (self.playback.start_ns, self.playback.end_ns)

    @property
    def position_ns(self) -> int:
        """The position that is shown, or that is being approached."""
        shown = self.playback.position_ns if self._target_ns is None else self._target_ns
        return max(shown, self.playback.start_ns)

    def clock(self) -> float:
        """Seconds of the recording that were played: monotonic, for ages and rates."""
        return (self.playback.position_ns + self._offset_ns) / 1e9

    def play(self) -> None:
        """Play on, at the end of the span from its start."""
        self._is_playing, self.is_ready = True, False
        self._stepped_s = time.monotonic()
        first_ns, last_ns = self.span_ns
        if not first_ns - 1 <= self.position_ns < last_ns:
            self.seek(first_ns)

    def pause(self) -> None:
        """Stay at the position."""
        self._is_playing = self.is_ready = False

    def seek(self, at_ns: int) -> None:
        """Approach a position; `advance` until `is_seeking` is False.

        The end of live topics is now, so that they are live again.
        """
        playback = self.playback
        # Displays of a bag catch up first however long that takes, as it has no now to miss.
        self._is_returning = not playback.names and at_ns >= playback.end_ns
        self._returns_s = time.monotonic() + RETURNING_S
        at_ns = min(max(at_ns, playback.start_ns), playback.end_ns)
        if playback.is_live and self._is_returning:
            self._target_ns = None
            return
        self._target_ns = at_ns
        self._has_to_jump = playback.is_live or not 0 <= at_ns - playback.position_ns <= NEAR_NS

    def return_to_live(self) -> None:
        """Show what arrives again, after all that was missed of it; nothing happens for a bag."""
        if not self.is_live:
            self.seek(END_NS)

    def switch(self, change: Callable[[], Playable]) -> None:
        """Put another recording in the place of what is played; the clock goes on steadily.

        Args:
            change: shows the other recording, and returns it.
        """
        before_ns = self.playback.position_ns
        self.playback = change()
        self._offset_ns += before_ns - self.playback.position_ns
        self._end_replay()
        self._is_returning = self._has_to_jump = False

    def advance(self, is_busy: bool = False) -> bool:
        """Play what is due since the last call.

        Args:
            is_busy: whether displays have to catch up first.

        Returns:
            Whether all received data must be discarded, since another position is approached.
        """
        now_s = time.monotonic()
        passed_s = min(now_s - self._stepped_s, MAX_STEP_S)
        self._stepped_s = now_s
        is_overdue = self._is_returning and now_s > self._returns_s
        if is_busy and not is_overdue:
            return False
        if self._has_to_jump and self._target_ns is not None:
            self._jump(self._target_ns)
            return True
        if self._target_ns is not None:
            self.playback.play_step(self._target_ns)
            if self._is_returning and self.playback.rejoin(at_once=is_overdue):
                self._end_replay()
            elif self.playback.position_ns >= self._target_ns:
                end_ns = self.playback.end_ns
                is_late = self._is_returning and self.playback.position_ns < end_ns
                self._target_ns = end_ns if is_late else None
            return False
        if self._is_playing and not self.playback.is_live:
            self._play_on(passed_s)
        return False

    def _end_replay(self) -> None:
        self._target_ns = self.selected = None
        self._is_playing = False

    def _jump(self, at_ns: int) -> None:
        """Go to where playing leads to a position, once for all that were asked for meanwhile."""
        self._has_to_jump = False
        before_ns = self.playback.position_ns
        self.playback.seek(at_ns)
        self._offset_ns += max(0, before_ns - self.playback.position_ns)

    def _play_on(self, passed_s: float) -> None:
        playback = self.playback
        first_ns, last_ns = self.span_ns
        if playback.rejoin():
            self._end_replay()
        elif playback.position_ns >= last_ns:
            if self.loop and first_ns < last_ns:
                self.seek(first_ns)
            else:
                self.pause()
        elif math.isinf(self.rate):
            playback.play_step(last_ns)
        else:
            playback.play(min(last_ns, playback.position_ns + round(passed_s * self.rate * 1e9)))
