"""The interfaces of the network, and how much passes them."""

from __future__ import annotations

import socket
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

import psutil

from webviz.api.environment import Environment, InterfaceCounters, NetworkInterface

GROUP = "239.255.0.1"
"""Multicast group of DDS."""
IGMP = Path("/proc/net/igmp")
LEAST_S = 2.0
"""Least time in seconds between two looks; the use of a shorter time is a burst."""
LEAST_PACKETS = 100
"""Sent between two looks; of fewer, a share says nothing."""
BITS_PER_MBIT = 1_000_000


def traffic() -> Mapping[str, InterfaceCounters]:
    """Return what has passed each interface."""
    return {
        name: InterfaceCounters(each.bytes_sent, each.bytes_recv, each.packets_sent, each.dropout)
        for name, each in psutil.net_io_counters(pernic=True).items()
    }


def interfaces_since(
    passed: Mapping[str, InterfaceCounters], now_s: float, before: Environment | None
) -> Sequence[NetworkInterface]:
    """Return the interfaces that are up, with their use since a look before.

    Args:
        passed: what has passed them until now.
        now_s: monotonic time in seconds.
        before: the look before, None for the first one.
    """
    stats, addresses, hearing = psutil.net_if_stats(), psutil.net_if_addrs(), _hearing()
    seconds = now_s - before.at_s if before else 0.0
    nothing = InterfaceCounters(0, 0, 0, 0)
    interfaces: list[NetworkInterface] = []
    for name, each in sorted(stats.items()):
        if not each.isup:
            continue
        old = before.traffic.get(name) if before and seconds >= LEAST_S else None
        new = passed.get(name, nothing)
        interfaces.append(
            NetworkInterface(
                name,
                tuple(a.address for a in addresses.get(name, ()) if a.family == socket.AF_INET),
                "multicast" in each.flags,
                "loopback" in each.flags,
                each.mtu,
                hears=name in hearing,
                load=_load(old, new, seconds, each.speed) if old else 0.0,
                dropped=_dropped(old, new) if old else 0.0,
            )
        )
    return interfaces


def _load(old: InterfaceCounters, new: InterfaceCounters, seconds: float, mbits: int) -> float:
    """Return the share of the speed that was used, in the direction with more; 0 if unknown."""
    most = max(new.sent - old.sent, new.received - old.received)
    return 8 * most / (seconds * mbits * BITS_PER_MBIT) if mbits > 0 else 0.0


def _dropped(old: InterfaceCounters, new: InterfaceCounters) -> float:
    """Return the share of packets that could not be sent."""
    dropped = new.dropped - old.dropped
    tried = dropped + new.packets - old.packets
    return dropped / tried if tried >= LEAST_PACKETS else 0.0


def _hearing() -> set[str]:
    """Return the interfaces on which a program listens to the group of DDS."""
    group = f"{int.from_bytes(socket.inet_aton(GROUP), sys.byteorder):08X}"
    names: set[str] = set()
    name = ""
    try:
        lines = IGMP.read_text().splitlines()[1:]
    except OSError:
        return names
    for line in lines:
        words = line.replace(":", " ").split()
        if not line.startswith("\t"):
            name = words[1]
        elif words[0] == group:
            names.add(name)
    return names
