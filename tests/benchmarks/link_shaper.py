"""A slow link between two network namespaces, as tc netem makes it, in user space.

For kernels without sch_netem: two TUN devices, between which a process carries the packets of one
direction with a rate, a delay and random losses, behind a queue of 1000 packets; those of the other
direction pass at once. Needs root.

    python link_shaper.py NAME reno MBIT DELAY_S LOSS    # prints "ready"
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import random
import select
import struct
import subprocess
import sys
import time
from collections import deque

LIMIT = 1000
"""Packets in the queue, netem's default."""
MTU = 1500
TUNSETIFF, IFF_TUN_NO_PI = 0x400454CA, 0x1001
ROBOT, DESK = "10.78.0.1", "10.78.0.2"


def ip(command: str) -> None:
    """Run ip of iproute2."""
    subprocess.run(["ip", *command.split()], check=True)


def device(name: str, namespace: str, congestion: str, here: str, there: str) -> int:
    """Make a TUN device in a namespace; its descriptor."""
    tun = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(tun, TUNSETIFF, struct.pack("16sH", name.encode(), IFF_TUN_NO_PI))
    ip(f"netns add {namespace}")
    ip(f"link set {name} netns {namespace}")
    ip(f"-n {namespace} link set lo up")
    ip(f"-n {namespace} addr add {here} peer {there} dev {name}")
    ip(f"-n {namespace} link set {name} mtu {MTU} up")
    command = f"sysctl -qw net.ipv4.tcp_congestion_control={congestion}"
    subprocess.run(["ip", "netns", "exec", namespace, *command.split()], check=True)
    return tun


def carry(robot: int, desk: int, rate: float, delay_s: float, loss: float) -> None:
    """Carry packets until this is ended.

    Args:
        robot: descriptor of the device whose packets take the slow direction.
        desk: of the other.
        rate: bytes per second.
        delay_s: of each packet, besides the queue.
        loss: share of packets that are lost.
    """
    chance = random.Random(1)
    waiting: deque[tuple[float, float, bytes]] = deque()
    """Moments at which each has left the queue and arrives."""
    free_s = 0.0
    while True:
        now = time.monotonic()
        while waiting and waiting[0][1] <= now:
            write(desk, waiting.popleft()[2])
        patience = max(0.0, waiting[0][1] - now) if waiting else None
        for ready in select.select([robot, desk], [], [], patience)[0]:
            for packet in packets(ready):
                if ready == desk:
                    write(robot, packet)
                    continue
                now = time.monotonic()
                queued = sum(1 for left, _, _ in waiting if left > now) if free_s > now else 0
                if chance.random() < loss or queued >= LIMIT:
                    continue
                free_s = max(now, free_s) + len(packet) / rate
                waiting.append((free_s, free_s + delay_s, packet))


def packets(tun: int, most: int = 64) -> list[bytes]:
    """Read what has come."""
    found: list[bytes] = []
    with contextlib.suppress(BlockingIOError):
        while len(found) < most:
            found.append(os.read(tun, MTU + 100))
    return found


def write(tun: int, packet: bytes) -> None:
    """Write a packet, or lose it if the device takes none."""
    with contextlib.suppress(OSError):
        os.write(tun, packet)


def main() -> None:
    """Make the namespaces NAME-robot and NAME-desk, and carry packets between them."""
    name, congestion = sys.argv[1:3]
    mbit, delay_s, loss = map(float, sys.argv[3:])
    robot = device(f"{name}r", f"{name}-robot", congestion, ROBOT, DESK)
    desk = device(f"{name}d", f"{name}-desk", congestion, DESK, ROBOT)
    print("ready", flush=True)
    carry(robot, desk, mbit * 1e6 / 8, delay_s, loss)


if __name__ == "__main__":
    main()
