"""Opening, seeking and playing of a large bag, next to plain readers, in one run.

    python tests/benchmarks/bench_bags.py BAG --gigabytes 5

The large bag is the given one, repeated at later times with its stamps, in a temporary folder that
is deleted at the end. A seek of webviz takes until the frame loop has drawn every display of the
bag; the link to a browser is not included. The plain readers only fetch, for the same times, all
messages of the last second: no map of an hour ago, and no transforms. They take turns with webviz.
"""

from __future__ import annotations

import argparse
import random
import resource
import statistics
import tempfile
import time
from collections.abc import Callable, Sequence
from contextlib import closing
from pathlib import Path

from long_bag import SECOND, drive_of, write_mcap
from mcap.reader import make_reader
from rosbags.highlevel import AnyReader
from rosbags.typesys import Stores, get_typestore

from webviz.commands import Seek
from webviz.data.recordings import open_recording
from webviz.shell.testing import BagViewer

NEAR_S = 3.0
"""Distance in seconds of consecutive positions of a drag."""
PLAYED_S = 60.0


def timed(action: Callable[[], object]) -> float:
    """Milliseconds that something takes."""
    began = time.perf_counter()
    action()
    return 1e3 * (time.perf_counter() - began)


def report(name: str, milliseconds: Sequence[float]) -> None:
    """Print the median, the 99th percentile and the longest of some times."""
    ordered = sorted(milliseconds)
    last = ordered[min(len(ordered) - 1, round(0.99 * len(ordered)))]
    median = statistics.median(ordered)
    print(f"{name:32} {median:8.1f} {last:8.1f} {ordered[-1]:8.1f}")


def memory_mb() -> float:
    """The most memory that this process has held."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def measure(path: Path, count: int) -> None:
    """Print what one bag takes."""
    print(f"\n{path.name}, {path.stat().st_size / 1e9:.1f} GB      median      p99  longest   ms")
    viewers: list[BagViewer] = []
    report("webviz: open", [timed(lambda: viewers.append(BagViewer(path)))])
    with closing(viewers[0]) as viewer:
        chance = random.Random(1)
        duration_s = (viewer.source.history.end_ns - viewer.source.history.start_ns) / 1e9
        report("webviz: first seek, with meshes", [timed(lambda: viewer.do(Seek(duration_s / 3)))])
        times = [chance.uniform(0, duration_s) for _ in range(count)]
        readers = {
            "webviz: seek": lambda at_s: viewer.do(Seek(at_s)),
            **{name: make(path) for name, make in READERS.items()},
        }
        durations: dict[str, list[float]] = {name: [] for name in readers}
        for at_s in times:
            for name, read in readers.items():
                durations[name].append(timed(lambda read=read, at_s=at_s: read(at_s)))
        for name, each in durations.items():
            report(name, each)
        at_s, dragged = duration_s / 2, []
        for _ in range(count):
            at_s += chance.uniform(-NEAR_S, NEAR_S)
            dragged.append(timed(lambda: viewer.do(Seek(at_s))))  # noqa: B023
        report("webviz: seek nearby, as in a drag", dragged)
        played = timed(lambda: viewer.play_to(at_s + PLAYED_S))
        print(f"webviz plays {PLAYED_S / (played / 1e3):.0f} times as fast as recorded", end=", ")
        print(f"{memory_mb():.0f} MB at most, plain readers included")


def by_mcap(path: Path) -> Callable[[float], object]:
    """Read by the `mcap` library."""
    file = path.open("rb")
    reader = make_reader(file)
    summary = reader.get_summary()
    assert summary is not None
    assert summary.statistics is not None
    start_ns = summary.statistics.message_start_time

    def read(at_s: float) -> object:
        at_ns = start_ns + round(at_s * SECOND)
        result = reader.iter_messages(starting_at=at_ns - SECOND, ending_at=at_ns)
        return {channel.topic: message for _, channel, message in result}

    return read


def by_rosbags(path: Path) -> Callable[[float], object]:
    """Read by rosbags."""
    reader = AnyReader([path], default_typestore=get_typestore(Stores.ROS2_JAZZY))
    reader.open()

    def read(at_s: float) -> object:
        at_ns = reader.start_time + round(at_s * SECOND)
        result = reader.messages(start=at_ns - SECOND, stop=at_ns + 1)
        return {connection.topic: data for connection, _, data in result}

    return read


def by_recording(path: Path) -> Callable[[float], object]:
    """Read by webviz's own reader."""
    recording = open_recording(path)
    assert recording.span_ns is not None
    start_ns = recording.span_ns[0]

    def read(at_s: float) -> object:
        at_ns = start_ns + round(at_s * SECOND)
        result = recording.messages(recording.channels, at_ns - SECOND, at_ns)
        return {each.channel.topic: each.data for each in result}

    return read


READERS: dict[str, Callable[[Path], Callable[[float], object]]] = {
    "webviz's reader: 1 s of messages": by_recording,
    "mcap library: 1 s of messages": by_mcap,
    "rosbags: 1 s of messages": by_rosbags,
}


def main() -> None:
    """Write the bags, and measure."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("bag", type=Path)
    parser.add_argument("--gigabytes", type=float, default=5.0)
    parser.add_argument("--seeks", type=int, default=100)
    options = parser.parse_args()
    drive = drive_of(options.bag)
    with tempfile.TemporaryDirectory(prefix="webviz-bench-") as folder:
        path = Path(folder) / "large.mcap"
        write_mcap(path, drive, round(options.gigabytes * 1e9))
        measure(path, options.seeks)


if __name__ == "__main__":
    main()
