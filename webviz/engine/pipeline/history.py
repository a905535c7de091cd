"""The samples that a display holds of each input, and the slot in which each is drawn."""

from __future__ import annotations

import heapq
import itertools
import weakref
from collections.abc import Callable, Sequence
from dataclasses import replace

import msgspec

from webviz.api.display import Keep
from webviz.api.frames import Frames, compose
from webviz.api.nodes import Pose
from webviz.api.sample import Sample

MAX_SAMPLES = 10_000
"""Largest number of samples of a display, whatever its properties request."""
MAX_BYTES = 256_000_000
"""Limit in bytes of the serialised messages of all displays that hold several; the newest is,
however large."""


class HistoryBudget:
    """Limits the bytes of the messages that all displays hold."""

    def __init__(self) -> None:
        self._histories: weakref.WeakSet[SampleHistory] = weakref.WeakSet()

    def add(self, history: SampleHistory) -> None:
        """Count the samples of a history as long as it exists."""
        self._histories.add(history)

    def make_room(self) -> None:
        """Drop samples of the histories that hold most, the oldest first, until all fit."""
        histories = [history for history in self._histories if len(history.entries) > 1]
        excess = sum(history.bytes for history in histories) - MAX_BYTES
        for largest in sorted(histories, key=lambda history: -history.bytes):
            if excess <= 0:
                return
            excess -= largest.shrink(excess)


class BufferedSample(msgspec.Struct):
    """A sample and where it is drawn.

    Args:
        sample: the newest version of it.
        size: of its message, in bytes.
        slot: number of its scope; slots are reused, so that a stream of messages updates nodes
            instead of adding and removing them.
        has_pose: whether the sample has a pose in the current fixed frame.
    """

    sample: Sample
    size: int
    slot: int
    has_pose: bool = True


class SampleHistory:
    """Holds samples of one input in order of arrival, as many as the display requests.

    Args:
        budget: shared by the histories of all displays.
        inputs: number of inputs of the display, which share its limit of samples.
    """

    def __init__(self, budget: HistoryBudget, inputs: int = 1) -> None:
        self._max_samples = MAX_SAMPLES // inputs
        self._budget = budget
        budget.add(self)
        self.entries: list[BufferedSample] = []
        self.version = 0
        """Changes whenever the samples do."""
        self.bytes = 0
        """Bytes of the messages of all samples."""
        self._free: list[int] = []
        self._missed_ns: int | None = None
        """Arrival of the newest sample that was dropped for its size."""
        self._samples: list[Sample] | None = []
        """Cache of `samples`; never changed in place, as callers hold it."""

    def samples(self) -> Sequence[Sample]:
        """Return the samples that can be drawn, oldest first."""
        if self._samples is None:
            self._samples = [buffered.sample for buffered in self.entries if buffered.has_pose]
        return self._samples

    def add(self, sample: Sample, size: int, keep: Keep) -> None:
        """Hold a sample whose message has `size` bytes.

        Samples beyond `keep.count` or the limit of bytes are dropped first to free their slots.
        """
        self._drop(len(self.entries) - self._most(keep) + 1)
        slot = heapq.heappop(self._free) if self._free else len(self.entries)
        self.entries.append(BufferedSample(sample, size, slot))
        self.bytes += size
        self._samples = None if self._samples is None else [*self._samples, sample]
        self.version += 1
        if len(self.entries) > 1:
            self._budget.make_room()

    def shrink(self, size: int) -> int:
        """Drop the oldest samples, except the newest, until `size` bytes are free.

        Returns:
            The bytes that are free now.
        """
        count = freed = 0
        while freed < size and count < len(self.entries) - 1:
            self._missed_ns = self.entries[count].sample.received_ns
            freed += self.entries[count].size
            count += 1
        self._drop(count)
        return freed

    def shortage(self, keep: Keep, now_ns: int) -> str:
        """Return a sentence if samples within `keep` were dropped for their size, else ""."""
        if self._missed_ns is None or not self.entries or len(self.entries) >= self._most(keep):
            return ""
        limit = f"limit of {MAX_BYTES // 1_000_000} MB for all displays"
        if not keep.seconds:
            return f"Keeps {len(self.entries)} of {self._most(keep)} messages: {limit}."
        if self._missed_ns < now_ns - keep.seconds * 1e9:
            return ""
        span_s = (now_ns - self.entries[0].sample.received_ns) / 1e9
        return f"Keeps {span_s:.1f} of {keep.seconds:g} s: {limit}."

    def trim(self, keep: Keep, now_ns: int) -> None:
        """Drop samples beyond `keep`."""
        self._drop(len(self.entries) - self._most(keep))
        if keep.seconds:
            oldest = now_ns - round(min(keep.seconds * 1e9, 2**63))  # which may be infinite
            is_young = (buffered.sample.received_ns >= oldest for buffered in self.entries)
            self._drop(next((i for i, young in enumerate(is_young) if young), len(self.entries)))

    def _drop(self, count: int) -> None:
        """Drop the oldest samples; their slots are reused, the lowest first."""
        if count > 0:
            is_whole = self._samples is not None and len(self._samples) == len(self.entries)
            self._samples = self._samples[count:] if self._samples and is_whole else None
            for buffered in self.entries[:count]:
                heapq.heappush(self._free, buffered.slot)
                self.bytes -= buffered.size
            del self.entries[:count]
            self.version += 1

    def move(self, frames: Frames, former_fixed_frame: str, timed: Callable[[str], bool]) -> None:
        """Place all samples in a new fixed frame.

        Each at its own stamp; samples older than the transforms move with the former fixed frame.

        Args:
            frames: with the new fixed frame.
            former_fixed_frame: frame id.
            timed: False for inputs whose samples follow their frame instead of their stamp.
        """
        shift = frames.latest(former_fixed_frame)

        def moved(sample: Sample) -> Sample | None:
            if not timed(sample.input):
                pose = frames.now(sample.frame) or Pose()
            else:
                pose = frames.at(sample.frame, sample.stamp_ns) if sample.frame else sample.pose
            if pose is None and shift is not None and buffered.has_pose:
                pose = compose(shift, sample.pose)
            synced = {name: moved(other) for name, other in sample.synced.items()}
            complete = {name: other for name, other in synced.items() if other is not None}
            if pose is None or len(complete) < len(synced):
                return None
            return replace(sample, pose=pose, synced=complete)

        for buffered in self.entries:
            sample = moved(buffered.sample)
            buffered.has_pose = sample is not None
            buffered.sample = sample or buffered.sample
        self._samples = None
        self.version += 1

    def _most(self, keep: Keep) -> int:
        return min(keep.count or self._max_samples, self._max_samples)


Histories = dict[str, SampleHistory]
"""The histories of a display by input."""


def held_samples(histories: Histories) -> Sequence[Sample]:
    """Return the samples of all inputs that can be drawn, oldest first."""
    if len(histories) == 1:
        return next(iter(histories.values())).samples()
    every = (history.samples() for history in histories.values())
    return sorted(itertools.chain(*every), key=lambda sample: sample.received_ns)
