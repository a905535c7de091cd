"""Large messages that are not sent again."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import NO_OFFER, Observation

LARGE = 512 << 10


class LargeBestEffort(Check):
    """Large messages as best effort.

    Messages of more than 512 kB are published best effort. It is a note unless this machine loses
    datagrams or fragments of them.

    Why:
        Fast DDS cuts such a message into many datagrams, of which none is sent again. If one is
        lost, so is the message: the rate of a cloud drops to a fraction, or to nothing over Wi-Fi.

    Repair:
        Publish smaller messages (a voxel filter, fewer pixels, compression), or publish reliably.
        Between machines, allow larger buffers, too:

            sudo sysctl -w net.core.rmem_max=8388608
    """

    id = "NET013"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such topic."""
        environment = observation.environment
        if environment is None:
            return
        losses = environment.lost_datagrams + environment.lost_fragments
        for _, each in observation.inputs():
            publishers = observation.offers.get(each.topic, NO_OFFER).publishers
            is_repeated = any(p.reliability == "reliable" for p in publishers)
            if each.size <= LARGE or not publishers or is_repeated:
                continue
            yield self.found(
                f"Messages of {each.size >> 10} kB on {each.topic} are published best effort"
                + (f", and {losses} datagrams were lost here." if losses else "."),
                "Publish smaller messages, or publish them reliably.",
                subject=each.topic,
                severity=Severity.WARNING if losses else Severity.NOTE,
                evidence={"topic": each.topic, "bytes": each.size, "lost": losses},
                command=f"ros2 topic bw {each.topic}",
            )
