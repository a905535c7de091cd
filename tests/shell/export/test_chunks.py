"""Chunks of exported runs: what is repeated within them."""

from __future__ import annotations

import json
import zlib
from typing import Any

import msgspec
import numpy as np

from webviz.shell.export.chunks import SHARED_BYTES, Buffers, ExportChunk

GZIP = 31


def values_in(chunk: ExportChunk) -> list[Any]:
    """The values as a page reads them."""
    data = zlib.decompress(chunk.packed(), GZIP)
    size = int.from_bytes(data[:4], "little")
    values = json.loads(data[4 : 4 + size])["values"]
    items = [values["items"][place] for place in values["places"]]
    return [
        {"each": [values["shared"][number] for number in item["__each"]]}
        if isinstance(item, dict) and "__each" in item
        else item
        for item in items
    ]


def test_a_trail_that_moves_on_is_not_repeated() -> None:
    points = [{"fields": {"Position": f"{x * 0.37:.4f}, {x * 0.11:.4f}, 0 m"}} for x in range(600)]
    trails = [{"each": points[first : first + 500]} for first in range(100)]
    chunk = ExportChunk(0, 0, 0)
    for trail in trails:
        chunk.add_value("values .Pose", msgspec.Raw(msgspec.json.encode(trail)))
    assert values_in(chunk) == trails
    assert chunk.size < 500_000 < sum(len(json.dumps(trail)) for trail in trails)


def test_other_values_stay_as_they_are() -> None:
    small, other = {"each": [1, None, "a"]}, {"all": "x" * 2 * SHARED_BYTES}
    chunk = ExportChunk(0, 0, 0)
    for value in (small, other, [1, 2], None):
        chunk.add_value("some", msgspec.Raw(msgspec.json.encode(value)))
    assert values_in(chunk) == [small, other, [1, 2], None]


def test_arrays_that_are_alike_are_compressed_side_by_side() -> None:
    chance = np.random.default_rng(0)
    trail = chance.random(1000, np.float32)
    scans = [chance.random(9000, np.float32) for _ in range(9)]
    arrays = [array for scan in scans for array in (scan, trail)]
    sizes = {}
    for kinds in (("", ""), ("scan", "trail")):
        buffers = Buffers()
        for number, array in enumerate(arrays):
            assert buffers.add(array.data, "<f4", kind=kinds[number % 2]) == number
        index, packed = buffers.packed(1)
        sizes[kinds] = len(zlib.compress(packed))
        for array, (start, size, width) in zip(arrays, index, strict=True):
            shuffled = np.frombuffer(packed[start : start + size], np.uint8).reshape(width, -1)
            assert np.array_equal(np.ascontiguousarray(shuffled.T).view("<f4").ravel(), array)
    assert sizes["scan", "trail"] < 0.95 * sizes["", ""]
