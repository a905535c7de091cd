"""Names that command a terminal or forge its lines, in bags that commands report on."""

from __future__ import annotations

import struct
from random import Random

from mcap_files import MAGIC, record, text

from tests.attack.attack import Case
from webviz.data.messages import definition, encode
from webviz.shell.testing.messages import stamped_transform

TF = "tf2_msgs/msg/TFMessage"
LOG = "rcl_interfaces/msg/Log"
PARTS = (
    *("\x1b[2J", "\x1b]0;x\x07", "\x9b31m", "\r", "\n", "\r\n", "\x0b", "\x85", "\u2028", "\u2029"),
    *("\u202e", "\u2066", "\u061c", "\x7f", "<b>", "&", "%s", "{0}", "'", '"', " ", "/"),
    *("map", "base", "forged", "x" * 300, "\u00e9", "\U0001f916", "\ufeff"),
)


def draw(random: Random) -> Case:
    """Reports on such bags as `webviz frames` and `webviz doctor` do."""
    names = [_name(random) for _ in range(random.randint(2, 8))]
    content = bytearray(MAGIC + record(1, text("ros2") + text("by hand")))
    topics = {"/tf": TF, random.choice(("/rosout", f"/{_name(random)}")): LOG}
    for number, (topic, type_name) in enumerate(topics.items(), 1):
        schema = text(type_name) + text("ros2msg") + text(definition(type_name))
        content += record(3, struct.pack("<H", number) + schema)
        channel = text(topic) + text("cdr") + text(b"")
        content += record(4, struct.pack("<HH", number, number) + channel)
    for index in range(20):
        stamp_ns = 10**18 + index * 10**8
        parent, child = random.choice(names), random.choice(names)
        transform = stamped_transform(parent, child, stamp_ns)
        content += _record(1, stamp_ns, encode(TF, {"transforms": [transform]}))
        log = {"level": 40, "name": random.choice(names), "msg": random.choice(names)}
        content += _record(2, stamp_ns, encode(LOG, log))
    return Case(
        "names.reported", bytes(content + record(15, bytes(4)) + record(2, bytes(20))) + MAGIC
    )


def _name(random: Random) -> str:
    return "n" + "".join(random.choice(PARTS) for _ in range(random.randint(1, 6)))


def _record(channel: int, stamp_ns: int, cdr: bytes) -> bytes:
    return record(5, struct.pack("<HIQQ", channel, 0, stamp_ns, stamp_ns) + cdr)
