"""The state of a link to a bridge: its delays, losses and invalid frames, in sentences."""

from __future__ import annotations

import time
from collections.abc import Iterable, Sequence
from dataclasses import replace

from webviz.api.bridge import Bridge
from webviz.data.words import Problem, counted, joined, listed
from webviz.sources.bridge.backlog import BEHIND_S, LinkDelay, TopicBacklog
from webviz.sources.bridge.connection import STALLED_S
from webviz.sources.bridge.pacing import RateController
from webviz.sources.bridge.session import BridgeSession

DROPPED_S = 10.0
"""Duration for which dropped messages are reported."""
MOST = 5
"""Thinned topics that are named."""


def thinning(rate_controller: RateController) -> list[str]:
    """Return a sentence on the topics that are thinned; none if the link takes all."""
    rates = rate_controller.thinned(time.monotonic())
    if not rates:
        return []
    parts = listed([f"{topic} to {hz:.2g} Hz" for topic, hz in sorted(rates.items())], MOST)
    mbit = rate_controller.carried() * 8e-6
    return [f"The link carries {mbit:.2g} Mbit/s, so webviz thins {parts}."]


def described(
    before: Bridge,
    session: BridgeSession | None,
    problem: Problem | None,
    remarks: Iterable[str],
    silent_s: float,
    round_trip_s: float | None,
) -> Bridge:
    """Return a bridge as it is now.

    Args:
        before: as it was.
        session: that is open, None while the link is broken.
        problem: why it is broken, None if it is not.
        remarks: sentences about the open link.
        silent_s: seconds without any byte.
        round_trip_s: see `Bridge`.
    """
    is_up = session is not None and problem is None
    stall = f"Nothing came from the bridge for {silent_s:.0f} s. Check the network."
    stalls = [stall] if silent_s > STALLED_S else []
    return replace(
        before,
        protocol=session.protocol if session else before.protocol,
        is_up=is_up,
        was_up=before.was_up or is_up,
        problem="" if problem is None else problem.cause,
        remedy="" if problem is None else problem.remedy,
        remarks=(*stalls, *remarks, *session.remarks) if session and is_up else (),
        limits=tuple(session.limits) if session else before.limits,
        round_trip_s=round_trip_s,
        parameters=session.parameters if session else before.parameters,
    )


class LinkHealth:
    """Observations of one connection."""

    def __init__(self) -> None:
        self._malformed = 0
        self._malformation = ""
        self._delay = LinkDelay()
        self._backlogs: dict[str, TopicBacklog] = {}
        self._drops: dict[str, tuple[int, int, float]] = {}
        """Numbers of messages dropped before those to report, dropped in all, and when that grew,
        by topic."""

    def note_malformed(self, problem: str) -> None:
        """Note a frame that is not of the protocol."""
        self._malformed += 1
        self._malformation = problem

    def note_message(self, topic: str, stamp_ns: int, is_thinned: bool = False) -> float:
        """Note a message.

        Args:
            topic: of the message.
            stamp_ns: time at which the bridge received it.
            is_thinned: whether webviz takes some of the messages only, so that gaps say nothing.

        Returns:
            By how much it is later than the fastest, in seconds.
        """
        stamp_s = stamp_ns / 1e9
        delay_s = self._delay.note(stamp_s, time.monotonic())
        if is_thinned:
            self.forget(topic)
        else:
            self._backlogs.setdefault(topic, TopicBacklog()).note(stamp_s, delay_s)
        return delay_s

    def forget(self, topic: str) -> None:
        """Forget a topic that is no longer subscribed to."""
        self._backlogs.pop(topic, None)
        self._drops.pop(topic, None)

    def remarks(self) -> Sequence[str]:
        """Sentences about what is wrong, none if all is well."""
        remarks = self._late()
        if self._malformed:
            ignored = f"{counted(self._malformed, 'frame')} of the bridge ignored"
            remarks.append(joined(ignored, self._malformation))
        return remarks

    def _late(self) -> list[str]:
        """Return the messages that the bridge dropped, or else how late they come."""
        dropped = sorted(self._recent(), reverse=True)[:5]
        if dropped:
            parts = ", ".join(f"about {count} of {topic}" for count, topic in dropped)
            return [
                f"The link is slower than its topics: the bridge dropped {parts}. Hide displays of "
                "large messages, or publish less."
            ]
        late_s = max((each.delay_s for each in self._backlogs.values()), default=0.0)
        return (
            [f"Messages come {late_s:.1f} s late through the bridge."] if late_s > BEHIND_S else []
        )

    def _recent(self) -> list[tuple[int, str]]:
        """Return the number of messages that were dropped lately, by topic."""
        now_s, recent = time.monotonic(), []
        for topic, backlog in self._backlogs.items():
            before, total, at_s = self._drops.get(topic, (0, 0, 0.0))
            if backlog.dropped != total:
                total, at_s = backlog.dropped, now_s
            elif now_s - at_s > DROPPED_S:
                before = total
            self._drops[topic] = before, total, at_s
            if total > before:
                recent.append((total - before, topic))
        return recent
