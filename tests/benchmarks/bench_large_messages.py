"""Delay of a scan beside large messages drawn in the frame loop or in a thread.

    PYTHONPATH=tests/benchmarks:tests/support python tests/benchmarks/bench_large_messages.py

A scan of 1080 beams comes at 40 Hz, a map of 16000 x 8000 cells every four seconds and a cloud of
3 million points every two, straight into the inbox of a viewer with one client. Its delay is the
time from its arrival until it, or a newer one, is drawn. Both ways take turns in one run.
"""

from __future__ import annotations

import bisect
import contextlib
import subprocess
import sys
import threading
import time
from typing import Any

import numpy as np
from side_by_side import content
from side_by_side.watchers import ViserWatcher

import webviz
from webviz import Context, Sample
from webviz.api.registry import register
from webviz.data.messages import encode
from webviz.shell.testing.source import HandFedSource
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.point_cloud2 import PointCloud2

ROUNDS = 3
LOAD_S = 12.0
SCAN, MAP, CLOUD = (
    "sensor_msgs/msg/LaserScan",
    "nav_msgs/msg/OccupancyGrid",
    "sensor_msgs/msg/PointCloud2",
)
drawn: list[tuple[int, int]] = []
"""When each scan arrived and when it was drawn, in nanoseconds."""


class TimedScan(LaserScan):
    """A LaserScan that notes when it is drawn."""

    def draw(self, sample: Sample, ctx: Context) -> None:
        super().draw(sample, ctx)
        drawn.append((sample.received_ns, time.time_ns()))


def messages() -> tuple[bytes, list[bytes], list[bytes]]:
    """A scan, two maps and two clouds; all cells and points of the second differ."""
    header = {"frame_id": "map"}
    rng = np.random.default_rng(0)
    cells = rng.choice(np.array([0, 0, -1, 100], np.int8), (1000, 2000)).repeat(8, 0).repeat(8, 1)
    info = {"resolution": 0.05, "width": 16_000, "height": 8_000}
    maps = [
        encode(MAP, {"header": header, "info": info, "data": np.roll(cells, k).ravel()})
        for k in (0, 1)
    ]
    clouds = [encode(CLOUD, values) for values in content.clouds("map", 3_000_000)]
    return encode(SCAN, content.scans("map", 1080)[0]), maps, clouds


def delays(is_threaded: bool, scan: bytes, maps: list[bytes], clouds: list[bytes]) -> list[float]:
    """The delays of all scans of one load, in milliseconds."""
    Map.is_threaded = PointCloud2.is_threaded = is_threaded
    source = HandFedSource()
    with contextlib.ExitStack() as stack:
        viewer = stack.enter_context(webviz.Viewer(port=0, source=source))
        for handle in viewer.displays:
            handle.remove()
        viewer.fixed_frame = "map"
        for kind, topic in (("TimedScan", "/scan"), ("Map", "/map"), ("PointCloud2", "/points")):
            viewer.add(kind, topic=topic)
        port = viewer.url.rpartition(":")[2]
        client = subprocess.Popen([sys.executable, __file__, port], stdout=subprocess.PIPE)
        stack.callback(client.terminate)
        assert client.stdout is not None
        client.stdout.readline()
        drawn.clear()
        sent = []
        start = time.monotonic()
        for number in range(round(LOAD_S * 40)):
            rest = start + number / 40 - time.monotonic()
            if rest > 0:
                time.sleep(rest)
            source.now = time.time_ns()
            if number % 160 == 40:
                source.put("/map", MAP, maps[number // 160 % 2])
            if number % 80 == 20:
                source.put("/points", CLOUD, clouds[number // 80 % 2])
            sent.append(source.now)
            source.put("/scan", SCAN, scan)
        time.sleep(3.0)
    arrived = [at for at, _ in drawn]
    places = (bisect.bisect_left(arrived, at) for at in sent)
    return [
        (drawn[place][1] - at) / 1e6
        for at, place in zip(sent, places, strict=True)
        if place < len(drawn)
    ]


def main() -> None:
    """Print the figures."""
    register("bench", {"TimedScan": TimedScan})
    made = messages()
    found: dict[bool, list[float]] = {False: [], True: []}
    for _ in range(ROUNDS):
        for is_threaded, values in found.items():
            values += delays(is_threaded, *made)
    for is_threaded, values in found.items():
        p50, p99 = np.percentile(values, (50, 99))
        way = "in a thread" if is_threaded else "in the frame loop"
        print(f"{way:18} p50 {p50:6.1f} ms  p99 {p99:6.0f} ms  worst {max(values):6.0f} ms")


if __name__ == "__main__":
    if len(sys.argv) > 1:
        watcher: Any = ViserWatcher(int(sys.argv[1]), None)
        print("connected", flush=True)
        threading.Event().wait()
    main()
