"""Records of ROS 1 bags: named fields, and data. See https://wiki.ros.org/Bags/Format/2.0."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

from webviz.data.recordings.recording import BrokenRecord

MESSAGE, BAG, INDEX, CHUNK, CHUNK_INFO, CONNECTION = (bytes([op]) for op in range(2, 8))
"""Kinds of records, in their field `op`."""
MAX_FIELDS = 1 << 16
"""Bytes of the fields of a record; real ones have under 300."""
SIZE = 4
"""Bytes of the size before fields, before each field, and before the data."""


class Ros1Record(NamedTuple):
    """The fields of a record, and where its data begins and ends."""

    fields: Mapping[bytes, bytes]
    start: int
    end: int

    @property
    def kind(self) -> bytes:
        """One of `MESSAGE`, `BAG`, `INDEX`, `CHUNK`, `CHUNK_INFO` and `CONNECTION`."""
        return self.fields.get(b"op", b"")

    def number(self, name: bytes) -> int:
        """Return an unsigned field, 0 if it is missing."""
        return number_of(self.fields.get(name, b""))

    def text(self, name: bytes) -> str:
        """Return a field, "" if it is missing."""
        return self.fields.get(name, b"").decode(errors="replace")


def number_of(data: bytes) -> int:
    """Return an unsigned number."""
    return int.from_bytes(data, "little")


def fields_of(data: bytes) -> dict[bytes, bytes]:
    """Return named fields.

    Raises:
        BrokenRecord: they are damaged.
    """
    found: dict[bytes, bytes] = {}
    at = 0
    while at < len(data):
        start = at + SIZE
        at = start + number_of(data[at:start])
        name, sign, value = data[start:at].partition(b"=")
        if not sign or at > len(data):
            raise BrokenRecord
        found[name] = value
    return found


def record_in(data: bytes, at: int) -> Ros1Record:
    """Return the record at an offset of an unpacked chunk.

    Raises:
        BrokenRecord: it is damaged, or cut off.
    """
    start = at + SIZE
    end = start + number_of(data[at:start])
    if not start < end <= min(len(data) - SIZE, start + MAX_FIELDS):
        raise BrokenRecord
    length = number_of(data[end : end + SIZE])
    record = Ros1Record(fields_of(data[start:end]), end + SIZE, end + SIZE + length)
    if record.end > len(data):
        raise BrokenRecord
    return record
