"""Robots behind a bridge each, in one viewer with a browser's client: `bench_fleet.py 1 5 10`.

    PYTHONPATH=tests/benchmarks:tests/support .venv/bin/python tests/benchmarks/bench_fleet.py 1 10

One simulator has all robots; each robot's topics pass through a bridge of its own, a process with
the server of foxglove-sdk that forwards their bytes under the names they have on one robot. All
run on this machine. The viewer draws scan, path and model of each for one client, which draws no
page. The delay is that from the stamp to an inbox, through simulator, DDS and bridge, in a process
of its own that reads the same bridges.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import psutil

FORWARDED = {
    "tf": "tf2_msgs/msg/TFMessage",
    "tf_static": "tf2_msgs/msg/TFMessage",
    "scan": "sensor_msgs/msg/LaserScan",
    "odom": "nav_msgs/msg/Odometry",
    "path": "nav_msgs/msg/Path",
    "robot_description": "std_msgs/msg/String",
    "map": "nav_msgs/msg/OccupancyGrid",
}
LATCHED = ("tf_static", "robot_description", "map")
SETTLING_S, MEASURED_S = 20.0, 20.0
CONFIG = """\
version: 1
fixed_frame: map
robots: [{robots}]
view: {{distance: 15.5, yaw: -1.75, pitch: 0.95, focal_point: [0.1, -0.3, 0.0]}}
displays:
- {{type: Map, topic: /r1/map, draw_behind: true}}
- type: Group
  name: "{{robot}}"
  displays:
  - {{type: RobotModel, description_topic: "/{{robot}}/robot_description"}}
  - {{type: LaserScan, topic: "/{{robot}}/scan", size: 0.08}}
  - {{type: Path, topic: "/{{robot}}/path"}}
"""


def bridge(number: int) -> None:
    """Forward the topics of one robot until this is ended."""
    import foxglove  # pyright: ignore[reportMissingImports]

    from webviz.api.declared import Topic
    from webviz.data.messages import definition
    from webviz.ros.node import RosSource
    from webviz.sources import Raw, Subscription

    latched: dict[str, bytes] = {}
    channels: dict[str, Any] = {}
    namespace = f"/robot{number}"

    class Listener(foxglove.websocket.ServerListener):
        """Repeats latched messages, as foxglove_bridge does."""

        def on_subscribe(self, client: Any, channel: Any) -> None:
            """Send the last message."""
            if (last := latched.get(channel.topic)) is not None:
                channels[channel.topic].log(last)

    for name, type in FORWARDED.items():
        schema = foxglove.Schema(name=type, encoding="ros2msg", data=definition(type).encode())
        channels[f"/{name}"] = foxglove.Channel(f"/{name}", message_encoding="cdr", schema=schema)

    def forward(name: str, raw: Raw) -> None:
        topic = name.removeprefix(namespace)
        if topic[1:] in LATCHED:
            latched[topic] = raw.cdr
        channels[topic].log(raw.cdr)

    source = RosSource(node_name=f"bridge{number}")
    source.inbox.read_along(lambda: forward)
    source.want(
        {
            f"{namespace}/{name}": Subscription(type, Topic(f"{namespace}/{name}"))
            for name, type in FORWARDED.items()
        }
    )
    server = foxglove.start_server(
        name=f"robot{number}", host="127.0.0.1", port=0, server_listener=Listener()
    )
    print(server.port, flush=True)
    while True:
        source.inbox.drain()
        time.sleep(0.05)


@contextlib.contextmanager
def fleet(robots: int) -> Iterator[list[str]]:
    """Run simulated robots and their bridges; the addresses of the bridges."""
    domain = random.SystemRandom().randrange(160, 220)
    env = {**os.environ, "ROS_DOMAIN_ID": str(domain)}
    env["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    running: list[subprocess.Popen[str]] = []

    def start(*command: str) -> subprocess.Popen[str]:
        running.append(subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=env))
        return running[-1]

    try:
        names = ["--robots", str(max(2, robots))]
        start(sys.executable, "-m", "webviz_sim", *names)
        bridges = [
            start(sys.executable, __file__, "--bridge", str(n)) for n in range(1, robots + 1)
        ]
        ports = [each.stdout.readline().strip() for each in bridges if each.stdout]
        yield [f"ws://127.0.0.1:{port}" for port in ports]
    finally:
        for process in reversed(running):
            process.send_signal(signal.SIGTERM)
        for process in running:
            try:
                process.wait(10)
            except subprocess.TimeoutExpired:
                process.kill()


def delays(urls: list[str], seconds: float) -> dict[str, list[float]]:
    """Delays of scans and odometry from their stamps to an inbox, in s."""
    from webviz.api.declared import Topic
    from webviz.api.robots import NamespacedRobot
    from webviz.data.messages import decode
    from webviz.sources import Raw, Subscription
    from webviz.sources.fleet.source import FleetSource

    found: dict[str, list[float]] = {"scan": [], "odom": []}
    types = {name: FORWARDED[name] for name in found}

    def note(topic: str, raw: Raw) -> None:
        name = topic.rpartition("/")[2]
        stamp_ns = decode(types[name], raw.cdr).header.stamp_ns
        found[name].append((raw.received_ns - stamp_ns) / 1e9)

    members = [NamespacedRobot(f"r{n}", connection=url) for n, url in enumerate(urls, 1)]
    with contextlib.closing(FleetSource(members, None)) as source:
        source.inbox.read_along(lambda: note)
        topics = [(f"/{robot.name}/{name}", types[name]) for robot in members for name in types]
        source.want({topic: Subscription(type, Topic(topic)) for topic, type in topics})
        until = time.monotonic() + seconds
        while time.monotonic() < until:
            source.inbox.drain()
            time.sleep(0.02)
    return found


def measure(robots: int, picture: Path | None) -> str:
    """Return a row: processor time, memory, bytes a second, delays."""
    from program import Program
    from side_by_side.watchers import ViserWatcher

    with fleet(robots) as urls, tempfile.TemporaryDirectory() as folder:
        entries = [f'{{namespace: r{n}, connection: "{url}"}}' for n, url in enumerate(urls, 1)]
        config = Path(folder) / "fleet.yaml"
        config.write_text(CONFIG.format(robots=", ".join(entries)))
        command = [sys.executable, "-m", "webviz", "-d", str(config), "--port", "0"]
        env = {**os.environ, "PYTHONUNBUFFERED": "1", "ROS_DOMAIN_ID": "159"}
        program = Program([*command, "--no-autosave"], env, Path(folder) / "output.txt")
        try:
            url = program.url()
            client = ViserWatcher(int(url.rpartition(":")[2]), None)
            viewer = psutil.Process(program.process.pid)
            time.sleep(SETTLING_S)
            before, sent = viewer.cpu_times(), client.bytes
            began = time.monotonic()
            time.sleep(MEASURED_S)
            after, seconds = viewer.cpu_times(), time.monotonic() - began
            cpu = (after.user + after.system - before.user - before.system) / seconds
            rate = (client.bytes - sent) / seconds
            memory = viewer.memory_info().rss
            if picture:
                take(url, picture)
            client.close()
        finally:
            program.end()
        found = delays(urls, MEASURED_S / 2)
    cells = []
    for values in found.values():
        p50, p95 = np.percentile(values or [np.nan], [50, 95])
        cells.append(f"{p50 * 1e3:.1f} / {p95 * 1e3:.0f} ms")
    return (
        f"| {robots} | {100 * cpu:.0f} % | {memory / 1e6:.0f} MB | {rate / 1e3:.0f} kB/s | "
        + " | ".join(cells)
        + " |"
    )


def take(url: str, path: Path) -> None:
    """Take a picture of the page."""
    from playwright.sync_api import sync_playwright

    from webviz.shell.pictures.browser import executable_of

    arguments = "--use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader --no-sandbox"
    with sync_playwright() as playwright:
        kind = playwright.chromium
        browser = kind.launch(executable_path=executable_of(kind), args=arguments.split())
        page = browser.new_page(viewport={"width": 1400, "height": 900})
        page.goto(url)
        page.wait_for_timeout(25_000)
        page.screenshot(path=path)
        browser.close()


def main() -> None:
    """Read the command line."""
    parser = argparse.ArgumentParser()
    parser.add_argument("robots", type=int, nargs="*", default=[1, 5, 10])
    parser.add_argument("--picture", type=Path, help="of the page with the last fleet")
    parser.add_argument("--bridge", type=int)
    options = parser.parse_args()
    if options.bridge:
        bridge(options.bridge)
        return
    print("| robots | viewer | memory | to the client | scan p50 / p95 | odometry |")
    print("| ---: | ---: | ---: | ---: | ---: | ---: |")
    for robots in options.robots:
        picture = options.picture if robots == options.robots[-1] else None
        print(measure(robots, picture), flush=True)


if __name__ == "__main__":
    main()
