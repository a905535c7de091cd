"""Limits of one viewer: browsers, topics, displays and frames, one after the other.

    PYTHONPATH=tests/benchmarks:tests/support .venv/bin/python tests/benchmarks/bench_scale.py

A viewer in this process gets its messages without ROS or network, so that nothing but webviz is
measured: transforms at 10 Hz in one message, and 20 scans of 360 beams at 10 Hz. Its clients, in a
process of their own, draw no page. The load is the processor time of this process in percent of a
core; a turn of the frame loop that takes longer than the time between two drops frames.
"""

from __future__ import annotations

import argparse
import multiprocessing
import sys
import tempfile
import threading
import time
from pathlib import Path
from typing import Any

import psutil

SETTLE_S, PATIENCE_S = 4.0, 60.0
TF, SCAN = "tf2_msgs/msg/TFMessage", "sensor_msgs/msg/LaserScan"
HZ = 10


def header(now_ns: int, frame: str) -> dict[str, Any]:
    """Return a header."""
    sec, nanosec = divmod(now_ns, 1_000_000_000)
    return {"stamp": {"sec": sec, "nanosec": nanosec}, "frame_id": frame}


class Robot(threading.Thread):
    """Feeds a source until it is ended.

    Args:
        source: to feed.
        frames: that move.
        topics: of scans, of which `drawn` have a display.
    """

    def __init__(self, source: Any, frames: int, topics: int) -> None:
        super().__init__()
        self._source, self._frames, self._topics = source, frames, topics
        self._ended = threading.Event()
        self.late = 0

    def run(self) -> None:
        """Feed."""
        import numpy as np

        from webviz.data.messages import encode

        ranges = np.full(360, 2.0, np.float32)
        turn = 0
        next_s = time.monotonic()
        while not self._ended.is_set():
            turn += 1
            self._source.now = time.time_ns()
            moved = [
                {
                    "header": header(self._source.now, "map"),
                    "child_frame_id": f"f{n}",
                    "transform": {
                        "translation": {"x": n % 50 + turn % 10 / 10, "y": n // 50},
                        "rotation": {"w": 1.0},
                    },
                }
                for n in range(self._frames)
            ]
            self._source.put("/tf", TF, encode(TF, {"transforms": moved}))
            scan = {"header": header(self._source.now, "f0"), "ranges": ranges}
            cdr = encode(SCAN, {**scan, "angle_increment": 0.01, "range_max": 9.0})
            for n in range(self._topics):
                self._source.put(f"/scan{n}", SCAN, cdr)
            next_s = max(next_s + 1 / HZ, time.monotonic() - 1)
            self.late += time.monotonic() > next_s
            self._ended.wait(max(0.0, next_s - time.monotonic()))

    def end(self) -> None:
        """Wait for the last message."""
        self._ended.set()
        self.join()


def watch(port: int, count: int, stop: Any) -> None:
    """Be so many clients, in a process of their own."""
    from side_by_side.watchers import ViserWatcher

    clients = [ViserWatcher(port, None) for _ in range(count)]
    stop.wait()
    for client in clients:
        client.close()


def measure(seconds: float, browsers: int, topics: int, drawn: int, frames: int) -> str:
    """Return a row of the table."""
    import webviz
    from webviz.shell.testing.source import HandFedSource

    source = HandFedSource()
    displays = [f"- {{type: LaserScan, name: s{n}, topic: /scan{n}}}" for n in range(drawn)]
    displays.append("- {type: TF, show_names: false}")
    with tempfile.TemporaryDirectory() as folder:
        config = Path(folder) / "scale.yaml"
        config.write_text("version: 1\nfixed_frame: map\ndisplays:\n" + "\n".join(displays))
        robot = Robot(source, frames, topics)
        robot.start()
        context = multiprocessing.get_context("spawn")
        stop = context.Event()
        with webviz.Viewer(config, port=0, source=source) as viewer:
            clients = context.Process(target=watch, args=(viewer.port, browsers, stop))
            clients.start()
            until = time.monotonic() + PATIENCE_S
            while viewer._scene.link.watchers < browsers and time.monotonic() < until:
                time.sleep(0.1)
            time.sleep(SETTLE_S)
            process = psutil.Process()
            before, began, late = process.cpu_times(), time.monotonic(), robot.late
            time.sleep(seconds)
            after, spent = process.cpu_times(), time.monotonic() - began
            load = (after.user + after.system - before.user - before.system) / spent
            memory = process.memory_info().rss / 1e6
            late = robot.late - late
            seen = viewer._scene.link.watchers
            stop.set()
            clients.join()
        robot.end()
    row = [seen, topics, drawn, frames, f"{100 * load:.0f} %", f"{memory:.0f} MB", late]
    return "| " + " | ".join(map(str, row)) + " |"


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--seconds", type=float, default=6.0)
    parser.add_argument("--row", type=int, nargs=4)
    options = parser.parse_args()
    if options.row:
        print(measure(options.seconds, *options.row), flush=True)
        return
    rows = [(n, 20, 20, 100) for n in (1, 10, 30, 100)]
    rows += [(1, n, 20, 100) for n in (1000, 3000)]
    rows += [(1, n, n, 100) for n in (100, 200)]
    rows += [(1, 20, 20, n) for n in (1000, 5000)]
    print("| browsers | topics | displays | frames | load | memory | late |")
    print("| ---: " * 7 + "|", flush=True)
    import subprocess

    for row in rows:  # each in a process of its own, so that memory is its own
        command = [sys.executable, __file__, "--seconds", str(options.seconds), "--row"]
        subprocess.run([*command, *map(str, row)], check=True)


if __name__ == "__main__":
    main()
