"""Bags whose clock jumps by years, goes back, stands still, or exceeds what a stamp may hold."""

from __future__ import annotations

import struct
from random import Random

from mcap_files import MAGIC, record, text

from tests.attack.attack import Case, mutated
from webviz.data.messages import definition, encode
from webviz.shell.testing.messages import stamped_transform

TF = "tf2_msgs/msg/TFMessage"
CLOCK = "rosgraph_msgs/msg/Clock"
TYPES = {"/tf": TF, "/clock": CLOCK, "/marker": "visualization_msgs/msg/Marker"}
STARTS_NS = (0, 1, 1_000, 10**9, 17 * 10**17, 2**62, 2**63 - 10**9, 2**63 - 1, 2**63, 2**64 - 1)
STEPS_NS = (0, 1, 10**6, 10**8, 10**9, 3600 * 10**9, 10**14, 10**17, 10**18)


def draw(random: Random) -> Case:
    """Examines, reads and plays such bags as the commands do."""
    content = bytearray(MAGIC + record(1, text("ros2") + text("by hand")))
    for number, (topic, type_name) in enumerate(TYPES.items(), 1):
        schema = text(type_name) + text("ros2msg") + text(definition(type_name))
        content += record(3, struct.pack("<H", number) + schema)
        channel = text(topic) + text("cdr") + text(b"")
        content += record(4, struct.pack("<HH", number, number) + channel)
    at_ns = random.choice(STARTS_NS)
    step_ns = 10**8
    for index in range(random.randint(1, 60)):
        content += _message(random, at_ns, index)
        if random.random() < 0.1:  # a jump
            step_ns = random.choice(STEPS_NS) * random.choice((1, 1, -1))
        elif random.random() < 0.3:
            step_ns = 10**8
        at_ns = min(max(at_ns + step_ns, 0), 2**64 - 1)
    content += record(15, bytes(4))
    content += record(2, bytes(20)) + MAGIC
    data = bytes(content)
    return Case("clock.examined", mutated(random, data) if random.random() < 0.2 else data)


def _message(random: Random, at_ns: int, index: int) -> bytes:
    channel = random.choice((1, 1, 2, 3)) if index else 1
    stamp_ns = max(0, min(at_ns, (2**31 - 1) * 10**9) + random.choice((0, 0, 0, -(10**9), 10**15)))
    stamp_ns = min(stamp_ns, (2**31 - 1) * 10**9)
    sec, nanosec = divmod(stamp_ns, 10**9)
    stamp = {"sec": sec, "nanosec": nanosec}
    topic = list(TYPES)[channel - 1]
    match topic:
        case "/tf":
            values: object = {"transforms": [stamped_transform("map", "base", stamp_ns)]}
        case "/clock":
            values = {"clock": stamp}
        case _:
            values = {"header": {"frame_id": "base", "stamp": stamp}, "scale": {"x": 1.0}}
    cdr = encode(TYPES[topic], values)
    return record(5, struct.pack("<HIQQ", channel, index, at_ns, at_ns) + cdr)
