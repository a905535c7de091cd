"""Pictures as bytes: the length of a header, the header as JSON, and the files it describes."""

from __future__ import annotations

import struct
from collections.abc import Iterable
from typing import Any

import msgspec
import numpy as np

from webviz.api.nodes import Pane
from webviz.api.pictures import Packet, Pixels, Readout, Video
from webviz.api.stills import File
from webviz.data.images import COLOR_MAPS


def frame(
    display: str, number: int, pane: Pane, file: File | None, sent_packet: int
) -> tuple[bytes, int]:
    """A message with a picture.

    Args:
        display: id of the display.
        number: of the picture.
        pane: with the picture.
        file: see `file_of`; None of a video.
        sent_packet: number of the last packet of a video that the page has.

    Returns:
        The message, and the number of the last packet in it; without a new packet it is empty.
    """
    picture = pane.picture
    head: dict[str, Any] = {"display": display, "number": number, "stamp": pane.stamp_ns / 1e9}
    if isinstance(picture, Video):
        packets = _following(picture.packets, sent_packet)
        if not packets:
            return b"", sent_packet
        head["video"] = picture.codec
        head["sizes"] = [len(packet.data) for packet in packets]
        head["starts"] = packets[0] is picture.packets[0]
        return _joined(head, (packet.data for packet in packets)), packets[-1].number
    assert file is not None
    head["mime"] = file.mime
    if isinstance(picture, Readout):
        head |= {"topic": picture.topic, "type": picture.type, "received": picture.received_s}
        return _joined(head, [file.data]), sent_packet
    head["size"] = picture.size
    if isinstance(picture, Pixels):
        head |= _legend(picture)
        head["readable"] = True
    else:
        head["swaps"] = picture.swaps_red_and_blue
    return _joined(head, [file.data]), sent_packet


def _following(packets: tuple[Packet, ...], sent: int) -> tuple[Packet, ...]:
    """What a page needs that has all up to a packet: the rest, or all if it missed some."""
    first, last = packets[0].number, packets[-1].number
    return packets[sent + 1 - first :] if first <= sent <= last else packets


def _legend(picture: Pixels) -> dict[str, Any]:
    """Which values the colours of a measurement stand for."""
    layout, tone = picture.image.layout, picture.tone
    if not layout.is_scaled or layout.channels > 1:
        return {}
    scale = 1000.0 if layout.unit == "mm" else 1.0
    return {
        "legend": {
            "low": float(f"{tone.low / scale:.4g}"),
            "high": float(f"{tone.high / scale:.4g}"),
            "unit": "m" if layout.unit else "",
            "colors": COLOR_MAPS[tone.color_map],
        }
    }


def _joined(head: dict[str, Any], parts: Iterable[bytes | np.ndarray[Any, Any]]) -> bytes:
    encoded = msgspec.json.encode(head)
    return b"".join((struct.pack("<I", len(encoded)), encoded, *(bytes(part) for part in parts)))
