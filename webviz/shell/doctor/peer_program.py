"""The program of `webviz doctor --peer` that runs on both machines.

It needs Python 3.8 and its standard library, no ROS, and writes no file: the other machine receives
it through ssh's standard input, and it ends when that closes, or after `PATIENCE_S`. Requests and
answers are lines of JSON.
"""

from __future__ import annotations

import array
import fcntl
import json
import os
import platform
import socket
import struct
import sys
import threading
import time
from typing import Any

MARK = "@webviz "
"""Begins each answer, since a login shell may print whatever it likes."""
PATIENCE_S = 120.0
PREFIXES = ("ROS", "RMW", "FASTRTPS", "FASTDDS", "CYCLONEDDS", "ZENOH", "AMENT_PREFIX_PATH")
LIBRARIES = ("librmw", "libfastrtps", "libfastdds", "libddsc", "libzenoh")
"""Libraries of programs that are ROS nodes."""
MAX_NODES = 64
MAX_HEARD = 1000
MAX_TEXT = 4096
TIMES = 3
"""Copies of each packet, since a network may lose one."""
SIOCGIFCONF, SIOCGIFFLAGS, SIOCGIFNETMASK, SIOCGIFMTU = 0x8912, 0x8913, 0x891B, 0x8921
IFF_UP, IFF_LOOPBACK, IFF_MULTICAST = 0x1, 0x8, 0x1000
IP_MTU_DISCOVER, IP_PMTUDISC_PROBE = 10, 3
"""Options of Linux's sockets: the packets may not be fragmented, and what is known of the path is
ignored."""


class Agent:
    """One end of the comparison."""

    def __init__(self) -> None:
        self._socket: Any = None
        self._heard: dict[str, dict[str, Any]] = {}
        self._lock = threading.Lock()

    def look(self) -> dict[str, Any]:
        """Return this machine: its name, versions, interfaces, and the variables of ROS."""
        return {
            "host": socket.gethostname(),
            "python": platform.python_version(),
            "distributions": _folders("/opt/ros"),
            "variables": _relevant(dict(os.environ)),
            "nodes": _nodes(),
            "interfaces": _interfaces(),
            "receive_buffer": int(_read("/proc/sys/net/core/rmem_max") or 0),
        }

    def time(self) -> float:
        """Its clock in seconds since 1970."""
        return time.time()

    def listen(self, port: int, group: str) -> None:
        """Receive packets from now on, also those of a multicast group on all interfaces.

        Raises:
            OSError: the port is taken.
        """
        self.close()
        receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 1 << 20)
            receiver.bind(("", port))
            for address in _senders():
                joined = socket.inet_aton(group) + socket.inet_aton(address)
                try:
                    receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, joined)
                except OSError:  # an interface without multicast, or joined by another address
                    continue
        except OSError:
            receiver.close()
            raise
        self._socket, self._heard = receiver, {}
        threading.Thread(target=self._receive, args=(receiver,), daemon=True).start()

    def send(self, token: str, to: str, port: int, sizes: list[int]) -> list[str]:
        """Send packets that may not be fragmented, of these bytes of content.

        Args:
            token: they begin with it.
            to: an address, or a group, which is sent to from each interface.
            port: of the receiver.
            sizes: bytes of UDP's content, not below the length of the token.

        Returns:
            What this machine refused to send, sentences.
        """
        refused: list[str] = []
        is_group = 224 <= int(to.split(".")[0]) < 240
        for source in _senders() if is_group else [""]:
            with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
                sender.setsockopt(socket.IPPROTO_IP, IP_MTU_DISCOVER, IP_PMTUDISC_PROBE)
                if is_group:
                    interface = socket.inet_aton(source)
                    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, interface)
                    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 1)
                    sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_LOOP, 0)
                for size in sizes:
                    for _ in range(TIMES):
                        try:
                            sender.sendto(token.encode().ljust(size, b"."), (to, port))
                        except OSError as error:
                            refused.append(error.strerror or str(error))
                            break
        return sorted(set(refused))

    def heard(self) -> dict[str, Any]:
        """Return the senders and the sizes of the packets that arrived, by their token."""
        with self._lock:
            return {
                token: {"senders": sorted(each["senders"]), "sizes": sorted(each["sizes"])}
                for token, each in self._heard.items()
            }

    def close(self) -> None:
        """Receive no more."""
        receiver, self._socket = self._socket, None
        if receiver is not None:
            receiver.close()

    def _receive(self, receiver: socket.socket) -> None:
        while self._socket is receiver:
            try:
                receiver.settimeout(0.2)
                data, (address, _) = receiver.recvfrom(65536)
            except socket.timeout:  # noqa: UP041 - not the same before Python 3.10
                continue
            except OSError:
                return
            token = data.rstrip(b".").decode("ascii", "replace")[:64]
            with self._lock:
                if token in self._heard or len(self._heard) < MAX_HEARD:
                    received = self._heard.setdefault(token, {"senders": set(), "sizes": set()})
                    received["senders"].add(address)
                    received["sizes"].add(len(data))


def _relevant(variables: dict[str, str]) -> dict[str, str]:
    """Return the variables that say how ROS communicates; no others leave the machine."""
    return {k: v[:MAX_TEXT] for k, v in sorted(variables.items()) if k.startswith(PREFIXES)}


def _nodes() -> list[dict[str, Any]]:
    """Return the variables of running programs with a middleware of ROS, if readable.

    A shell that ssh starts often does not have those that a terminal or a service has.
    """
    nodes: list[dict[str, Any]] = []
    for pid in sorted(filter(str.isdecimal, _folders("/proc")), key=int):
        if int(pid) == os.getpid() or len(nodes) >= MAX_NODES:
            continue
        if not any(library in _read(f"/proc/{pid}/maps") for library in LIBRARIES):
            continue
        if not _is_same("net", pid):
            continue
        pairs = (each.partition("=") for each in _read(f"/proc/{pid}/environ").split("\0"))
        variables = _relevant({name: value for name, _, value in pairs if name})
        command = " ".join(_read(f"/proc/{pid}/cmdline").split("\0")).strip()
        nodes.append({"pid": int(pid), "command": command[:200], "variables": variables})
    return nodes


def _is_same(kind: str, pid: str) -> bool:
    """Return True if a program is in the same namespace, not in that of a container."""
    try:
        return os.readlink(f"/proc/{pid}/ns/{kind}") == os.readlink(f"/proc/self/ns/{kind}")
    except OSError:
        return False


def _interfaces() -> list[dict[str, Any]]:
    """Return the interfaces that are up, with their IPv4 addresses."""
    addresses: dict[str, list[tuple[str, str]]] = {}
    for name, address, mask in _addresses():
        addresses.setdefault(name.split(":")[0], []).append((address, mask))
    interfaces: list[dict[str, Any]] = []
    # Not by /sys, which may be that of another network namespace.
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        for _, name in sorted(socket.if_nameindex(), key=lambda each: each[1]):
            request = struct.pack("256s", name.encode()[:15])
            try:
                flagged = fcntl.ioctl(any_socket.fileno(), SIOCGIFFLAGS, request)
                sized = fcntl.ioctl(any_socket.fileno(), SIOCGIFMTU, request)
            except OSError:
                continue
            flags = struct.unpack_from("H", flagged, 16)[0]
            if flags & IFF_UP:
                interfaces.append(
                    {
                        "name": name,
                        "addresses": addresses.get(name, []),
                        "has_multicast": bool(flags & IFF_MULTICAST),
                        "is_loopback": bool(flags & IFF_LOOPBACK),
                        "mtu": struct.unpack_from("i", sized, 16)[0],
                    }
                )
    return interfaces


def _addresses() -> list[tuple[str, str, str]]:
    """Name, address and netmask of all IPv4 addresses."""
    addresses: list[tuple[str, str, str]] = []
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
        names = array.array("B", bytes(128 * 40))
        place, _ = names.buffer_info()
        request = struct.pack("iL", len(names), place)
        size = struct.unpack("iL", fcntl.ioctl(any_socket.fileno(), SIOCGIFCONF, request))[0]
        data = names.tobytes()[:size]
        for at in range(0, size, 40):
            name = data[at : at + 16].split(b"\0")[0].decode()
            packed = struct.pack("256s", name.encode()[:15])
            try:
                mask = fcntl.ioctl(any_socket.fileno(), SIOCGIFNETMASK, packed)[20:24]
            except OSError:
                continue
            address = socket.inet_ntoa(data[at + 20 : at + 24])
            addresses.append((name, address, socket.inet_ntoa(mask)))
    return addresses


def _senders() -> list[str]:
    """Return the addresses of the interfaces that packets leave the machine by."""
    return [
        address
        for each in _interfaces()
        if not each["is_loopback"]
        for address, _ in each["addresses"]
    ]


def _folders(path: str) -> list[str]:
    try:
        return sorted(os.listdir(path))
    except OSError:
        return []


def _read(path: str) -> str:
    try:
        with open(path, errors="replace") as file:
            return file.read()
    except OSError:
        return ""


def serve() -> None:
    """Answer requests until standard input closes, or the time is up."""
    ending = threading.Timer(PATIENCE_S, os._exit, (1,))
    ending.daemon = True
    ending.start()
    agent = Agent()
    out = sys.stdout
    for line in sys.stdin:
        request = json.loads(line)
        try:
            answer = {"value": getattr(agent, request["do"])(*request["with"])}
        except OSError as error:
            answer = {"error": error.strerror or str(error)}
        out.write(MARK + json.dumps(answer) + "\n")
        out.flush()
    agent.close()
