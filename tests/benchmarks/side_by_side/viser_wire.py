"""Finds marks in what a viser server sends.

A websocket message is a window: two sizes, msgpack under zstd, then the arrays as they are. Nodes
may have any name; marks are told by where they lie and by their lanes.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Sequence
from typing import Any

import msgspec
import numpy as np
import zstandard

from side_by_side import strip
from side_by_side.log import Sighting
from side_by_side.marks import FRAME_Z, LINK_Z, Lane, Place

EXACT_M = 1e-4
"""Rounding error that composing transforms may add to a mark."""
_SIZES = struct.Struct("<QQ")


def messages(data: memoryview) -> list[dict[str, Any]]:
    """The messages of a window, arrays in place of their placeholders."""
    raw_size, size = _SIZES.unpack_from(data)
    zstd = zstandard.ZstdDecompressor()  # threads must not share one
    packed = zstd.decompress(data[16 : 16 + size], max_output_size=raw_size)
    window = msgspec.msgpack.decode(packed)
    arrays, at = [], 16 + size
    for length in window["binaryBufferLengths"]:
        at += -at % 8
        arrays.append(data[at : at + length])
        at += length
    for message in window["messages"]:
        for props in (message, message.get("updates"), message.get("props")):
            if isinstance(props, dict):
                for key, value in props.items():
                    if isinstance(value, dict) and "__binary_index" in value:
                        array = arrays[value["__binary_index"]]
                        props[key] = np.frombuffer(array, value["dtype"])
    return window["messages"]


def follow_nodes(window: Sequence[dict[str, Any]], nodes: set[str]) -> None:
    """Add the nodes that the messages of a window make, and remove those that they remove."""
    for message in window:
        if message["type"] == "RemoveSceneNodeMessage":
            gone = message["name"]
            nodes.difference_update(
                [name for name in nodes if name == gone or name.startswith(f"{gone}/")]
            )
        elif "props" in message and "name" in message:
            nodes.add(message["name"])


def sightings(
    window: Sequence[dict[str, Any]], lanes: Sequence[Lane], now_ns: int
) -> list[Sighting]:
    """The marked publications in the messages of a window."""
    results = []
    cycles = {lane.number: min(lane.cycle, strip.CYCLE) for lane in lanes}
    for message in window:
        for place, value in _candidates(message):
            if place == Place.PICTURE:
                results += [
                    Sighting(now_ns, lane, number, cycles[lane])
                    for lane, number in strip.read(value)
                    if lane in cycles
                ]
                continue
            for lane in lanes:
                if lane.place == place and (number := lane.decode(value)) is not None:
                    results.append(Sighting(now_ns, lane.number, number, lane.cycle))
    return results


def _candidates(message: dict[str, Any]) -> Iterable[tuple[Place, Any]]:
    """Return where a mark may lie in a message, and what is there."""
    if message["type"] == "SetPositionMessage":
        x, _, z = message["position"]
        if abs(z - FRAME_Z) < EXACT_M:
            yield Place.FRAME, x
        elif abs(z - LINK_Z) < EXACT_M:
            yield Place.LINK, x
        return
    props = message.get("updates") or message.get("props") or {}
    positions = props.get("batched_positions")
    if isinstance(positions, np.ndarray):
        rows = positions.reshape(-1, 3)
        for x in rows[np.abs(rows[:, 2] - FRAME_Z) < EXACT_M, 0]:
            yield Place.FRAME, float(x)
    points = props.get("points")
    if isinstance(points, np.ndarray) and len(points) >= 6:
        yield Place.FIRST_POINT, float(points[0])
        yield Place.FIRST_VERTEX, float(points[0])
        yield Place.LAST_POSE, float(points[-4])  # z of the start of the last segment
    if isinstance(props.get("_data"), bytes):
        yield Place.PICTURE, props["_data"]
