"""Pictures as bytes: the length of a header, the header as JSON, and the files it describes."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import Any

import msgspec
import numpy as np

from webviz.api.nodes import Pane
from webviz.api.pictures import OverlayCamera, Packet, Pixels, Readout, Video, Warp
from webviz.data.images import COLOR_MAPS
from webviz.server.images.encoding import File


@dataclass(frozen=True)
class Sent:
    """Packets a page has already.

    Args:
        packet: number of the newest packet of a video.
        warp: of the newest picture, None without one.
    """

    packet: int = -1
    warp: Warp | None = None


def frame(
    display: str, number: int, pane: Pane, file: File | None, sent: Sent
) -> tuple[bytes, Sent]:
    """A message with a picture.

    Args:
        display: id of the display.
        number: of the picture.
        pane: with the picture.
        file: see `file_of`; None of a video.
        sent: what the page has.

    Returns:
        The message, and what the page has with it; without a new packet of a video it is empty.
    """
    picture = pane.picture
    head: dict[str, Any] = {"display": display, "number": number, "stamp": pane.stamp_ns / 1e9}
    if isinstance(picture, Video):
        packets = _following(picture.packets, sent.packet)
        if not packets:
            return b"", sent
        head["video"] = picture.codec
        head["sizes"] = [len(packet.data) for packet in packets]
        head["starts"] = packets[0] is picture.packets[0]
        parts = (np.ascontiguousarray(packet.data).data for packet in packets)
        return _joined(head, parts), Sent(packets[-1].number)
    assert file is not None
    head["mime"] = file.mime
    if isinstance(picture, Readout):
        head |= {"topic": picture.topic, "type": picture.type, "received": picture.received_s}
        return _joined(head, [file.data]), sent
    head["size"] = picture.size
    if isinstance(picture, Pixels):
        head |= _legend(picture)
        head["readable"] = True
    else:
        head["swaps"] = picture.swaps_red_and_blue
    warp = None
    if pane.sight is not None:
        warp = pane.sight.warp
        head["sight"] = overlay_camera_values(pane.sight)
        if warp is not sent.warp:
            head["warp"] = warp_values(warp)
    return _joined(head, [file.data]), Sent(sent.packet, warp)


def _following(packets: tuple[Packet, ...], sent: int) -> tuple[Packet, ...]:
    """Return the packets for a page that has all up to one of them: the rest, all after a gap."""
    first, last = packets[0].number, packets[-1].number
    return packets[sent + 1 - first :] if first <= sent <= last else packets


def _legend(picture: Pixels) -> dict[str, Any]:
    """Return the range of values that the colours of a measurement stand for."""
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


def overlay_camera_values(sight: OverlayCamera) -> dict[str, Any]:
    """A sight as JSON, without its warp."""
    return {each.name: getattr(sight, each.name) for each in fields(sight) if each.name != "warp"}


def warp_values(warp: Warp | None) -> dict[str, Any] | None:
    """A warp as JSON: places by rows, null outside of what the lens sees."""
    if warp is None:
        return None
    rows, columns, _ = warp.grid.shape
    flat = np.round(warp.grid.astype(np.float64), 6).ravel().tolist()
    places = [each if math.isfinite(each) else None for each in flat]
    return {"rows": rows, "columns": columns, "places": places}


def _joined(head: dict[str, Any], parts: Iterable[bytes | memoryview]) -> bytes:
    encoded = msgspec.json.encode(head)
    return b"".join((struct.pack("<I", len(encoded)), encoded, *parts))
