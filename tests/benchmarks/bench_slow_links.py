"""Age of a robot's pose in a browser on a slow link, beside a scan and a cloud.

    PYTHONPATH=. .venv/bin/python tests/benchmarks/bench_slow_links.py

Poses and scans of 1080 beams come at 20 Hz, a cloud of 100 000 points at 10 Hz, through a proxy
with a rate and a delay. The age of the pose is that of what the client has right before it gets
the next one: the delay of the link, what waits in queues, and 50 ms between two poses.
"""

from __future__ import annotations

import argparse
import math
import threading
import time
from dataclasses import dataclass

import numpy as np

from tests.scene.conftest import Peer
from tests.support.slow_link import SlowLink
from webviz.api.nodes import Points, Pose
from webviz.scene import ViserScene, open_server
from webviz.server.channel.links import reduced
from webviz.server.http.viser_server import Server

PERIOD_S = 0.05
CLOUD_POINTS = 100_000
SETTLE_S = 4.0
ROUND_TRIP_S = 0.2


@dataclass
class Found:
    """Bytes a client received each second, and the ages of its pose in s."""

    poses: float
    p50: float
    worst: float
    scans: float
    clouds: float


class Robot(threading.Thread):
    """Drives a robot along x until it is stopped; its x is the time in seconds.

    Args:
        server: of the scene.
    """

    def __init__(self, server: Server) -> None:
        super().__init__()
        self._scene = ViserScene(server)
        self._ended = threading.Event()

    def run(self) -> None:
        """Changes the scene."""
        random = np.random.default_rng(1)
        beams = random.random((1080, 3), np.float32)
        points = random.random((CLOUD_POINTS, 3), np.float32)
        colors = random.integers(0, 255, (CLOUD_POINTS, 3), np.uint8)
        turn = 0
        while not self._ended.wait(PERIOD_S):
            turn += 1
            moved = np.float32(turn)
            self._scene.upsert("scan", "it", Points(beams + moved, colors[: len(beams)], 0.1))
            if turn % 2:
                self._scene.upsert("lidar", "it", Points(points + moved, colors, 0.1))
            self._scene.set_pose("robot", Pose((time.monotonic(), 0.0, 0.0)))
            self._scene.flush()

    def end(self) -> None:
        """Wait for the last change."""
        self._ended.set()
        self.join()


def watch(peer: Peer, seconds: float) -> Found:
    """Read whatever comes, and count it once the link has settled."""
    ages: list[float] = []
    counts = {"scan": 0, "lidar": 0}
    newest: float | None = None
    start = time.monotonic() + SETTLE_S
    while time.monotonic() < start + seconds:
        messages = peer.receive()
        now = time.monotonic()
        for message in messages:
            if "position" in message and "robot" in message.get("name", ""):
                if newest is not None and now > start:
                    ages.append(now - newest)
                newest = message["position"][0]
            update = message.get("update", message)  # the last of pieces, or a whole one
            if now > start and "points" in update.get("values", update.get("updates", {})):
                kind = "scan" if "scan" in update["name"] else "lidar"
                counts[kind] += update["name"].endswith("it")
    rates = {kind: count / seconds for kind, count in counts.items()}
    ages = ages or [math.inf]  # the first pose is still behind what was sent before it
    p50 = float(np.median(ages))
    poses = sum(map(math.isfinite, ages)) / seconds
    return Found(poses, p50, max(ages), rates["scan"], rates["lidar"])


def behind_proxy(port: int, mbit: float, seconds: float) -> Found:
    """Return what a client behind the proxy receives."""
    link = SlowLink(port, mbit * 1e6 / 8, ROUND_TRIP_S / 2)
    peer = Peer(link)
    peer.look()
    try:
        return watch(peer, seconds)
    finally:
        peer.close()
        link.close()


def measure(mbit: float, seconds: float) -> None:
    """Print a row of the table."""
    server = open_server(port=0)
    robot = Robot(server)
    robot.start()
    said = ""

    def note() -> None:
        nonlocal said
        for browser in server.channel.browsers():
            if (congestion := server.channel.congestion(browser)) is not None:
                said = reduced(congestion) or said

    timer = threading.Timer(SETTLE_S + seconds / 2, note)
    timer.start()
    found = behind_proxy(server.get_port(), mbit, seconds)
    timer.join()
    robot.end()
    server.stop()
    ages = f"{1000 * found.p50:.0f} | {1000 * found.worst:.0f}"
    rates = f"{found.poses:.1f} | {found.scans:.1f} | {found.clouds:.1f}"
    print(f"| {mbit:g} Mbit/s | {ages} | {rates} | {said} |", flush=True)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--mbit", type=float, nargs="*", default=[1.0, 5.0, 20.0])
    parser.add_argument("--seconds", type=float, default=10.0)
    options = parser.parse_args()
    print("| link | p50 ms | worst ms | poses /s | scans /s | clouds /s | says |")
    print("| --- | ---: | ---: | ---: | ---: | ---: | --- |")
    for mbit in options.mbit:
        measure(mbit, options.seconds)


if __name__ == "__main__":
    main()
