"""The health of a link to a bridge: its delays, losses and invalid frames, in sentences."""

from __future__ import annotations

import time
from collections.abc import Sequence

from webviz.data.words import counted, joined
from webviz.sources.bridge.backlog import BEHIND_S, LinkDelay, TopicBacklog

DROPPED_S = 10.0
"""Duration for which dropped messages are reported."""


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
        found = self._late()
        if self._malformed:
            ignored = f"{counted(self._malformed, 'frame')} of the bridge ignored"
            found.append(joined(ignored, self._malformation))
        return found

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
        now_s, found = time.monotonic(), []
        for topic, backlog in self._backlogs.items():
            before, total, at_s = self._drops.get(topic, (0, 0, 0.0))
            if backlog.dropped != total:
                total, at_s = backlog.dropped, now_s
            elif now_s - at_s > DROPPED_S:
                before = total
            self._drops[topic] = before, total, at_s
            if total > before:
                found.append((total - before, topic))
        return found
