"""Fragments that are lost on the way."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation
from webviz.data.words import counted

REMEDY = "sudo sysctl -w net.ipv4.ipfrag_time=3 net.ipv4.ipfrag_high_thresh=134217728"


class LostFragments(Check):
    """Fragments are lost.

    Datagrams arrive in part: some of their fragments are lost, or too many of them wait.

    Why:
        A message larger than a packet is cut into fragments. If one is lost, the whole datagram is,
        and the others wait for 30 s in a small memory, after which no large message arrives.

    Repair:
        Give the fragments more memory and less time, or send smaller datagrams:

            sudo sysctl -w net.ipv4.ipfrag_time=3 net.ipv4.ipfrag_high_thresh=134217728
    """

    id = "NET009"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each such machine."""
        fragments = observation.environment.lost_fragments if observation.environment else 0
        if fragments:
            explains = observation.unreceived()
            yield self.found(
                f"{counted(fragments, 'datagram')} arrived in part only: fragments were lost.",
                "Give fragments more memory and less time.",
                severity=Severity.WARNING if explains else Severity.NOTE,
                evidence={"lost": fragments},
                command=REMEDY,
                explains=explains,
            )
