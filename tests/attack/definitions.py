"""Definitions of messages that recurse, compute, or make much of few bytes, by each door."""

from __future__ import annotations

import io
import json
import tempfile
from pathlib import Path
from random import Random

from hostile_definitions import NAME, READ, REFUSED, idl, msg, renamed
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Ros1Writer
from rosbags.rosbag2 import StoragePlugin, Writer

from tests.attack.attack import Case, mutated
from webviz.data.messages.typestore import is_idl

STRING = "std_msgs/msg/String"
TEXTS = (*(text for text, _ in REFUSED.values()), *READ.values())
DOORS = ("mcap", "db3", "bag", "foxglove", "rosbridge", "msg", "srv", "action")
MAX_TEXT = 200_000
"""Characters of a definition; longer ones take the time of other cases."""
COUNTS = ("", "0", "1", "3", "1000", "99999", "100001", "2000000000", "4294967296", "9" * 5000)
TYPES = ("uint8", "float64", "string", "string<=5", "bool", "Header", "time", "A0", "A1", "A2")
VALUES = ("1", "-1", "1e999", "'a", '"b"', "0x" + "f" * 5000, "9" * 5000, "true", "#", "[1, 2]")
EXPRESSIONS = ("1", "2", "99999999999", "B", "Evil_Constants::A", "(1)", "-1", "~1", "1.5", '"a"')
OPERATORS = ("<<", ">>", "*", "+", "-", "/", "%", "|", "^", "&")


def draw(random: Random) -> Case:
    """Has definitions read in a process of its own, and their messages used as displays do.

    The names of the files say by which door they come in.
    """
    maker = random.choice((_existing, _existing, _plain, _plain, _typed))
    text = maker(random)
    if random.random() < 0.3:
        text = mutated(random, text.encode()).decode(errors="replace")
    # A type is read once, so each case has one of its own.
    package = f"evil{random.getrandbits(48)}_msgs"
    type_, text = renamed(NAME, package), renamed(text, package)
    message = b"\0\1\0\0" + b"".join(
        random.choice((b"\0", b"\1\0\0\0", b"\xff" * 4, b"\x80\x84\x1e\0", bytes(5000)))
        for _ in range(random.randrange(20))
    )
    door = random.choice([door for door in DOORS if door != "bag" or not is_idl(text)])
    return Case(f"evil.{door}", _written(door, type_, text, message))


def _existing(random: Random) -> str:
    return random.choice([text for text in TEXTS if len(text) < MAX_TEXT])


def _plain(random: Random) -> str:
    """Return .msg text of types that contain each other, most of which is valid."""

    def line() -> str:
        if random.random() < 0.1:
            return f"{random.choice(TYPES)} C{random.randrange(9)}={random.choice(VALUES)}"
        array = f"[{random.choice(COUNTS)}]" if random.random() < 0.5 else ""
        return f"{random.choice(TYPES)}{array} a{random.randrange(30)}"

    def own() -> str:
        return "\n".join(line() for _ in range(random.choice((0, 1, 1, 2, 5))))

    return msg(own(), **{f"A{level}": own() for level in range(random.choice((3, 3, 40)))})


def _typed(random: Random) -> str:
    """Return IDL with expressions."""

    def expression() -> str:
        parts = [random.choice(EXPRESSIONS)]
        for _ in range(random.choice((0, 1, 3, 200))):
            parts += [random.choice(OPERATORS), random.choice(EXPRESSIONS)]
        depth = random.choice((0, 0, 2, 5, 15, 17, 2000))
        return "(" * depth + " ".join(parts) + ")" * depth

    member = random.choice((f"long a[{expression()}]", f"sequence<long, {expression()}> a"))
    member = random.choice((member, "string a", f"@default (value={expression()}) long a", "A0 a"))
    return idl(
        f"const long B = {expression()};"
        f" module Evil_Constants {{ const long A = {expression()}; }};"
        f" typedef long A0[{expression()}]; struct Evil {{ {member}; }};"
    )


def _written(door: str, type_: str, text: str, message: bytes) -> bytes:
    """Return the file that brings a definition in, and beside it a topic of texts."""
    if door == "mcap":
        return _mcap(type_, text, message)
    if door in ("db3", "bag"):
        with tempfile.TemporaryDirectory() as folder:
            write = _db3 if door == "db3" else _ros1
            return write(Path(folder) / "evil", type_, text, message).read_bytes()
    return json.dumps({"type": type_, "text": text, "message": message.hex()}).encode()


def _mcap(type_: str, text: str, message: bytes) -> bytes:
    file = io.BytesIO()
    writer = McapWriter(file)
    writer.start("ros2", "test")
    for topic, name, own, data in _topics(type_, text, message):
        kind = "ros2idl" if is_idl(own) else "ros2msg"
        channel = writer.register_channel(
            topic, "cdr", writer.register_schema(name, kind, own.encode())
        )
        writer.add_message(channel, 1, data, 1)
    writer.finish()
    return file.getvalue()


def _db3(path: Path, type_: str, text: str, message: bytes) -> Path:
    with Writer(path, version=9, storage_plugin=StoragePlugin.SQLITE3) as writer:
        for topic, name, own, data in _topics(type_, text, message):
            rihs = f"RIHS01_{'0' * 64}"
            connection = writer.add_connection(topic, name, msgdef=own, rihs01=rihs)
            writer.write(connection, 1, data)
    (file,) = path.glob("*.db3")
    return file


def _ros1(path: Path, type_: str, text: str, message: bytes) -> Path:
    with Ros1Writer(path) as writer:
        for topic, name, own, data in _topics(type_, text, message):
            connection = writer.add_connection(topic, name, msgdef=own, md5sum="0" * 32)
            writer.write(connection, 1, data[4:])
    return path


def _topics(type_: str, text: str, message: bytes) -> list[tuple[str, str, str, bytes]]:
    words = "/words", STRING, "string data", b"\0\1\0\0\6\0\0\0hello\0"
    return [("/evil", type_, text, message), words]
