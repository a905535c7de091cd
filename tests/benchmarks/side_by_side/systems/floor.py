"""The floor: a raw rclpy subscriber that only notes when a message is there.

    python -m side_by_side.systems.floor FILE TOPIC=TYPE...

Nothing that goes through ROS can be faster in Python, and it draws nothing.
"""

from __future__ import annotations

import contextlib
import sys
import time
from functools import partial
from pathlib import Path

import rclpy
from rclpy.node import Node

from side_by_side.log import RECORD
from side_by_side.streams import STAMP
from side_by_side.systems.arguments import LATCHED, parsed
from webviz.ros.types import message_class

STAMP_AT = {"tf2_msgs/msg/TFMessage": 8, "std_msgs/msg/String": None}
"""Offset of the stamp, behind the length of a list; others begin with it, after 4 bytes for the
encoding."""


def main(file: str, *topics: str) -> None:
    """Run until it is ended."""
    out = Path(file).open("wb", buffering=0)  # noqa: SIM115  open as long as the process runs
    rclpy.init()
    node = Node("floor")

    def arrive(stamp_at: int | None, cdr: bytes) -> None:
        now = time.time_ns()
        if stamp_at is not None:
            sec, nanosec = STAMP.unpack_from(cdr, stamp_at)
            out.write(RECORD.pack(0, 0, sec * 1_000_000_000 + nanosec, now))

    for topic, kind in parsed(topics).items():
        callback = partial(arrive, STAMP_AT.get(kind, 4))
        qos = LATCHED.get(topic, 10)
        node.create_subscription(message_class(kind), topic, callback, qos, raw=True)
    print("listening", flush=True)
    with contextlib.suppress(KeyboardInterrupt):
        rclpy.spin(node)


if __name__ == "__main__":
    main(*sys.argv[1:])
