"""Packets that the path drops."""

from __future__ import annotations

from collections.abc import Iterator

from webviz.api.check import Check
from webviz.api.finding import Finding
from webviz.api.observation import Observation


class PathMtu(Check):
    """Path drops large packets.

    Packets as large as the interfaces allow do not arrive at the other machine.

    Why:
        A VPN, a tunnel or a bridge on the way takes smaller packets, and drops larger ones without
        telling the sender. Small messages arrive, while clouds and images do not.

    Repair:
        Lower the MTU of the interface on both machines to the size that arrives:

            sudo ip link set eth0 mtu 1400
    """

    id = "NET022"

    def find(self, observation: Observation) -> Iterator[Finding]:
        """Yield a finding for each direction."""
        if observation.ends is None:
            return
        for link, sender, receiver in observation.ends.links():
            if not link.addresses or link.packet >= link.mtu:
                continue
            name = link.interface or "eth0"
            yield self.found(
                f"Packets of more than {link.packet} bytes from {sender.host} do not arrive at "
                f"{receiver.host}, though the interfaces allow {link.mtu}.",
                f"Set the MTU of {sender.host} to {link.packet}.",
                subject=f"{sender.host} to {receiver.host}",
                evidence={
                    "arrives": link.packet,
                    "allowed": link.mtu,
                    "address": link.addresses[0],
                },
                command=f"sudo ip link set {name} mtu {link.packet}",
            )
