"""Transforms that are no longer published."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.checks.frames.refused import is_refused
from webviz.data.transforms.reasons import Kind


class StoppedLink(Check):
    """Transform that has stopped.

    Data waits for a transform whose publisher has stopped sending.

    Why:
        Data is drawn with the transform at its stamp. If the publisher of one link stops,
        everything behind it stands still.

    Repair:
        Start the publisher of that link again.
    """

    id = "TF018"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in observation.unplaced(Kind.AHEAD, Kind.NO_DATA):
            if reason.is_catching_up or is_refused(observation, reason.link):
                continue
            frame = reason.link or reason.frame
            cache = observation.buffer.tree.caches.get(frame)
            is_single = cache is not None and not cache.is_static and len(cache) == 1
            yield self.found(
                f'Only one transform of "{frame}" has arrived.'
                if is_single
                else f'The transform of "{frame}" is no longer published.',
                "Check that its publisher still sends it."
                if is_single
                else "Start its publisher again.",
                subject=frame,
                severity=Severity.ERROR,
                evidence={"frame": reason.frame, "link": reason.link},
                command=f"ros2 run tf2_ros tf2_echo {observation.fixed_frame} {reason.link}",
                explains=(symptom,),
            )
