"""This machine and another, as the checks of `webviz doctor --peer` see them."""

from __future__ import annotations

import ipaddress
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from webviz.api.environment import NetworkInterface


@dataclass(frozen=True)
class NodeProcess:
    """A running program that uses a middleware of ROS.

    Args:
        pid: of the process.
        command: its command line, shortened.
        variables: of its environment that say how ROS communicates.
    """

    pid: int
    command: str
    variables: Mapping[str, str]


@dataclass(frozen=True, kw_only=True)
class End:
    """One of two machines.

    Args:
        host: its name.
        python: version, such as "3.10.12".
        distributions: of ROS that are installed, such as "jazzy".
        variables: of the environment that webviz or ssh started in.
        nodes: that run there, as far as they can be seen.
        interfaces: that are up.
        networks: of the interfaces besides loopback, such as "192.168.1.0/24".
        receive_buffer: largest buffer of a socket in bytes (net.core.rmem_max); 0 if unknown.
    """

    host: str
    python: str
    distributions: Sequence[str]
    variables: Mapping[str, str]
    nodes: Sequence[NodeProcess]
    interfaces: Sequence[NetworkInterface]
    networks: Sequence[str]
    receive_buffer: int

    def settings(self, name: str, default: str = "") -> Mapping[str, str]:
        """Return the values of a variable in use, each with who uses it.

        Those of running nodes; without any, that of the shell.
        """
        sources: dict[str, str] = {}
        for node in self.nodes:
            who = f"process {node.pid} ({node.command.partition(' --ros-args')[0]})"
            sources.setdefault(node.variables.get(name, "") or default, who)
        return sources or {self.variables.get(name, "") or default: "the environment"}

    def shares_network(self, other: End) -> bool:
        """Return whether an interface of each is in the same subnet."""
        ours = [ipaddress.ip_network(each) for each in self.networks]
        theirs = [ipaddress.ip_network(each) for each in other.networks]
        return any(a.overlaps(b) for a in ours for b in theirs)

    def interface(self, address: str) -> NetworkInterface | None:
        """Return the interface that has an address, None if none has."""
        return next((each for each in self.interfaces if address in each.addresses), None)


@dataclass(frozen=True, kw_only=True)
class PacketLink:
    """Packets in one direction.

    Args:
        addresses: of the receiver, at which single packets arrived.
        tried: addresses that packets were sent to.
        has_multicast: whether packets to the group of DDS arrived.
        packet: bytes of the largest packet that arrived and may not be fragmented; 0 if none did.
        interface: of the sender by which they left, "" if unknown.
        mtu: bytes of the largest packet that the interfaces of both ends allow; 0 if unknown.
    """

    addresses: Sequence[str]
    tried: Sequence[str]
    has_multicast: bool
    packet: int
    interface: str
    mtu: int


@dataclass(frozen=True, kw_only=True)
class TwoEnds:
    """This machine and its peer.

    Args:
        here, there: the machines.
        out, back: packets from here to there, and from there to here.
        offset_s: the peer's clock minus that of this machine, in seconds.
        uncertainty_s: of the offset, half of the shortest round trip.
    """

    here: End
    there: End
    out: PacketLink
    back: PacketLink
    offset_s: float
    uncertainty_s: float

    def links(self) -> Iterator[tuple[PacketLink, End, End]]:
        """Both directions, each with its sender and its receiver."""
        yield self.out, self.here, self.there
        yield self.back, self.there, self.here

    @property
    def shares_network(self) -> bool:
        """Return whether an interface of each is in the same subnet."""
        return self.here.shares_network(self.there)
