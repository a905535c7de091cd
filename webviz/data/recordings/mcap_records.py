"""Records of MCAP files (https://mcap.dev/spec): an opcode, a length of 8 bytes, and fields."""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import NamedTuple

from webviz.data.recordings.recording import DEFINITION_ENCODINGS, BrokenRecord

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK = range(1, 7)
MESSAGE_INDEX, CHUNK_INDEX, ATTACHMENT, STATISTICS, METADATA = 0x07, 0x08, 0x09, 0x0B, 0x0C
DATA_END, DATA_END_SIZE = 0x0F, 4
LAST_OPCODE, FIRST_PRIVATE_OPCODE = 0x0F, 0x80
PREFIX = struct.Struct("<BQ")
"""Opcode and length of each record."""
MESSAGE_FIELDS = struct.Struct("<HIQQ")
"""Channel, sequence number, time of recording and of publication; the data follows."""
END_SIZE = PREFIX.size + 20 + len(MAGIC)
"""Size in bytes of footer and magic."""
FOREVER_NS = 2**63 - 1
"""The last stamp that is read: int64 is the type of ROS's times."""


class RecordFields:
    """The fields of a record, read one after the other.

    Raises:
        BrokenRecord: by all methods: the record ends before the field does.
    """

    def __init__(self, data: bytes) -> None:
        self._data = data
        self._at = 0

    def numbers(self, kinds: str) -> tuple[int, ...]:
        """Integers of these kinds of `struct`, little-endian."""
        layout = struct.Struct(f"<{kinds}")
        return layout.unpack(self._take(layout.size))

    def block(self) -> bytes:
        """Bytes with their length."""
        (size,) = self.numbers("I")
        return self._take(size)

    def text(self) -> str:
        """Return a text; what is not UTF-8 becomes replacement characters."""
        return self.block().decode(errors="replace")

    def _take(self, size: int) -> bytes:
        start, self._at = self._at, self._at + size
        if self._at > len(self._data):
            raise BrokenRecord
        return self._data[start : self._at]


class McapSchema(NamedTuple):
    """Name of a message type and its definition, "" if there is none that is read."""

    name: str
    definition: str


def schema_of(fields: RecordFields) -> tuple[int, McapSchema]:
    """Id and contents of a schema."""
    (number,) = fields.numbers("H")
    name, encoding, definition = fields.text(), fields.text(), fields.text()
    return number, McapSchema(name, definition if encoding in DEFINITION_ENCODINGS else "")


class McapChannel(NamedTuple):
    """A channel as it is recorded: the id of its schema, topic, encoding, and QoS as YAML."""

    schema: int
    topic: str
    encoding: str
    profiles: str


def channel_of(fields: RecordFields) -> tuple[int, McapChannel]:
    """Id and contents of a channel."""
    number, schema = fields.numbers("HH")
    topic, encoding = fields.text(), fields.text()
    metadata, profiles = RecordFields(fields.block()), ""
    try:
        while True:
            key, value = metadata.text(), metadata.text()
            profiles = value if key == "offered_qos_profiles" else profiles
    except BrokenRecord:  # its end
        pass
    return number, McapChannel(schema, topic, encoding, profiles)


def records_of(data: bytes) -> Iterator[tuple[int, RecordFields]]:
    """Opcode and fields of the records in some bytes.

    Raises:
        BrokenRecord: they are damaged from there on.
    """
    at = 0
    while at + PREFIX.size <= len(data):
        opcode, length = PREFIX.unpack_from(data, at)
        start = at + PREFIX.size
        at = start + length
        if not opcode or at > len(data):
            raise BrokenRecord
        yield opcode, RecordFields(data[start:at])
