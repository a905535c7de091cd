"""A look at this machine, for the checks of machine, network and shared memory."""

from __future__ import annotations

import os
import platform
import re
import socket
import sys
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple
from xml.etree import ElementTree

from webviz.api.environment import Environment, NetworkInterface, SharedMemory
from webviz.engine.machine.interfaces import GROUP, interfaces_since, traffic
from webviz.engine.machine.settings import daemon_differences, security_problem

WAIT_S = 0.3
ZENOH, ZENOH_PORT = "rmw_zenoh_cpp", 7447
DISCOVERY_PORT = 11811
_ENDPOINTS = re.compile(r"connect/endpoints\s*=\s*\[([^\]]*)\]")
_TCP = re.compile(r"tcp/(?:\[([^\]]+)\]|([^:/\"]+)):(\d+)")


def zenoh_routers(variables: Mapping[str, str]) -> Mapping[str, str]:
    """Return the problem of each Zenoh router that this machine uses, "" for one that listens.

    None without Zenoh, or if a file of the session names the routers.
    """
    if variables.get("RMW_IMPLEMENTATION") != ZENOH:
        return {}
    endpoints = _ENDPOINTS.search(variables.get("ZENOH_CONFIG_OVERRIDE", ""))
    if endpoints is None and variables.get("ZENOH_SESSION_CONFIG_URI"):
        return {}
    text = endpoints[1] if endpoints else f"tcp/localhost:{ZENOH_PORT}"
    places = {match[0]: (match[1] or match[2], int(match[3])) for match in _TCP.finditer(text)}
    return {name: _tcp_problem(*place) for name, place in places.items()}


def discovery_servers(variables: Mapping[str, str]) -> Mapping[str, str]:
    """Return the problem of each discovery server of Fast DDS, "" for one that is not refused.

    UDP has no connections: only the machine of the server can say that nothing listens there.
    """
    servers: dict[str, str] = {}
    for entry in variables.get("ROS_DISCOVERY_SERVER", "").split(";"):
        name = entry.strip()
        if not name or name.startswith(("TCP", "[")) or name.count(":") > 1:
            continue
        host, _, port = name.partition(":")
        try:
            servers[name] = _udp_problem(host, int(port or DISCOVERY_PORT))
        except ValueError:
            servers[name] = "its port is not a number"
    return servers


def _tcp_problem(host: str, port: int) -> str:
    try:
        with socket.create_connection((host, port), WAIT_S):
            return ""
    except OSError as error:
        return error.strerror or "no answer"


def _udp_problem(host: str, port: int) -> str:
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.settimeout(WAIT_S)
            probe.connect((host, port))
            probe.send(b"")
            probe.recv(1)
    except TimeoutError:
        return ""
    except (OSError, OverflowError) as error:
        return getattr(error, "strerror", None) or str(error)
    return ""


PROC = Path("/proc")
LIBRARIES = (b"librmw", b"libfastrtps", b"libfastdds", b"libddsc")
"""Libraries of programs that are ROS nodes."""
MOST = 10
LONGEST = 80
"""Characters of a command line that are shown."""


def programs_apart(memory: Path) -> Sequence[str]:
    """Return the command lines of ROS programs of this domain with other shared memory.

    A container with the network of the host (`--network host`) has its own unless it is started
    with `--ipc=host`. Fast DDS takes it for the same machine, and sends through shared memory.

    Args:
        memory: the file system of shared memory.
    """
    try:
        own, network = os.stat(memory).st_dev, os.readlink(PROC / "self/ns/net")
    except OSError:
        return ()
    programs: list[str] = []
    domain = os.environ.get("ROS_DOMAIN_ID") or "0"
    for process in PROC.glob("[0-9]*"):
        try:
            if os.stat(f"{process}/root{memory}").st_dev == own:
                continue
            if os.readlink(process / "ns/net") != network:
                continue
            maps = (process / "maps").read_bytes()
            words = (process / "cmdline").read_bytes().replace(b"\0", b" ")
            if _domain(process) != domain:
                continue
        except OSError:  # it has ended, or belongs to another user
            continue
        if any(library in maps for library in LIBRARIES):
            programs.append(words.decode(errors="replace").strip()[:LONGEST])
    return tuple(sorted(programs)[:MOST])


def _domain(process: Path) -> str:
    """Return the domain of ROS in the environment that a process was started with."""
    entries = (process / "environ").read_bytes().split(b"\0")
    named = (each for each in entries if each.startswith(b"ROS_DOMAIN_ID="))
    return next(named, b"").partition(b"=")[2].decode(errors="replace") or "0"


PREFIXES = ("ROS", "RMW", "FASTRTPS", "FASTDDS", "CYCLONEDDS", "ZENOH", "AMENT", "PYTHONPATH")
PROFILES = ("FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE", "CYCLONEDDS_URI")
RMW_INDEX = "share/ament_index/resource_index/rmw_typesupport_cpp"
SHM = Path("/dev/shm")
PORTS = "fastrtps_port", "fastdds_port"
"""Begin the names of ports of Fast DDS 2, of Jazzy, and 3, of Kilted."""
LOCK = "_el"
"""Ends the name of a lock file, which is otherwise that of its port."""
SEGMENTS = "fastrtps_", "fastdds_"
RMEM_MAX = Path("/proc/sys/net/core/rmem_max")
SNMP = Path("/proc/net/snmp")
PROBE_S = 0.5
MAX_PROFILE = 1 << 20
"""Bytes of a file of the middleware that are read."""


class UdpLosses(NamedTuple):
    """Losses of a machine since its start.

    Args:
        datagrams: of UDP, as buffers were full.
        fragmented: datagrams of which fragments did not arrive.
    """

    datagrams: int = 0
    fragmented: int = 0


NOTHING_LOST = UdpLosses()


def look_around(
    ros_error: str = "",
    lost_before: UdpLosses = NOTHING_LOST,
    before: Environment | None = None,
) -> Environment:
    """Look at this machine; takes up to half a second.

    Args:
        ros_error: why ROS did not start, "" if it did.
        lost_before: what was lost before, see `lost_so_far`.
        before: the look before, to which the use of interfaces is compared.
    """
    names = sorted(name for name in os.environ if name.startswith(PREFIXES))
    variables = {name: os.environ[name] for name in names}
    now_s, passed = time.monotonic(), traffic()
    interfaces = interfaces_since(passed, now_s, before)
    losses = lost_so_far()
    return Environment(
        variables=variables,
        python=".".join(platform.python_version_tuple()[:2]),
        middlewares=_middlewares(),
        ros_error=ros_error,
        profiles=_profiles(variables),
        interfaces=interfaces,
        traffic=passed,
        at_s=now_s,
        multicast_returns=_multicast_returns() if interfaces else None,
        shared_memory=_shared_memory(),
        receive_buffer=_receive_buffer(),
        zenoh_routers=zenoh_routers(variables),
        discovery_servers=discovery_servers(variables),
        lost_datagrams=max(0, losses.datagrams - lost_before.datagrams),
        lost_fragments=max(0, losses.fragmented - lost_before.fragmented),
        multicast_interface=_multicast_interface(interfaces),
        daemon=daemon_differences(variables),
        security_problem=security_problem(variables),
    )


def lost_so_far() -> UdpLosses:
    """Return what this machine lost since its start."""
    return UdpLosses(_counter("Udp:", "RcvbufErrors"), _counter("Ip:", "ReasmFails"))


def _counter(protocol: str, name: str) -> int:
    """Return a counter of the kernel, 0 if it is unknown."""
    try:
        rows = [line.split() for line in SNMP.read_text().splitlines() if line.startswith(protocol)]
        return int(dict(zip(rows[0], rows[1], strict=True))[name])
    except (OSError, ValueError, KeyError, IndexError):
        return 0


def _middlewares() -> Sequence[str]:
    """Return the implementations of ROS's middleware that are installed, by ament's index."""
    prefixes = [*os.environ.get("AMENT_PREFIX_PATH", "").split(":"), sys.prefix]
    folders = [Path(prefix) / RMW_INDEX for prefix in prefixes if prefix]
    return tuple(sorted({path.name for folder in folders for path in folder.glob("rmw_*")}))


def _multicast_interface(interfaces: Sequence[NetworkInterface]) -> str:
    """Return the interface by which a packet to the group of DDS leaves, "" without a route."""
    try:
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            sender.connect((GROUP, 7400))
            address = sender.getsockname()[0]
    except OSError:
        return ""
    return next((each.name for each in interfaces if address in each.addresses), "")


def _multicast_returns() -> bool | None:
    """Return whether a packet to a multicast group comes back, None if it cannot be tried."""
    try:
        with (
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as receiver,
            socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
        ):
            receiver.bind((GROUP, 0))
            membership = socket.inet_aton(GROUP) + socket.inet_aton("0.0.0.0")
            receiver.settimeout(PROBE_S)
            sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)  # this machine only
            probe = os.urandom(16)
            try:
                receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
                sender.sendto(probe, receiver.getsockname())
                return receiver.recv(64) == probe
            except OSError:  # no route, no group, or nothing within the time
                return False
    except OSError:
        return None


def _shared_memory() -> SharedMemory | None:
    try:
        status = os.statvfs(SHM)
        with os.scandir(SHM) as entries:
            segments = {each.name: each for each in entries if each.name.startswith(SEGMENTS)}
        foreign = sorted(name for name, each in segments.items() if _is_foreign(each))
    except OSError:
        return None
    stale = sorted(
        name
        for name in segments
        if name.startswith(PORTS)
        and name.endswith(LOCK)
        and name.removesuffix(LOCK) not in segments
    )
    size, free = status.f_blocks * status.f_frsize, status.f_bavail * status.f_frsize
    is_writable = os.access(SHM, os.W_OK)
    return SharedMemory(size, free, tuple(foreign), tuple(stale), programs_apart(SHM), is_writable)


def _is_foreign(file: os.DirEntry[str]) -> bool:
    """Return whether a file belongs to another user; one that is gone meanwhile does not."""
    try:
        return file.stat().st_uid != os.geteuid()
    except FileNotFoundError:
        return False


def _receive_buffer() -> int:
    try:
        return int(RMEM_MAX.read_text())
    except (OSError, ValueError):
        return 0


def _profiles(variables: Mapping[str, str]) -> Mapping[str, str]:
    """Return the problems of the files that variables name."""
    profiles: dict[str, str] = {}
    for name in PROFILES:
        value = variables.get(name, "").strip()
        if value.startswith("<"):
            # Cyclone DDS also reads `</>`, which closes any element.
            profiles[name] = "" if "</>" in value else _xml_problem(value)
            continue
        for entry in filter(None, value.split(",")):
            path = Path(entry.removeprefix("file://"))
            try:
                with path.open("rb") as file:
                    profiles[str(path)] = _xml_problem(file.read(MAX_PROFILE))
            except OSError as error:
                profiles[str(path)] = error.strerror or str(error)
    return profiles


def _xml_problem(text: str | bytes) -> str:
    try:
        ElementTree.fromstring(text)
    except (ElementTree.ParseError, ValueError) as error:
        return f"not valid XML: {error}"
    return ""
