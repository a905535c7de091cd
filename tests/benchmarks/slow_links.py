"""Topics over a slow link, by Zenoh and by Foxglove's protocol: the age of the newest message.

    PYTHONPATH=tests/benchmarks:sim python tests/benchmarks/slow_links.py RATE WAY [SECONDS]

As root, RATE in Mbit/s, WAY one of `foxglove`, `zenoh` and `priorities`, which has the config of
displays/docs/ros/which_way.md. Robot and viewer are in network namespaces of their own. A process
between them delays each packet by 50 ms, keeps 256 kB at most, and loses 1 %, since not every
kernel has `sch_netem`. TCP is Reno unless CONGESTION says otherwise. The robot publishes a pose at
50 Hz, a scan of 1080 beams at 10 Hz, clouds of 480 kB at 10 Hz and images of 60 kB at 15 Hz.
"""

from __future__ import annotations

import ctypes
import fcntl
import json
import math
import os
import random
import re
import struct
import subprocess
import sys
import threading
import time
from collections import deque
from collections.abc import Callable
from pathlib import Path
from typing import Any

from webviz.api.declared import Topic
from webviz.data.messages import definition, encode
from webviz.sources import Raw, Source, Subscription

PAGE = Path(__file__).parents[2] / "displays/docs/ros/which_way.md"
ROBOT, VIEWER = "10.77.0.1", "10.77.0.2"
DELAY_S, BUFFER, LOSS = 0.05, 256_000, 0.01
TUN, SET_TUN = 0x1001, 0x400454CA
"""IFF_TUN without packet information, and TUNSETIFF."""
TOPICS = {
    "/odom": ("geometry_msgs/msg/PoseStamped", 50),
    "/scan": ("sensor_msgs/msg/LaserScan", 10),
    "/points": ("sensor_msgs/msg/PointCloud2", 10),
    "/camera": ("sensor_msgs/msg/CompressedImage", 15),
}
FIELDS: dict[str, dict[str, Any]] = {
    "/odom": {},
    "/scan": {"ranges": [1.0] * 1080},
    "/points": {"data": os.urandom(480_000), "width": 30_000, "height": 1},
    "/camera": {"data": os.urandom(60_000), "format": "jpeg"},
}
_open: list[Any] = []
"""A session and its node, which end with what refers to them."""
BEGIN_S = 5.0
"""Time in seconds until ages count."""


def shape(robot: str, viewer: str, rate: float) -> None:
    """Carry packets between two namespaces until the standard input ends."""
    ends = _tunnel(robot, ROBOT), _tunnel(viewer, VIEWER)
    for source, target in (ends, ends[::-1]):
        threading.Thread(target=_carry, args=(source, target, rate * 1e6 / 8), daemon=True).start()
    print("ready", flush=True)
    sys.stdin.read()


def _tunnel(namespace: str, address: str) -> int:
    """Return the descriptor of a network device in a namespace."""
    place = os.open(f"/var/run/netns/{namespace}", os.O_RDONLY)
    assert ctypes.CDLL(None).setns(place, 0) == 0, "needs root"
    device = os.open("/dev/net/tun", os.O_RDWR)
    fcntl.ioctl(device, SET_TUN, struct.pack("16sH22x", b"slow0", TUN))
    for command in ("addr add {}/24 dev slow0", "link set slow0 up", "link set lo up"):
        subprocess.run(["ip", *command.format(address).split()], check=True)
    return device


def _carry(source: int, target: int, bytes_per_s: float) -> None:
    """Carry packets in one direction."""
    waiting = deque[tuple[float, bytes]]()
    arrived = threading.Condition()

    def deliver() -> None:
        while True:
            with arrived:
                while not waiting:
                    arrived.wait()
                at_s, packet = waiting.popleft()
            time.sleep(max(0.0, at_s - time.monotonic()))
            os.write(target, packet)

    threading.Thread(target=deliver, daemon=True).start()
    chance = random.Random(1)
    busy_s = 0.0
    while True:
        packet = os.read(source, 1 << 16)
        now_s = time.monotonic()
        busy_s = max(busy_s, now_s)
        if (busy_s - now_s) * bytes_per_s > BUFFER:
            continue
        busy_s += len(packet) / bytes_per_s
        if chance.random() >= LOSS:
            with arrived:
                waiting.append((busy_s + DELAY_S, packet))
                arrived.notify()


def publish(way: str) -> None:
    """Publish until the standard input ends."""
    put = _foxglove() if way == "foxglove" else _zenoh(way)

    def run(topic: str) -> None:
        type, hz = TOPICS[topic]
        next_s = time.monotonic()
        while True:
            seconds, nanoseconds = divmod(time.time_ns(), 10**9)
            stamp = {"sec": seconds, "nanosec": nanoseconds}
            put[topic](encode(type, {"header": {"stamp": stamp}} | FIELDS[topic]))
            next_s += 1 / hz
            time.sleep(max(0.0, next_s - time.monotonic()))

    for topic in TOPICS:
        threading.Thread(target=run, args=(topic,), daemon=True).start()
    print("ready", flush=True)
    sys.stdin.read()


def _foxglove() -> dict[str, Callable[[bytes], None]]:
    import foxglove
    from foxglove import Channel, Schema

    foxglove.start_server(host=ROBOT, port=8765)

    def put(topic: str, type: str) -> Callable[[bytes], None]:
        schema = Schema(name=type, encoding="ros2msg", data=definition(type).encode())
        channel = Channel(topic, message_encoding="cdr", schema=schema)
        return lambda cdr: channel.log(cdr, log_time=time.time_ns())

    return {topic: put(topic, type) for topic, (type, _) in TOPICS.items()}


def _zenoh(way: str) -> dict[str, Callable[[bytes], None]]:
    import zenoh

    from webviz_sim.zenoh_wire import ZenohNode

    text = f'{{ mode: "router", listen: {{ endpoints: ["tcp/{ROBOT}:7447"] }} }}'
    if way == "priorities":
        match = re.search(
            r'```json5 title="priorities.json5"\n(.*?)```', PAGE.read_text(), re.DOTALL
        )
        assert match
        text = match[1].replace("0.0.0.0:7447", f"{ROBOT}:7447")
    zenoh_config = zenoh.Config.from_json5(text)
    for key in ("scouting/multicast/enabled", "transport/shared_memory/enabled"):
        zenoh_config.insert_json5(key, "false")
    zenoh_config.insert_json5("timestamping/enabled", "true")
    session = zenoh.open(zenoh_config)
    node = ZenohNode(session, 0, "", "robot")
    _open.extend((session, node))
    return {topic: node.publisher(type, topic).publish for topic, (type, _) in TOPICS.items()}


def watch(way: str, seconds: float) -> None:
    """Print the median and the 95th percentile of the age of the newest message by topic."""
    source = _source(way)
    newest: dict[str, float] = {}

    def note(topic: str, raw: Raw) -> None:
        sec, nanosec = struct.unpack_from("<iI", raw.cdr, 4)
        newest[topic] = sec + nanosec / 1e9

    source.inbox.read_along(lambda: note)
    source.want({t: Subscription(type, Topic(t)) for t, (type, _) in TOPICS.items()})
    while "/odom" not in newest:
        source.inbox.drain()
        time.sleep(0.05)
    began_s = time.monotonic()
    ages: dict[str, list[float]] = {topic: [] for topic in TOPICS}
    while (passed_s := time.monotonic() - began_s) < seconds:
        source.inbox.drain()
        time.sleep(0.05)
        for topic, ages_s in ages.items():
            if passed_s > BEGIN_S:
                ages_s.append(time.time() - newest.get(topic, -math.inf))
    figures = {t: [sorted(a)[int(len(a) * q)] for q in (0.5, 0.95)] for t, a in ages.items()}
    print(
        json.dumps({t: [round(age, 2) for age in both] for t, both in figures.items()}), flush=True
    )


def _source(way: str) -> Source:
    if way == "foxglove":
        from webviz.sources.bridge.address import address
        from webviz.sources.bridge.source import BridgeSource

        return BridgeSource(address(f"ws://{ROBOT}:8765"))
    from webviz.sources.zenoh.address import zenoh_address
    from webviz.sources.zenoh.source import ZenohSource

    return ZenohSource(zenoh_address(f"tcp/{ROBOT}:7447", {}))


def measure(rate: str, way: str, seconds: str) -> None:
    """Measure in namespaces of its own."""
    names = [f"webviz-{end}-{os.getpid()}" for end in ("robot", "viewer")]
    control = f"net.ipv4.tcp_congestion_control={os.environ.get('CONGESTION', 'reno')}"
    own = [sys.executable, __file__]
    started: list[subprocess.Popen[str]] = []

    def start(*command: str) -> None:
        pipe = subprocess.PIPE
        process = subprocess.Popen(command, stdin=pipe, stdout=pipe, text=True)
        started.append(process)
        assert process.stdout is not None
        if not process.stdout.readline():
            raise SystemExit(f"{command} has ended.")

    try:
        for name in names:
            subprocess.run(["ip", "netns", "add", name], check=True)
            subprocess.run(["ip", "netns", "exec", name, "sysctl", "-qw", control], check=True)
        start(*own, "shape", *names, rate)
        start("ip", "netns", "exec", names[0], *own, "publish", way)
        subprocess.run(["ip", "netns", "exec", names[1], *own, "watch", way, seconds], check=True)
    finally:
        for process in started:
            process.kill()
            process.wait()
        for name in names:
            subprocess.run(["ip", "netns", "del", name], check=False)


def main() -> None:
    """Run one of the processes, or all of them."""
    match sys.argv[1:]:
        case ["shape", robot, viewer, rate]:
            shape(robot, viewer, float(rate))
        case ["publish", way]:
            publish(way)
        case ["watch", way, seconds]:
            watch(way, float(seconds))
        case [rate, way, *rest]:
            measure(rate, way, rest[0] if rest else "30")
        case _:
            sys.exit(__doc__)
    os._exit(0)  # threads of engines do not end


if __name__ == "__main__":
    main()
