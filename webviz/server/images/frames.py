"""Pictures as bytes: the length of a header, the header as JSON, and the files it describes."""

from __future__ import annotations

import math
import struct
from collections.abc import Iterable, Sequence

import msgspec
import numpy as np
from msgspec import UNSET, UnsetType
from msgspec.structs import replace

from webviz.api.nodes import Pane
from webviz.api.pictures import Mark, OverlayCamera, Packet, Picture, Pixels, Readout, Video, Warp
from webviz.data.images import COLOR_MAPS
from webviz.server.images.encoding import File


class PictureWarp(msgspec.Struct, frozen=True):
    """A warp; `places` are by rows, each x and y, None outside of what the lens sees."""

    rows: int
    columns: int
    places: Sequence[float | None]


class PictureCamera(msgspec.Struct, frozen=True):
    """An overlay camera without its warp; see `webviz.api.pictures.OverlayCamera`."""

    position: tuple[float, float, float]
    wxyz: tuple[float, float, float, float]
    size: tuple[int, int]
    focal: tuple[float, float]
    principal: tuple[float, float]
    part: tuple[float, float, float, float]
    far: float
    zoom: float
    overlay: float
    is_background: bool


class ColorRange(msgspec.Struct, frozen=True):
    """The range of values that the colours of a measurement stand for, 0 to 255 each."""

    low: float
    high: float
    unit: str
    colors: Sequence[tuple[int, int, int]]


class PictureHeader(msgspec.Struct, frozen=True, kw_only=True):
    """The header of a picture; unset fields are not sent.

    Args:
        display: id of the display.
        number: of the picture.
        stamp: seconds.
        video: the codec of a video.
        sizes: bytes of each packet of a video.
        starts: whether the first packet is a key frame.
        mime: type of the file of a still picture or a text.
        topic, type, received: of the message of a text; seconds.
        size: width and height in pixels of the full picture.
        legend: of a measurement.
        readable: whether pixels can be read with `ReadPixel`.
        swaps: whether red and blue are in each other's place.
        camera: the camera through which the page draws the scene.
        warp: a new distortion of the picture, None for none.
        marks: figures over the picture.
        is_same: whether the page has the picture, which does not follow then.
    """

    display: str
    number: int
    stamp: float
    video: str | UnsetType = UNSET
    sizes: Sequence[int] | UnsetType = UNSET
    starts: bool | UnsetType = UNSET
    mime: str | UnsetType = UNSET
    topic: str | UnsetType = UNSET
    type: str | UnsetType = UNSET
    received: float | UnsetType = UNSET
    size: tuple[int, int] | UnsetType = UNSET
    legend: ColorRange | UnsetType = UNSET
    readable: bool | UnsetType = UNSET
    swaps: bool | UnsetType = UNSET
    camera: PictureCamera | UnsetType = UNSET
    warp: PictureWarp | UnsetType | None = UNSET
    marks: Sequence[Mark] | UnsetType = UNSET
    is_same: bool | UnsetType = UNSET


class SentPicture(msgspec.Struct, frozen=True):
    """Pictures, packets and warps that a page has already.

    Args:
        packet: number of the newest packet of a video.
        warp: of the newest picture, None without one.
        picture: the newest one of a message; None without one, and of a video.
    """

    packet: int = -1
    warp: Warp | None = None
    picture: Picture | None = None

    def has(self, picture: Picture) -> bool:
        """Return whether the page needs no file to show a picture."""
        return self.picture is not None and self.picture == picture


def frame(
    display: str,
    number: int,
    pane: Pane,
    file: File | None,
    previous: SentPicture,
    is_readable: bool = True,
) -> tuple[bytes, SentPicture]:
    """Return a message with a picture.

    Args:
        display: id of the display.
        number: of the picture.
        pane: with the picture.
        file: see `file_of`; None of a video, and of a picture that the page has.
        previous: what the page has.
        is_readable: whether the page can ask for the values of pixels.

    Returns:
        The message, and what the page has with it; without a new packet of a video it is empty.
    """
    picture = pane.picture
    head = PictureHeader(display=display, number=number, stamp=pane.stamp_ns / 1e9)
    if pane.marks:
        head = replace(head, marks=pane.marks)
    if isinstance(picture, Video):
        packets = _following(picture.packets, previous.packet)
        if not packets:
            return b"", previous
        head = replace(
            head,
            video=picture.codec,
            sizes=[len(packet.data) for packet in packets],
            starts=packets[0] is picture.packets[0],
        )
        parts = (np.ascontiguousarray(packet.data).data for packet in packets)
        return _joined(head, parts), SentPicture(packets[-1].number)
    head = replace(head, is_same=True) if file is None else replace(head, mime=file.mime)
    data = [] if file is None else [file.data]
    if isinstance(picture, Readout):
        head = replace(head, topic=picture.topic, type=picture.type, received=picture.received_s)
        return _joined(head, data), previous
    head = replace(head, size=picture.size)
    if isinstance(picture, Pixels):
        head = replace(head, legend=_legend(picture), readable=is_readable)
    else:
        head = replace(head, swaps=picture.swaps_red_and_blue)
    warp = None
    if pane.camera is not None:
        warp = pane.camera.warp
        head = replace(head, camera=camera_of(pane.camera))
        if warp is not previous.warp:
            head = replace(head, warp=warp_of(warp))
    return _joined(head, data), SentPicture(previous.packet, warp, picture)


def _following(packets: tuple[Packet, ...], packet: int) -> tuple[Packet, ...]:
    """Return the packets for a page that has all up to one of them: the rest, all after a gap."""
    first, last = packets[0].number, packets[-1].number
    return packets[packet + 1 - first :] if first <= packet <= last else packets


def _legend(picture: Pixels) -> ColorRange | UnsetType:
    """Return the range of values that the colours of a measurement stand for."""
    layout, tone = picture.image.layout, picture.tone
    if not layout.is_scaled or layout.channels > 1:
        return UNSET
    scale = 1000.0 if layout.unit == "mm" else 1.0
    return ColorRange(
        low=float(f"{tone.low / scale:.4g}"),
        high=float(f"{tone.high / scale:.4g}"),
        unit="m" if layout.unit else "",
        colors=COLOR_MAPS[tone.color_map],
    )


def camera_of(camera: OverlayCamera) -> PictureCamera:
    """Return an overlay camera as pages read it."""
    return msgspec.convert(camera, PictureCamera, from_attributes=True)


def warp_of(warp: Warp | None) -> PictureWarp | None:
    """Return a warp as pages read it."""
    if warp is None:
        return None
    rows, columns, _ = warp.grid.shape
    flat = np.round(warp.grid.astype(np.float64), 6).ravel().tolist()
    return PictureWarp(rows, columns, [each if math.isfinite(each) else None for each in flat])


def _joined(head: PictureHeader, parts: Iterable[bytes | memoryview]) -> bytes:
    encoded = msgspec.json.encode(head)
    return b"".join((struct.pack("<I", len(encoded)), encoded, *parts))
