"""Ages of what comes through a bridge over slow links: by webviz, and by a plain client.

    .venv/bin/python tests/benchmarks/bench_bridge_links.py --mbit 0.3 1 5 50

A robot sends its pose at 50 Hz, a scan of 1080 beams at 10 Hz, clouds of 480 kB at 10 Hz and
images of 60 kB at 15 Hz through the server of foxglove-sdk, over a link with 100 ms from the robot
and 1 % of lost packets (`link_shaper.py`). The age is that of the newest message that has arrived,
read every 20 ms. The plain client subscribes to the same, as a viewer without pacing does. Needs
root.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import signal
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

HERE = Path(__file__).parent
TF = "tf2_msgs/msg/TFMessage"
SCAN, CLOUD = "sensor_msgs/msg/LaserScan", "sensor_msgs/msg/PointCloud2"
IMAGE = "sensor_msgs/msg/CompressedImage"
TOPICS = {"/tf": (TF, 50), "/scan": (SCAN, 10), "/points": (CLOUD, 10), "/image": (IMAGE, 15)}
CLOUD_BYTES, IMAGE_BYTES, BEAMS = 480_000, 60_000, 1080
SETTLE_S = 12.0
PORT = 8765


def robot() -> None:
    """Publish until this is ended."""
    import foxglove  # pyright: ignore[reportMissingImports]

    from webviz.data.messages import definition, encode

    random = np.random.default_rng(1)
    channels: dict[str, Any] = {}
    for topic, (type, _) in TOPICS.items():
        schema = foxglove.Schema(name=type, encoding="ros2msg", data=definition(type).encode())
        channels[topic] = foxglove.Channel(topic, message_encoding="cdr", schema=schema)
    foxglove.start_server(name="robot", host="0.0.0.0", port=PORT)
    print("ready", flush=True)

    def make(topic: str) -> dict[str, Any]:
        sec, nanosec = divmod(time.time_ns(), 1_000_000_000)
        header = {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": "laser"}
        if topic == "/tf":
            return {"transforms": [{"header": header, "child_frame_id": "base"}]}
        if topic == "/scan":
            return {"header": header, "ranges": random.random(BEAMS, np.float32)}
        size = CLOUD_BYTES if topic == "/points" else IMAGE_BYTES
        return {"header": header, "data": random.integers(0, 256, size, np.uint8)}

    due = dict.fromkeys(TOPICS, time.monotonic())
    while True:
        topic = min(due, key=due.__getitem__)
        time.sleep(max(0.0, due[topic] - time.monotonic()))
        channels[topic].log(encode(TOPICS[topic][0], make(topic)))
        due[topic] = max(due[topic] + 1 / TOPICS[topic][1], time.monotonic() - 1)


def stamp_s(topic: str, cdr: bytes) -> float:
    """Return the first stamp of a message; that of /tf follows the number of transforms."""
    sec, nanosec = struct.unpack_from("<iI", cdr, 8 if topic == "/tf" else 4)
    return sec + nanosec * 1e-9


class Ages:
    """Ages of the newest message of each topic, and the numbers of messages."""

    def __init__(self) -> None:
        self.newest: dict[str, float] = {}
        self.counts = dict.fromkeys(TOPICS, 0)
        self.ages: dict[str, list[float]] = {topic: [] for topic in TOPICS}

    def note(self, topic: str, cdr: bytes) -> None:
        """Note a message that has arrived."""
        self.newest[topic] = max(self.newest.get(topic, 0.0), stamp_s(topic, cdr))
        self.counts[topic] += 1

    def watch(
        self,
        seconds: float,
        say: Callable[[], str] = lambda: "",
        turn: Callable[[], object] = lambda: None,
    ) -> None:
        """Read the ages for some seconds once the link has settled, and print them.

        Args:
            seconds: after `SETTLE_S`.
            say: returns what the page says.
            turn: called all the time.
        """
        time.sleep(SETTLE_S)
        self.counts = dict.fromkeys(TOPICS, 0)
        began = time.monotonic()
        while time.monotonic() - began < seconds:
            time.sleep(0.02)
            turn()
            for topic, ages in self.ages.items():
                ages.append(time.time() - self.newest.get(topic, time.time() - 1e3))
        cells = []
        for topic, ages in self.ages.items():
            p50, p95 = np.percentile(ages, [50, 95])
            rate = self.counts[topic] / seconds
            cells.append(f"{p50:.2f} / {p95:.2f} s, {rate:.2g} Hz" if p50 < 900 else "none")
        print(" | ".join(cells), "|", say(), "|", flush=True)


def webviz(seconds: float) -> None:
    """Read the topics as the viewer does."""
    from webviz.api.declared import Topic
    from webviz.sources import Subscription
    from webviz.sources.bridge.address import address
    from webviz.sources.bridge.source import BridgeSource

    ages = Ages()
    source = BridgeSource(address(f"ws://10.78.0.1:{PORT}"))
    source.inbox.read_along(lambda: lambda topic, raw: ages.note(topic, raw.cdr))
    source.want({t: Subscription(type, Topic(t)) for t, (type, _) in TOPICS.items()})

    with contextlib.closing(source):
        ages.watch(seconds, lambda: " ".join(source.bridges[0].remarks), source.inbox.drain)


def plain(seconds: float) -> None:
    """Read the topics with one connection, subscribed to all the time."""
    import json
    import threading

    from websockets.sync.client import connect

    ages = Ages()

    def read() -> None:
        with connect(
            f"ws://10.78.0.1:{PORT}",
            subprotocols=["foxglove.sdk.v1"],  # pyright: ignore[reportArgumentType]
            max_size=None,
            compression=None,
            ping_interval=None,
        ) as socket:
            names: dict[int, str] = {}
            for frame in socket:
                if isinstance(frame, bytes):
                    if frame[0] == 1:
                        ages.note(names[struct.unpack_from("<I", frame, 1)[0]], frame[13:])
                    continue
                for channel in json.loads(frame).get("channels", ()):
                    names[channel["id"]] = channel["topic"]
                    wish = {"id": channel["id"], "channelId": channel["id"]}
                    socket.send(json.dumps({"op": "subscribe", "subscriptions": [wish]}))

    threading.Thread(target=read, daemon=True).start()
    ages.watch(seconds)


def measure(mbit: float, options: argparse.Namespace) -> None:
    """Print the rows of one link."""
    name = f"wl{os.getpid() % 10000}"
    env = {**os.environ, "PYTHONPATH": str(HERE.parents[1])}
    shaper = [sys.executable, str(HERE / "link_shaper.py"), name, options.congestion]
    shaper += [str(mbit), str(options.delay), str(options.loss)]
    itself = [sys.executable, __file__, "--seconds", str(options.seconds), "--as"]
    running: list[subprocess.Popen[str]] = []

    def start(*command: str) -> None:
        process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=env)
        running.append(process)
        assert process.stdout
        assert process.stdout.readline() == "ready\n"

    try:
        start(*shaper)
        start("ip", "netns", "exec", f"{name}-robot", *itself, "robot")
        for client in options.clients:
            print(f"| {mbit:g} Mbit/s | {client} | ", end="", flush=True)
            desk = ["ip", "netns", "exec", f"{name}-desk", *itself, client]
            subprocess.run(desk, check=True, env=env)
    finally:
        for process in reversed(running):
            process.send_signal(signal.SIGTERM)
            process.wait()
        for side in ("robot", "desk"):
            subprocess.run(["ip", "netns", "del", f"{name}-{side}"], check=False)


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--mbit", type=float, nargs="*", default=[0.3, 1.0, 5.0, 50.0])
    parser.add_argument("--delay", type=float, default=0.1, help="from the robot, in s")
    parser.add_argument("--loss", type=float, default=0.01)
    parser.add_argument("--congestion", default="reno", help="control of TCP: reno or bbr")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--clients", nargs="*", default=["webviz", "plain"])
    parser.add_argument("--as", dest="role", default="")
    options = parser.parse_args()
    roles = {"webviz": webviz, "plain": plain}
    if options.role == "robot":
        robot()
    elif options.role:
        roles[options.role](options.seconds)
    else:
        print("| link | client | pose p50 / p95 | scan | cloud | image | says |")
        print("| --- | --- | ---: | ---: | ---: | ---: | --- |")
        for mbit in options.mbit:
            measure(mbit, options)


if __name__ == "__main__":
    main()
