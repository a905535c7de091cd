"""Ways to a robot side by side: DDS, Zenoh and Foxglove's protocol, on the same messages.

    PYTHONPATH=tests/benchmarks:sim python tests/benchmarks/ways.py [SECONDS [ROUNDS]]
    PYTHONPATH=tests/benchmarks:sim python tests/benchmarks/ways.py robots 50

A process publishes a scan at 10 Hz, transforms at 50 Hz and a cloud of 100 000 points (1.6 MB) at
5 Hz, stamped with the time of publication. Another has the source of a viewer and nothing else:
latency is from publication to the inbox, processor time that of each process, in percent of one
core. Over Zenoh a router of a third process lies in between; Foxglove's server is in the publishing
process itself, so it has no bridge that reads DDS first. Ways take turns; figures are medians of
the rounds.

The second has so many robots in namespaces, each with the scan and the transforms in a session of
its own, over one router and one session of the viewer. Memory is private memory: on one host the
engine passes large messages in shared memory, 16 MB for each robot.
"""

from __future__ import annotations

import json
import os
import statistics
import struct
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any

from webviz.api.declared import Topic
from webviz.data.messages import definition, encode
from webviz.sources import Raw, Source, Subscription

TYPES = {
    "/scan": "sensor_msgs/msg/LaserScan",
    "/tf": "tf2_msgs/msg/TFMessage",
    "/points": "sensor_msgs/msg/PointCloud2",
}
HZ = {"/scan": 10, "/tf": 50, "/points": 5}
POINTS = 100_000
STAMP = {"/scan": 4, "/tf": 8, "/points": 4}
"""Offset of the stamp in the serialised message, whose sequence of transforms comes first."""
WAYS = ("dds", "zenoh", "foxglove")
PROCESSOR = "processor"


def messages() -> dict[str, bytearray]:
    """Return the messages, whose stamps are written anew each time."""
    field = [
        {"name": name, "offset": 4 * at, "datatype": 7, "count": 1}
        for at, name in enumerate(("x", "y", "z", "intensity"))
    ]
    cloud = {
        "header": {"frame_id": "map"},
        "height": 1,
        "width": POINTS,
        "fields": field,
        "point_step": 16,
        "row_step": 16 * POINTS,
        "data": bytes(16 * POINTS),
    }
    links = [{"header": {"frame_id": "map"}, "child_frame_id": f"link_{n}"} for n in range(30)]
    scan = {"header": {"frame_id": "laser"}, "ranges": [1.0] * 720, "intensities": [1.0] * 720}
    values: dict[str, Any] = {"/scan": scan, "/tf": {"transforms": links}, "/points": cloud}
    return {topic: bytearray(encode(TYPES[topic], value)) for topic, value in values.items()}


def publishing(way: str, endpoint: str) -> Callable[[str, bytes], object]:
    """Return a function that publishes a message of a topic."""
    if way == "zenoh":
        from webviz_sim.zenoh_wire import ZenohNode, open_session

        node = ZenohNode(open_session("client", endpoint), 0, "", "bench")
        CHANNELS["node"] = node  # which has the session
        publishers: dict[str, Any] = {topic: node.publisher(TYPES[topic], topic) for topic in TYPES}
        return lambda topic, cdr: publishers[topic].publish(cdr)
    if way == "dds":
        import rclpy
        from rclpy.node import Node

        from webviz.ros.types import message_class

        rclpy.init()
        ros = Node("bench")
        publishers = {t: ros.create_publisher(message_class(TYPES[t]), t, 10) for t in TYPES}
        return lambda topic, cdr: publishers[topic].publish(cdr)
    import foxglove  # pyright: ignore[reportMissingImports]

    server = foxglove.start_server(host="127.0.0.1", port=0)
    for topic, type in TYPES.items():
        schema = foxglove.Schema(name=type, encoding="ros2msg", data=definition(type).encode())
        made_here = foxglove.Channel(topic, message_encoding="cdr", schema=schema)
        CHANNELS[topic] = made_here
    print(f"ws://127.0.0.1:{server.port}", flush=True)
    return lambda topic, cdr: CHANNELS[topic].log(cdr, log_time=time.time_ns())


CHANNELS: dict[str, Any] = {}
"""Publishers that live as long as the process."""


def publish(way: str, endpoint: str) -> None:
    """Publish until standard input closes; then print the processor time."""
    send, payloads = publishing(way, endpoint), messages()
    due = dict.fromkeys(TYPES, time.monotonic())
    ended = False
    os.set_blocking(sys.stdin.fileno(), False)
    while not ended:
        topic = min(due, key=due.__getitem__)
        time.sleep(max(0.0, due[topic] - time.monotonic()))
        due[topic] += 1 / HZ[topic]
        now = time.time_ns()
        struct.pack_into("<iI", payloads[topic], STAMP[topic], now // 10**9, now % 10**9)
        send(topic, bytes(payloads[topic]))
        ended = sys.stdin.buffer.read(1) == b""
    print(json.dumps({PROCESSOR: time.process_time()}), flush=True)
    os._exit(0)


def publish_fleet(endpoint: str, robots: int) -> None:
    """Publish scans and transforms of many robots until the process is killed."""
    from webviz_sim.zenoh_wire import ZenohNode, open_session

    topics = ("/scan", "/tf")
    payloads = {topic: bytes(data) for topic, data in messages().items()}
    nodes = []
    for number in range(robots):
        space = f"/robot{number}"
        node = ZenohNode(open_session("client", endpoint), 0, space, "base")
        nodes.append((node, {t: node.publisher(TYPES[t], t[1:]) for t in topics}))
    print("ready", flush=True)
    tick = 0
    due = time.monotonic()
    while True:
        for _, publishers in nodes:
            publishers["/tf"].publish(payloads["/tf"])
            if tick % 5 == 0:
                publishers["/scan"].publish(payloads["/scan"])
        tick, due = tick + 1, due + 1 / HZ["/tf"]
        time.sleep(max(0.0, due - time.monotonic()))


def watch_fleet(address: str, robots: int, seconds: float) -> None:
    """Have one source for all robots; print what arrived, processor time and memory."""
    import psutil

    from webviz.shell.live_source import bridge_source

    source = bridge_source(address)
    base = psutil.Process().memory_full_info().uss
    topics = ("/scan", "/tf")
    names = [(f"/robot{n}{topic}", TYPES[topic]) for n in range(robots) for topic in topics]
    source.want({name: Subscription(type, Topic(name)) for name, type in names})
    while sum(count > 0 for count, _ in source.inbox.received().values()) < len(names):
        time.sleep(0.05)
        source.inbox.drain()
    before = sum(count for count, _ in source.inbox.received().values())
    began, used = time.monotonic(), time.process_time()
    while time.monotonic() < began + seconds:
        time.sleep(1 / 60)
        source.inbox.drain()
    took = time.monotonic() - began
    count = sum(count for count, _ in source.inbox.received().values()) - before
    memory = (psutil.Process().memory_full_info().uss - base) >> 20
    share = 100 * (time.process_time() - used) / took
    expected = robots * (HZ["/scan"] + HZ["/tf"])
    print(
        f"{robots} robots: {count / took:.0f} of {expected} messages/s, viewer {share:.0f} %, "
        f"{memory} MB more than without robots",
        flush=True,
    )
    os._exit(0)


def measure_fleet(robots: int) -> None:
    """Print the figures of a fleet."""
    router = started(module="webviz_sim.zenoh_router")
    address = _line(router)
    fleet = started("publish_fleet", address, str(robots))
    _line(fleet)
    watcher = started("watch_fleet", address, str(robots), "8")
    print(_line(watcher))
    for process in (watcher, fleet, router):
        process.kill()
        process.wait()


def watch(address: str, seconds: float) -> None:
    """Have a source of a viewer; print latencies in milliseconds and the processor time."""
    source: Source
    if address:
        from webviz.shell.live_source import bridge_source

        source = bridge_source(address)
    else:
        from webviz.shell.live_source import ros_source

        source = ros_source()
    delays: dict[str, list[float]] = {topic: [] for topic in TYPES}

    def note(topic: str, raw: Raw) -> None:
        stamp = struct.unpack_from("<iI", raw.cdr, STAMP[topic])
        delays[topic].append((time.time_ns() - stamp[0] * 10**9 - stamp[1]) / 1e6)

    source.inbox.read_along(lambda: note)
    source.want({topic: Subscription(type, Topic(topic)) for topic, type in TYPES.items()})
    while not all(delays.values()):
        time.sleep(0.05)
        source.inbox.drain()
    time.sleep(1)
    for each in delays.values():
        each.clear()
    began, used = time.monotonic(), time.process_time()
    while time.monotonic() < began + seconds:
        time.sleep(1 / 60)  # as the frame loop empties it
        source.inbox.drain()
    result: dict[str, Any] = {PROCESSOR: 100 * (time.process_time() - used) / seconds}
    for topic, each in delays.items():
        ordered = sorted(each)
        share = len(each) / (HZ[topic] * seconds)
        result[topic] = ordered[len(each) // 2], ordered[int(len(each) * 0.99)], share
    print(json.dumps(result), flush=True)
    os._exit(0)


def started(*arguments: str, module: str = "") -> subprocess.Popen[str]:
    """Start a process of this benchmark, or a module."""
    command = [sys.executable, "-m", module] if module else [sys.executable, __file__, *arguments]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def measure(way: str, seconds: float) -> dict[str, Any]:
    """Return the figures of one round of a way."""
    processes: list[subprocess.Popen[str]] = []
    address = ""
    if way == "zenoh":
        processes.append(started(module="webviz_sim.zenoh_router"))
        address = _line(processes[-1])
    publisher = started("publish", way, address)
    processes.append(publisher)
    if way == "foxglove":
        address = _line(publisher)
    watcher = started("watch", address, str(seconds))
    processes.append(watcher)
    began = time.monotonic()
    result = json.loads(_line(watcher))
    assert publisher.stdin is not None
    publisher.stdin.close()
    report = json.loads(_line(publisher))
    result["publisher"] = 100 * report[PROCESSOR] / (time.monotonic() - began)
    for process in processes:
        process.kill()
        process.wait()
        for pipe in (process.stdin, process.stdout):
            if pipe is not None:
                pipe.close()
    return result


def _line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline().strip()


def main(seconds: float = 10.0, rounds: int = 3) -> None:
    """Print the table of all ways."""
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    results = [{way: measure(way, seconds) for way in WAYS} for _ in range(rounds)]
    print(
        "| | scan p50 / p99 | frames p50 / p99 | 100 000 points p50 / p99 | received | viewer | "
        "publisher |\n|---|---|---|---|---|---|---|"
    )
    for way in WAYS:
        cells = []
        for topic in ("/scan", "/tf", "/points"):
            p50, p99 = (statistics.median(r[way][topic][at] for r in results) for at in (0, 1))
            cells.append(f"{p50:.1f} / {p99:.1f} ms")
        shares = [r[way][topic][2] for r in results for topic in TYPES]
        cells.append(f"{100 * min(1.0, statistics.mean(shares)):.0f} %")
        for name in (PROCESSOR, "publisher"):
            cells.append(f"{statistics.median(r[way][name] for r in results):.0f} %")
        print(f"| {way} | {' | '.join(cells)} |")


if __name__ == "__main__":
    match sys.argv[1:]:
        case ["publish", way, *rest]:
            publish(way, "".join(rest))
        case ["watch", address, seconds]:
            watch(address, float(seconds))
        case ["publish_fleet", endpoint, robots]:
            publish_fleet(endpoint, int(robots))
        case ["watch_fleet", address, robots, seconds]:
            watch_fleet(address, int(robots), float(seconds))
        case ["robots", robots]:
            measure_fleet(int(robots))
        case arguments:
            seconds, rounds = [*map(int, arguments), *(10, 3)[len(arguments) :]]
            main(seconds, rounds)
