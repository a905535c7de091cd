"""Publishes a scene until it is ended: `python -m side_by_side.publisher SCENE LOG`.

The log has a record for each publication of a marked stream: lane, publication, the stamp in the
message and the time right before it is handed to rclpy, both in ns. Stamps are unique,
and whole microseconds, which seconds in a float64 still tell.
"""

from __future__ import annotations

import heapq
import itertools
import signal
import sys
import threading
import time
from pathlib import Path

import rclpy
import rclpy.utilities
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.signals import SignalHandlerOptions

from side_by_side.log import RECORD
from side_by_side.scenes import SCENES
from side_by_side.streams import Stream
from webviz.ros.types import message_class

PREFILL_HZ = 2000


class Publications:
    """Everything of a scene, with numbers, stamps and a log."""

    def __init__(self, node: Node, streams: list[Stream], log: Path) -> None:
        self._publishers = [(stream, _publisher(node, stream)) for stream in streams]
        self._log = log.open("wb", buffering=0)
        self._numbers = [0] * len(streams)
        self._last_stamp = 0

    def publish(self, index: int) -> None:
        """The next publication of a stream."""
        stream, publisher = self._publishers[index]
        number = self._numbers[index]
        self._numbers[index] += 1
        stamp = max(time.time_ns() // 1000, self._last_stamp // 1000 + 1) * 1000
        self._last_stamp = stamp
        message = stream.publication(number, stamp)
        now = time.time_ns()
        publisher.publish(message)
        if stream.lane is not None:
            self._log.write(RECORD.pack(stream.lane.number, number, stamp, now))

    def run(self, stop: threading.Event) -> None:
        """Publish at the rates of the streams, latched ones first."""
        streams = [stream for stream, _ in self._publishers]
        for index, stream in enumerate(streams):
            if stream.is_latched:
                self.publish(index)
        for index, stream in enumerate(streams):
            if stream.prefill:
                self._prefill(index, stream.prefill, stop)
        print("steady", flush=True)
        start = time.monotonic()
        due = [(start, index) for index, stream in enumerate(streams) if stream.hz]
        heapq.heapify(due)
        while not stop.is_set():
            if not due:
                stop.wait()
                break
            when, index = heapq.heappop(due)
            if stop.wait(max(0.0, when - time.monotonic())):
                break
            self.publish(index)
            # Where the machine does not keep up, publications are left out, not made up for.
            period = 1 / streams[index].hz
            heapq.heappush(due, (max(when + period, time.monotonic() - period), index))

    def _prefill(self, index: int, count: int, stop: threading.Event) -> None:
        publisher = self._publishers[index][1]
        while not publisher.get_subscription_count() and not stop.wait(0.05):
            pass
        for _ in itertools.repeat(None, count):
            if stop.wait(1 / PREFILL_HZ):
                return
            self.publish(index)


def _publisher(node: Node, stream: Stream) -> Publisher:
    qos = QoSProfile(depth=1 if stream.is_latched else 1000 if stream.prefill else 5)
    if stream.is_latched:
        qos.durability = DurabilityPolicy.TRANSIENT_LOCAL
    return node.create_publisher(message_class(stream.type), stream.topic, qos)


def main(scene: str, log: str) -> None:
    """Run until SIGINT or SIGTERM."""
    stop = threading.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda *_: stop.set())
    streams = SCENES[scene].streams
    for stream in streams:
        stream.templates  # noqa: B018  made before the first is published
    rclpy.init(signal_handler_options=SignalHandlerOptions.NO)
    node = Node("publisher")
    print("publishing", flush=True)
    Publications(node, streams, Path(log)).run(stop)
    node.destroy_node()
    rclpy.utilities.try_shutdown()


if __name__ == "__main__":
    main(*sys.argv[1:])
