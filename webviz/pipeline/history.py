"""The samples a display holds, and the slot in which each is drawn."""

from __future__ import annotations

from dataclasses import dataclass, replace

from webviz.display import Keep
from webviz.frames import Frames, compose
from webviz.nodes import Pose
from webviz.sample import Sample

MAX_SAMPLES = 10_000
"""Of one display, whatever its properties say; nothing grows without a bound."""


@dataclass
class Held:
    """A sample and where it is drawn.

    Args:
        sample: the newest version of it.
        slot: number of its scope; free slots are used again, so that a stream of messages updates
            nodes instead of making and removing them.
        has_pose: whether the sample could be placed in the fixed frame of now.
    """

    sample: Sample
    slot: int
    has_pose: bool = True


class History:
    """Holds samples in order of arrival, as many as a display wants."""

    def __init__(self) -> None:
        self.held: list[Held] = []

    def samples(self) -> list[Sample]:
        """What can be drawn, oldest first."""
        return [held.sample for held in self.held if held.has_pose]

    def add(self, sample: Sample, keep: Keep) -> Held:
        """Hold a sample. What `keep.count` then excludes goes first, so that its slot is free."""
        count = min(keep.count or MAX_SAMPLES, MAX_SAMPLES)
        del self.held[: max(0, len(self.held) - count + 1)]
        used = {held.slot for held in self.held}
        slot = next(slot for slot in range(len(used) + 1) if slot not in used)
        held = Held(sample, slot)
        self.held.append(held)
        return held

    def trim(self, keep: Keep, now_ns: int) -> bool:
        """Let go of what is too much or too old; whether there was any."""
        before = len(self.held)
        count = min(keep.count or MAX_SAMPLES, MAX_SAMPLES)
        del self.held[: max(0, before - count)]
        if keep.seconds:
            oldest = now_ns - round(keep.seconds * 1e9)
            self.held = [held for held in self.held if held.sample.received_ns >= oldest]
        return len(self.held) != before

    def move(self, frames: Frames, former_fixed_frame: str, timed: bool) -> None:
        """Place all samples in a new fixed frame.

        Each at its own stamp; one older than the transforms goes along with the former fixed frame.

        Args:
            frames: know the new fixed frame.
            former_fixed_frame: frame id.
            timed: False if the samples' display follows their frame instead.
        """
        shift = frames.latest(former_fixed_frame)
        for held in self.held:
            sample = held.sample
            if not timed:
                pose = frames.now(sample.frame) or Pose()
            else:
                pose = frames.at(sample.frame, sample.stamp_ns) if sample.frame else sample.pose
            if pose is None and shift is not None and held.has_pose:
                pose = compose(shift, sample.pose)
            held.has_pose = pose is not None
            if pose is not None:
                held.sample = replace(sample, pose=pose)
