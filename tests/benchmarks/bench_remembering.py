"""Cost of the memory of live topics at 20 MB/s, beside the same without a memory, in one run.

Messages are fed to the inbox of a viewer whose frame loop runs at 60 Hz: clouds of 1 MB at 19 Hz,
and 1000 small messages a second. Reported are the share of a core that the whole process takes, and
how long a message takes from its arrival until the frame loop has it.

    .venv/bin/python tests/benchmarks/bench_remembering.py
"""

from __future__ import annotations

import argparse
import statistics
import time

from webviz.engine.loop import FrameLoop
from webviz.files.config import Config, Settings
from webviz.files.config.model import MemorySettings
from webviz.shell.testing.recording import RecordingScene
from webviz.shell.testing.source import HandFedSource
from webviz.sources import Offer, Publisher, Raw

CLOUD, SMALL = "/cloud", "/tf_like"
CLOUD_BYTES, CLOUD_HZ = 1_000_000, 19
SMALL_BYTES, SMALL_HZ = 500, 1000
TYPE = "std_msgs/msg/String"
STEP_S = 1 / 60
MEMORY = MemorySettings()
NAME = f"{MEMORY.seconds:g} s, {MEMORY.megabytes:g} MB"


def fed(seconds: float, memory: MemorySettings) -> tuple[float, float]:
    """The share of a core in percent, and the 99th percentile of the latency in ms."""
    source = HandFedSource()
    for topic in (CLOUD, SMALL):
        publisher = Publisher("/robot", TYPE, "reliable", "volatile")
        source.known[topic] = Offer((publisher,), ("reliable", "volatile"), type=TYPE)
        source.inbox.open(topic, 1000)
    settings = Settings(memory=memory)
    loop = FrameLoop(Config(settings), source, RecordingScene())
    loop.turn()
    cloud, small = bytearray(CLOUD_BYTES), bytearray(SMALL_BYTES)
    for _ in range(round(memory.megabytes) + 10 if memory.seconds else 0):  # until it is full
        source.inbox.put(CLOUD, Raw(bytes(cloud), time.time_ns()))
        loop.turn()
    latencies: list[float] = []
    clouds = smalls = 0
    used_s, began_s = time.process_time(), time.monotonic()
    while (passed_s := time.monotonic() - began_s) < seconds:
        # Copied before: that takes longer where no message was freed meanwhile.
        arrived: list[tuple[str, bytes]] = []
        while clouds < passed_s * CLOUD_HZ:
            arrived.append((CLOUD, bytes(cloud)))
            clouds += 1
        while smalls < passed_s * SMALL_HZ:
            arrived.append((SMALL, bytes(small)))
            smalls += 1
        put_s = time.monotonic()
        for topic, cdr in arrived:
            source.inbox.put(topic, Raw(cdr, time.time_ns()))
        loop.turn()
        latencies.append((time.monotonic() - put_s) * 1e3)
        time.sleep(max(0.0, STEP_S - (time.monotonic() - put_s)))
    used_s = time.process_time() - used_s
    loop.close()
    return 100 * used_s / seconds, statistics.quantiles(latencies, n=100)[98]


def main() -> None:
    """Print the medians of some rounds, each with and without a memory."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=8.0)
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    found: dict[str, list[tuple[float, float]]] = {"no memory": [], NAME: []}
    for _ in range(arguments.rounds):
        for name, memory in (
            ("no memory", MemorySettings(seconds=0)),
            (NAME, MEMORY),
        ):
            found[name].append(fed(arguments.seconds, memory))
    for name, rounds in found.items():
        cpu, latency = (statistics.median(each) for each in zip(*rounds, strict=True))
        print(f"{name:>14}: {cpu:5.2f} % of a core, latency p99 {latency:5.2f} ms")


if __name__ == "__main__":
    main()
