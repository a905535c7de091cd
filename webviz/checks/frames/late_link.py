"""Transforms that come later than the data."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.transforms.reasons import Kind


class LateLink(Check):
    """Transform that lags behind.

    Data waits for a transform that arrives much later than the data does.

    Why:
        A transform that is published at a low rate, or after a long computation, delays everything
        that is drawn with it.

    Repair:
        Raise the rate of its publisher (`transform_publish_period` of slam_toolbox, `publish_rate`
        of the odometry), or let it stamp ahead (`transform_tolerance` of AMCL).
    """

    id = "TF019"

    def find(self, seen: Observation) -> Iterator[Finding]:
        """Yield a finding for each such frame."""
        for symptom, reason in seen.lost(Kind.AHEAD):
            if not (reason.is_catching_up):
                continue
            yield self.found(
                f'The transform of "{reason.link}" is {reason.lag_ns / 1e9:.1f} s behind the data.',
                "Raise the rate of its publisher.",
                subject=reason.link or reason.frame,
                severity=Severity.ERROR,
                evidence={
                    "frame": reason.frame,
                    "link": reason.link,
                    "lag_s": round(reason.lag_ns / 1e9, 3),
                },
                command=f"ros2 run tf2_ros tf2_echo {seen.fixed_frame} {reason.link}",
                explains=(symptom,),
            )
