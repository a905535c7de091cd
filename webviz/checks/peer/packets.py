"""Packets that do not arrive."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding, Severity
from webviz.api.observation import Observation


class PacketsBlocked(Check):
    """UDP does not arrive.

    None of the UDP packets that one machine sends to the other arrives on the ports of DDS, though
    ssh does.

    Why:
        A firewall drops them, or a VPN or NAT forwards TCP only. DDS needs UDP on the ports 7400 to
        7649 of domain 0, and 250 more for each domain, in both directions.

    Repair:
        Allow UDP from the other machine:

            sudo ufw allow proto udp from 192.168.1.20
    """

    id = "NET020"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each direction."""
        if observation.ends is None:
            return
        for link, sender, receiver in observation.ends.links():
            if link.addresses:
                continue
            from_ = next(
                (a for each in sender.interfaces if not each.is_loopback for a in each.addresses),
                "",
            )
            yield self.found(
                f"No UDP packet from {sender.host} arrives at {receiver.host}.",
                f"Allow UDP from {sender.host} in the firewall of {receiver.host}.",
                subject=f"{sender.host} to {receiver.host}",
                severity=Severity.ERROR,
                evidence={"from": sender.host, "to": receiver.host, "tried": tuple(link.tried)},
                command=f"sudo ufw allow proto udp from {from_}" if from_ else "",
            )
