"""This machine as the checks of the doctor see it: variables, network and shared memory."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field


@dataclass(frozen=True)
class NetworkInterface:
    """An interface of the network that is up.

    Args:
        name: such as eth0.
        addresses: IPv4 addresses.
        has_multicast: whether it may send and receive multicast.
        is_loopback: whether it only reaches this machine.
        mtu: largest packet in bytes.
        hears: whether a program of this machine listens to the multicast group of DDS there.
        load: share of its speed that was used since the look before; 0 if unknown.
        dropped: share of the packets since then that it could not send.
    """

    name: str
    addresses: Sequence[str]
    has_multicast: bool
    is_loopback: bool
    mtu: int
    hears: bool = False
    load: float = 0.0
    dropped: float = 0.0


@dataclass(frozen=True)
class SharedMemory:
    """The file system of shared memory.

    Args:
        size, free: bytes.
        foreign: names of segments of Fast DDS that belong to other users.
        stale_locks: names of locks of Fast DDS whose segment is gone.
        apart: ROS programs of this network with other shared memory, by their command lines.
        is_writable: whether this program may create files there.
    """

    size: int
    free: int
    foreign: Sequence[str] = ()
    stale_locks: Sequence[str] = ()
    apart: Sequence[str] = ()
    is_writable: bool = True


@dataclass(frozen=True)
class InterfaceCounters:
    """The counters of an interface since it is up.

    Args:
        sent, received: bytes.
        packets: that were sent.
        dropped: packets that could not be sent.
    """

    sent: int
    received: int
    packets: int
    dropped: int


@dataclass(frozen=True, kw_only=True)
class Environment:
    """This machine at one moment.

    Args:
        variables: of the environment of this program.
        python: version, such as "3.12".
        middlewares: names of the implementations that are installed.
        ros_error: why ROS did not start, "" if it runs or was not tried.
        profiles: problem of each file of the middleware that variables name, by path; "" for none.
        interfaces: that are up.
        traffic: of interfaces by name.
        at_s: monotonic time of `traffic` in seconds.
        multicast_returns: whether a multicast packet to this machine arrives; None if untried.
        shared_memory: None if there is none.
        receive_buffer: largest buffer of a socket in bytes (net.core.rmem_max); 0 if unknown.
        zenoh_routers: problem of each router that this machine connects to, "" for none.
        discovery_servers: problem of each server that ROS_DISCOVERY_SERVER names, "" for none.
        lost_datagrams: dropped since the start because a receive buffer was full.
        lost_fragments: datagrams since the start of which fragments were missing.
        multicast_interface: by which multicast leaves, "" if unknown.
        daemon: settings of discovery in which the daemon of `ros2` differs; none without one.
        security_problem: why the files of security do not do, a clause; "" if they do.
    """

    variables: Mapping[str, str] = field(default_factory=dict)
    python: str = ""
    middlewares: Sequence[str] = ()
    ros_error: str = ""
    profiles: Mapping[str, str] = field(default_factory=dict)
    interfaces: Sequence[NetworkInterface] = ()
    traffic: Mapping[str, InterfaceCounters] = field(default_factory=dict)
    at_s: float = 0.0
    multicast_returns: bool | None = None
    shared_memory: SharedMemory | None = None
    receive_buffer: int = 0
    lost_datagrams: int = 0
    lost_fragments: int = 0
    multicast_interface: str = ""
    daemon: Mapping[str, str] = field(default_factory=dict)
    security_problem: str = ""
    zenoh_routers: Mapping[str, str] = field(default_factory=dict)
    discovery_servers: Mapping[str, str] = field(default_factory=dict)

    @property
    def domain(self) -> str:
        """The domain of ROS."""
        return self.variables.get("ROS_DOMAIN_ID") or "0"

    @property
    def has_static_peers(self) -> bool:
        """Return whether discovery looks for named machines, too."""
        return bool(self.variables.get("ROS_STATIC_PEERS")) and not self._is_localhost_only

    @property
    def local_only(self) -> str:
        """The variable that limits discovery to this machine, "" if none does."""
        if self._is_localhost_only:
            return "ROS_LOCALHOST_ONLY"
        name = "ROS_AUTOMATIC_DISCOVERY_RANGE"
        return name if self.variables.get(name, "").upper() == "LOCALHOST" else ""

    @property
    def _is_localhost_only(self) -> bool:
        return self.variables.get("ROS_LOCALHOST_ONLY") == "1"
