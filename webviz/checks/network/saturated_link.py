"""Interfaces that carry all that they can."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation
from webviz.checks.network.bridges import NAMES

FULL = 0.9
"""Share of the speed that hardly leaves room for anything else."""
MANY = 0.02
"""Share of packets that is too much to lose."""


class SaturatedLink(Check):
    """Saturated link.

    An interface of the network carries nearly as much as its speed allows, or drops packets that it
    cannot send.

    Why:
        Clouds and raw images take more than 100 Mbit/s, and one that is sent to two machines takes
        twice that. What does not fit is delayed or lost, transforms and scans with it. Wi-Fi
        drivers do not report their speed, so only the packets that they drop are seen.

    Repair:
        Subscribe to fewer clouds and images over this link, compress them (`image_transport`,
        `point_cloud_transport`), or use a faster one. See which topics take most with the tab
        Topics, or

            ros2 topic bw /points
    """

    id = "NET012"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such interface."""
        interfaces = observation.environment.interfaces if observation.environment else ()
        for each in interfaces:
            if each.is_loopback or each.name.startswith(NAMES):
                continue
            if each.load >= FULL:
                cause = f"{each.name} is saturated: {100 * each.load:.0f} % of its speed is used."
            elif each.dropped >= MANY:
                cause = (
                    f"{each.name} is saturated: it drops {100 * each.dropped:.0f} % of the packets."
                )
            else:
                continue
            yield self.found(
                cause,
                "Send fewer or smaller clouds and images over this link, or use a faster one.",
                subject=each.name,
                evidence={"load": round(each.load, 3), "dropped": round(each.dropped, 3)},
                command=f"ip -s link show {each.name}",
                explains=observation.unreceived(),
            )
