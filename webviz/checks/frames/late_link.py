"""Transforms that come more rarely than the data."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.data.transforms import FrameReport
from webviz.data.transforms.diagnosis import report
from webviz.data.transforms.tree import ancestors

SLOW_HZ, FEWEST = 2.0, 3
"""A transform at this rate delays data by half a second and more; samples that show a rate."""


class LateLink(Check):
    """Transform slower than the data.

    A transform on the way to the fixed frame is published at 2 Hz or less, and the data comes at
    more than twice that rate.

    Why:
        A message waits for a transform that is not older than itself. So everything that is drawn
        with this one lags behind by up to its period.

    Repair:
        Raise the rate of its publisher (`transform_publish_period` of slam_toolbox, `publish_rate`
        of the odometry), or let it stamp ahead (`transform_tolerance` of AMCL).
    """

    id = "TF019"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each link that is slower than a topic."""
        tree = observation.buffer.tree
        fixed = {*ancestors(tree, observation.fixed_frame)}
        for display, each in observation.inputs():
            links = {*ancestors(tree, each.frame)} ^ fixed if each.frame else set[str]()
            reports = [
                report(observation.buffer, link, observation.now_ns)
                for link in links & tree.caches.keys()
            ]
            slow = [link for link in reports if _is_slow(link) and each.rate_hz > 2 * link.rate_hz]
            for link in slow:
                yield self.found(
                    f'The transform from "{link.parent}" to "{link.frame}" comes at '
                    f"{link.rate_hz:.1f} Hz, {each.topic} at {each.rate_hz:.1f} Hz.",
                    "Raise the rate of its publisher, or let it post-date its transforms.",
                    subject=link.frame,
                    evidence={
                        "link": link.frame,
                        "rate_hz": round(link.rate_hz, 3),
                        "topic": each.topic,
                        "topic_hz": round(each.rate_hz, 3),
                    },
                    command=f"ros2 run tf2_ros tf2_monitor {observation.fixed_frame} {link.frame}",
                    explains=display.symptom("Transform"),
                )


def _is_slow(link: FrameReport) -> bool:
    is_ahead = link.delay_ns is None or link.delay_ns < 0
    is_moving = not link.is_static and link.samples >= FEWEST
    return is_moving and 0.0 < link.rate_hz <= SLOW_HZ and not is_ahead
