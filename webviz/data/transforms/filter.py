"""Messages waiting for the pose of their frame: tf2's MessageFilter without callbacks."""

from __future__ import annotations

from collections import Counter, deque
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Generic, TypeVar

from webviz.data.transforms.buffer import TransformBuffer
from webviz.data.transforms.errors import TransformException
from webviz.data.transforms.explain import explain
from webviz.data.transforms.geometry import is_within_reach
from webviz.data.transforms.reasons import Explanation, Kind, in_words
from webviz.data.transforms.records import Transform
from webviz.data.words import joined

P = TypeVar("P")

MAX_BYTES = 64 << 20
"""Limit in bytes of the messages that wait; the newest waits, however large."""


@dataclass(slots=True)
class _Waiting(Generic[P]):
    payload: P
    frame: str
    stamp_ns: int
    duration_ns: int
    size: int
    is_passed: bool = False
    """True if a newer message of its frame that arrived later became ready."""

    def stamps(self) -> tuple[int, ...]:
        """Return the times at which a transform is needed."""
        if self.duration_ns and self.stamp_ns:
            return self.stamp_ns, self.stamp_ns + self.duration_ns
        return (self.stamp_ns,)


class MessageFilter(Generic[P]):
    """Holds messages back until the fixed frame can be reached from their frame at their stamp.

    Only messages that must wait enter the queue; when it is full, of messages or of bytes, the
    oldest is dropped. A newer message never replaces one that became ready. A zero stamp requests
    the latest transform.

    Args:
        queue_size: maximum number of waiting messages (RViz's Filter size).
    """

    def __init__(self, queue_size: int = 10) -> None:
        self._queue_size = max(queue_size, 1)
        self._new: list[_Waiting[P]] = []
        self._queue: deque[_Waiting[P]] = deque()
        self._drops: Counter[Kind] = Counter()
        self._given_up: _Waiting[P] | None = None
        self._drop_count = 0
        self._is_heavy = False
        """True if messages were given up for their bytes rather than their number."""
        self._tried: tuple[int, str] | None = None
        self._stuck_since: P | None = None

    @property
    def drops(self) -> Mapping[Kind, int]:
        """Messages dropped since the start or `clear`, by reason."""
        return self._drops

    @property
    def is_stuck(self) -> bool:
        """Return whether messages wait that no newer one has passed, or were given up since."""
        return self._longest() is not None or self._given_up is not None

    @property
    def stuck_since(self) -> P | None:
        """Return the first message since the last that became ready, None unless it is stuck."""
        return self._stuck_since if self.is_stuck else None

    def __len__(self) -> int:
        return len(self._queue) + len(self._new)

    def add(
        self,
        payload: P,
        frame: str,
        stamp_ns: int,
        now_ns: int = 0,
        duration_ns: int = 0,
        size: int = 0,
    ) -> None:
        """Add a message, which `ready` will try.

        Args:
            payload: returned by `ready`.
            frame: its frame id; one leading slash is stripped, as tf2's filter does.
            stamp_ns: its time; 0 means the latest.
            now_ns: the current ROS time; 0 if unknown.
            duration_ns: the transform must also exist this long after the stamp (of a scan).
            size: in bytes.
        """
        frame = frame.removeprefix("/")
        self._new.append(_Waiting(payload, frame, stamp_ns, duration_ns, size))

    def ready(self, buffer: TransformBuffer, fixed_frame: str, now_ns: int = 0) -> list[P]:
        """Return the messages that became transformable, in order of arrival."""
        state = (buffer.version, fixed_frame)
        waiting = [] if state == self._tried else list(self._queue)
        if waiting:
            self._queue.clear()
        self._tried = state
        payloads: list[P] = []
        first = self._stuck_since
        for message in (*waiting, *self._new):
            if not message.frame:
                self._give_up(message, Kind.EMPTY_FRAME)
            elif (pose := _pose(buffer, fixed_frame, message)) is not None:
                if is_within_reach((*pose.translation, *pose.rotation)):
                    payloads.append(message.payload)
                    self._pass(message)
                    first = None
                    continue
                self._give_up(message, Kind.OUT_OF_REACH)
            elif _is_too_old(buffer, fixed_frame, message):
                self._give_up(message, Kind.BEHIND)
            else:
                self._queue.append(message)
            if first is None and not message.is_passed:
                first = message.payload
        self._new.clear()
        if first is None and (longest := self._longest()) is not None:
            first = longest.payload
        self._stuck_since = first
        if payloads:
            self._given_up, self._drop_count, self._is_heavy = None, 0, False
        size = sum(message.size for message in self._queue)
        while len(self._queue) > self._queue_size or (len(self._queue) > 1 and size > MAX_BYTES):
            self._is_heavy = len(self._queue) <= self._queue_size
            oldest = self._queue.popleft()
            size -= oldest.size
            self._give_up(oldest, Kind.QUEUE_FULL)
        return payloads

    def explanation(
        self, buffer: TransformBuffer, fixed_frame: str, now_ns: int = 0
    ) -> Explanation | None:
        """Return why nothing is ready: of the message that waits longest, or was given up last.

        None if nothing waits, but what newer data has passed, and nothing was given up since a
        message last became ready.
        """
        message = self._longest() or self._given_up
        if message is None:
            return None
        reason = _why(buffer, fixed_frame, message, now_ns)
        caught_up = reason.kind == Kind.AVAILABLE or reason.is_catching_up
        if self._drop_count and caught_up:
            full = self._queue_full(buffer, fixed_frame, now_ns)
            reason = replace(full, frame=reason.frame, link=reason.link)
        if self._drop_count:
            given_up = (
                "1 message was" if self._drop_count == 1 else f"{self._drop_count} messages were"
            )
            if buffer.recorded:  # their number depends on where playing began
                given_up = "Earlier ones were"
            reason = replace(reason, sentence=joined(reason.sentence, f"{given_up} given up."))
        return reason

    def clear(self) -> None:
        """Forget all messages and counts, as after a jump of time."""
        self._new.clear()
        self._queue.clear()
        self._drops.clear()
        self._given_up, self._drop_count, self._tried = None, 0, None
        self._is_heavy = False
        self._stuck_since = None

    def _pass(self, ready: _Waiting[P]) -> None:
        """Mark what waits although newer data of its frame shows, such as a topic's first."""
        for message in self._queue:
            if message.frame == ready.frame and 0 < message.stamp_ns < ready.stamp_ns:
                message.is_passed = True

    def _longest(self) -> _Waiting[P] | None:
        """Return the message that waits longest, and that no newer one has passed."""
        return next((message for message in self._queue if not message.is_passed), None)

    def _give_up(self, message: _Waiting[P], kind: Kind) -> None:
        self._drops[kind] += 1
        self._drop_count += 1
        self._given_up = message

    def _queue_full(self, buffer: TransformBuffer, fixed_frame: str, now_ns: int) -> Explanation:
        """Return whether transforms arrive, but later than the queue can wait."""
        if self._is_heavy:
            return Explanation(
                Kind.QUEUE_FULL,
                f"{MAX_BYTES >> 20} MB of messages wait before their transforms arrive: speed up "
                "what publishes them, or send smaller messages.",
            )
        text = f"The queue of {self._queue_size} messages is full before their transforms arrive"
        remedy, size = "raise the filter size", 0
        if len(self._queue) > 1:
            newest = self._queue[-1]
            lag = _why(buffer, fixed_frame, newest, now_ns).lag_ns
            period = (newest.stamp_ns - self._queue[0].stamp_ns) / (len(self._queue) - 1)
            if lag > 0 and period > 0:
                text = f"{text}, which are {in_words(lag)} late"
                size = int(lag / period) + 2
                remedy = f"{remedy} to {size}"
        sentence = f"{text}: {remedy}, or speed up what publishes them."
        return Explanation(Kind.QUEUE_FULL, sentence, filter_size=size)


def _why(
    buffer: TransformBuffer, fixed_frame: str, message: _Waiting[P], now_ns: int
) -> Explanation:
    """Return why a message waits: the reason for the first of its stamps without a transform."""
    reasons = [explain(buffer, fixed_frame, message.frame, t, now_ns) for t in message.stamps()]
    return next((r for r in reasons if r.kind != Kind.AVAILABLE), reasons[0])


def _pose(buffer: TransformBuffer, fixed_frame: str, message: _Waiting[P]) -> Transform | None:
    """Return the pose of a message at its stamp, None unless it has one at all its stamps."""
    try:
        poses = [buffer.lookup(fixed_frame, message.frame, t) for t in message.stamps()]
    except TransformException:
        return None
    return poses[0]


def _is_too_old(buffer: TransformBuffer, fixed_frame: str, message: _Waiting[P]) -> bool:
    """Return whether a transform for it can no longer arrive (tf2's rule)."""
    try:
        newest = buffer.latest_common_time(fixed_frame, message.frame)
    except TransformException:
        return False
    return 0 != message.stamp_ns < newest - buffer.cache_time_ns
