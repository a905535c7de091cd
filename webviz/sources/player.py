"""The owner of time: live topics as they arrive, or a moment of a history."""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence

from webviz.api.bridge import Bridge
from webviz.sources.graph import Graph, ReadOnly
from webviz.sources.history import History, Playhead
from webviz.sources.inbox import PAST_LIMIT, Inbox
from webviz.sources.recording.memory import MEMORY_OFF, MemoryHistory
from webviz.sources.source import Offer, Subscription

NEARLY_NS = 150_000_000
"""Time in ns before now at which playing becomes live: what arrived until then is in memory."""
NEAR_NS = 1_000_000_000
"""A position this far ahead is played to; one that is further on or back is looked up."""
END_NS = 2**63
"""A position after all others."""
MAX_STEP_S = 0.25
"""Wall time that one step makes up for: playing slows down where drawing is slow."""
RETURNING_S = 3.0
"""Time in seconds after which topics are live although displays have not caught up: they may never,
if more comes than they can take. Of what was missed, queues drop what they would of live topics."""
READ_ONLY = ReadOnly("A bag is read-only. Connect to a live ROS graph to publish.")


class Player:
    """A source of messages at a time that people choose.

    Live topics go to the inbox, or, while the past is shown, to the memory only, and the messages
    of a history to the inbox. `advance` plays in step with wall time; `play_until`, `play_step` and
    `jump` do so by hand, for pictures and tests. Times are times of recording in ns since 1970.
    Only the frame loop calls its methods.

    Args:
        history: to play; of the memory of live topics, these are shown first.
        read_only: refuses output if there are no live topics.
    """

    def __init__(self, history: History, read_only: Graph = READ_ONLY) -> None:
        self._read_only = read_only
        self.memory = history if isinstance(history, MemoryHistory) else None
        """History of live topics."""
        self.live = live = self.memory.live if self.memory else None
        self.inbox = live.inbox if live else Inbox()
        """The messages to show."""
        self.rate = 1.0
        """Seconds of the recording per second; infinity is as fast as possible."""
        self.loop = False
        """True if the span starts over at its end."""
        self.selected: tuple[int, int] | None = None
        """The first and the last position to play; None plays all."""
        self.is_ready = False
        """True to play as soon as a browser is connected, until a user plays or pauses."""
        self.history = history
        """Shown, unless topics are live."""
        history.wake = self.inbox.arrived.set
        self.is_playing = False
        """True while the position moves on."""
        self._target_ns: int | None = None
        self._has_to_jump = False
        self._is_returning, self._returns_s = False, 0.0
        """True while topics become live again, and when they are at the latest."""
        self._stepped_s, self._offset_ns = 0.0, 0
        self.subscriptions: dict[str, Subscription] = {}
        """Subscriptions by topic; another object only after a change."""
        self._playhead = None if live else self._new_playhead()
        """None while topics are live."""

    # What is shown

    @property
    def absence(self) -> str:
        """Reason why there is no past to play, in sentences; "" if there is one."""
        has_none = self._playhead is None and self.memory and not self.memory.recent.is_on
        return MEMORY_OFF if has_none else ""

    @property
    def is_opened(self) -> bool:
        """Return whether a recording is shown in the place of live topics."""
        return self.memory is not None and self.history is not self.memory

    @property
    def is_live(self) -> bool:
        """Return whether what arrives is shown, and nothing else is approached."""
        return self._playhead is None and not self.is_seeking

    @property
    def is_seeking(self) -> bool:
        """Return whether a position is being approached; until then there is nothing to draw."""
        return self._target_ns is not None

    @property
    def span_ns(self) -> tuple[int, int]:
        """The first and the last position that is played."""
        return self.selected or (self.history.start_ns, self.history.end_ns)

    @property
    def position_ns(self) -> int:
        """The position that is shown, or that is being approached."""
        position_ns = self.reached_ns if self._target_ns is None else self._target_ns
        return max(position_ns, self.history.start_ns)

    @property
    def reached_ns(self) -> int:
        """Time until which all was delivered: now while live, before the start at first."""
        return self.history.end_ns if self._playhead is None else self._playhead.position_ns

    @property
    def next_ns(self) -> int:
        """Time of the next message of the subscriptions; that of the end after the last one."""
        return self.history.end_ns if self._playhead is None else self._playhead.next_ns

    @property
    def warnings(self) -> Sequence[str]:
        """Sentences on what is missing, unusual or damaged, for people."""
        return self.history.warnings(self.subscriptions)

    def clock(self) -> float:
        """Seconds that were played: monotonic, for ages and rates."""
        return (self.reached_ns + self._offset_ns) / 1e9

    # Playing in step with wall time

    def play(self) -> None:
        """Play on, at the end of the span from its start."""
        self.is_playing, self.is_ready = True, False
        self._stepped_s = time.monotonic()
        first_ns, last_ns = self.span_ns
        if not first_ns - 1 <= self.position_ns < last_ns:
            self.seek(first_ns)

    def pause(self) -> None:
        """Stay at the position."""
        self.is_playing = self.is_ready = False

    def seek(self, at_ns: int) -> None:
        """Approach a position; `advance` until `is_seeking` is False.

        The end of a memory is now, where topics are live again.
        """
        # Displays of a bag catch up first however long that takes, as it has no now to miss.
        self._is_returning = self.history.is_growing and at_ns >= self.history.end_ns
        self._returns_s = time.monotonic() + RETURNING_S
        at_ns = min(max(at_ns, self.history.start_ns), self.history.end_ns)
        if self._playhead is None and self._is_returning:
            self._target_ns = None
            return
        self._target_ns = at_ns
        self._has_to_jump = self._playhead is None or not 0 <= at_ns - self.reached_ns <= NEAR_NS

    def step(self, topic: str, is_forward: bool) -> bool:
        """Approach the next or previous message of a topic; whether there is one.

        Args:
            topic: full name; "" is every subscribed topic but those of transforms and time.
            is_forward: the next message later than the position, or else the last one earlier.
        """
        self.pause()
        playhead = self._playhead
        is_live = playhead is None and self.memory is not None and self.memory.hold()
        if is_live and self.memory is not None:
            playhead = self._new_playhead()
            playhead.position_ns = self.memory.last_ns
        at_ns = playhead and playhead.neighbour(topic, is_forward)
        if is_live and self.memory is not None:
            self.memory.release()
        if at_ns is not None:
            self.seek(at_ns)
        return at_ns is not None

    def return_to_live(self) -> bool:
        """Show what arrives again, after all that was missed of it; nothing happens for a bag.

        Returns:
            Whether all received data must be discarded, since a recording was closed.
        """
        before_ns, was_opened = self.reached_ns, self.is_opened
        if was_opened and self.memory is not None:
            self._replace(self.memory)
            self._jump(self.memory.end_ns)
            self._offset_ns += before_ns - self.reached_ns
        if not self.is_live:
            self.seek(END_NS)
        return was_opened

    def show(self, history: History) -> None:
        """Show a recording in the place of live topics, at its start.

        The caller discards all received data. Live topics stay subscribed to, and are remembered.
        """
        before_ns = self.reached_ns
        if self.memory is not None:
            self.memory.release()
        self.inbox.divert()
        self.inbox.drain()
        self._replace(history)
        self._playhead = self._new_playhead()
        self._offset_ns += before_ns - self.reached_ns

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
            self._has_to_jump = False  # once for all positions that were asked for meanwhile
            self.jump(self._target_ns)
            return True
        if self._target_ns is not None:
            self._approach(self._target_ns, is_overdue)
        elif self.is_playing and self._playhead is not None:
            self._play_on(passed_s)
        return False

    # Playing by hand

    def play_until(self, until_ns: int) -> None:
        """Deliver everything recorded until a time, or a part of it that the inbox can hold.

        `reached_ns` says how far that is; the next call continues.

        Raises:
            BagError: the file can no longer be read.
        """
        if self._playhead is not None:
            self._playhead.play(self._recorded_ns(until_ns))
            self.inbox.arrived.set()

    def play_step(self, until_ns: int) -> None:
        """Play a short step towards a time, or up to the next message if that is later.

        Raises:
            BagError: the file can no longer be read.
        """
        if self._playhead is not None:
            self._playhead.play_step(self._recorded_ns(until_ns))
            self.inbox.arrived.set()

    def jump(self, at_ns: int) -> None:
        """Go at once to where playing leads to a position.

        Messages that wait in the inbox are discarded; the caller discards all other received data.

        Raises:
            BagError: the file can no longer be read.
        """
        before_ns = self.reached_ns
        self._jump(at_ns)
        self._offset_ns += max(0, before_ns - self.reached_ns)

    # The interface of webviz.sources.Source

    @property
    def graph(self) -> Graph:
        """Graph for output, which the restricted graph refuses while the past is shown."""
        return self.live.graph if self.live else self._read_only

    @property
    def bridges(self) -> Sequence[Bridge]:
        """Bridges of live topics; a recording needs none."""
        return self.live.bridges if self.live else ()

    def want(self, subscriptions: Mapping[str, Subscription]) -> None:
        """Make the subscriptions exactly these, also of live topics while the past is shown.

        Meanwhile, these are not asked to repeat what is latched: the memory has it.
        """
        before = self.subscriptions
        is_same = subscriptions == before
        if is_same:
            before.update(subscriptions)  # for their lookbacks, which do not count as a change
        else:
            self.subscriptions = dict(subscriptions)
        if self.memory is not None:
            self.memory.subscribe(self.subscriptions, is_live=self._playhead is None)
        elif not is_same:
            for topic in before.keys() - subscriptions.keys():
                self.inbox.close(topic)
            for topic in subscriptions.keys() - before.keys():
                self.inbox.open(topic, PAST_LIMIT)
        if self._playhead is not None:
            self._playhead.subscribe(self.subscriptions)

    def offers(self) -> Mapping[str, Offer]:
        """Return publishers and QoS by topic, of what is shown."""
        if self._playhead is None and self.live is not None:
            return self.live.offers()
        return self.history.offers(self.subscriptions)

    def now_ns(self) -> int:
        """ROS time of what is shown."""
        return playing.now_ns() if (playing := self._playhead or self.live) else 0

    def clock_messages(self) -> int | None:
        """Return the number of live /clock messages; those of a recording are not counted."""
        return self.live.clock_messages() if self.live and not self.is_opened else 0

    def resolve(self, topic: str) -> str:
        """Return the full name of a topic, also one that only a recording may have.

        Raises:
            ValueError: it is not a valid topic name.
        """
        try:
            return (self.live or self.history).resolve(topic)
        except ValueError:
            return self.history.resolve(topic)

    def close(self) -> None:
        """Close the recording and the live source."""
        self.history.close()
        if self.live is not None:
            self.live.close()

    # Internal

    def _replace(self, history: History) -> None:
        """Close an opened recording, and put a history in its place or in that of live topics."""
        if self.is_opened:
            self.history.close()
        self.history = history
        history.wake = self.inbox.arrived.set
        self._is_returning = False
        self._end_replay()

    def _jump(self, at_ns: int) -> None:
        if self._playhead is None and self.memory is not None:
            self.inbox.divert()
            if not self.memory.hold():
                self._become_live()
                return
            self._playhead = self._new_playhead()
        self.inbox.drain()
        if self._playhead is not None:
            self._playhead.seek(self._recorded_ns(at_ns))

    def _new_playhead(self) -> Playhead:
        playhead = Playhead(self.history, self.inbox.replay)
        playhead.subscribe(self.subscriptions)
        return playhead

    def _recorded_ns(self, at_ns: int) -> int:
        """Return a time, or the last one before it that is in memory for sure."""
        end_ns = self.history.end_ns
        return min(at_ns, end_ns - NEARLY_NS) if self.history.is_growing else at_ns

    def _approach(self, target_ns: int, is_overdue: bool) -> None:
        self.play_step(target_ns)
        is_live = self._is_returning and self._rejoin(is_overdue)
        if not is_live and self.reached_ns >= target_ns:
            end_ns = self.history.end_ns
            is_late = self._is_returning and self.reached_ns < end_ns
            self._target_ns = end_ns if is_late else None

    def _play_on(self, passed_s: float) -> None:
        first_ns, last_ns = self.span_ns
        if self._rejoin():
            return
        if self.reached_ns >= last_ns:
            if self.loop and first_ns < last_ns:
                self.seek(first_ns)
            else:
                self.pause()
        elif math.isinf(self.rate):
            self.play_step(last_ns)
        else:
            self.play_until(min(last_ns, self.reached_ns + round(passed_s * self.rate * 1e9)))

    def _rejoin(self, at_once: bool = False) -> bool:
        """Become live if the position is as good as now, or `at_once`; whether it is."""
        history = self.history
        is_near = at_once or history.end_ns - self.reached_ns <= 2 * NEARLY_NS
        if self._playhead is not None and history.is_growing and is_near:
            self._become_live()
        return self._playhead is None

    def _become_live(self) -> None:
        reached_ns = self._playhead and self._playhead.position_ns
        self._end_replay()
        if (memory := self.memory) is not None:
            self.inbox.rejoin(lambda: () if reached_ns is None else memory.since(reached_ns))
            memory.release()

    def _end_replay(self) -> None:
        self._playhead = self._target_ns = self.selected = None
        self.is_playing = False
