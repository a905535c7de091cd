"""Video: packets of H.264, H.265, VP9 or AV1, which browsers decode."""

from __future__ import annotations

import itertools
from typing import Any

import msgspec
import numpy as np
from numpy.typing import NDArray

from webviz import Sample
from webviz.api.pictures import Packet, Video
from webviz.data.images import ImageError
from webviz.data.memory import DECODING, OverBudgetError

FOXGLOVE = "foxglove_msgs/msg/CompressedVideo"
FFMPEG = "ffmpeg_image_transport_msgs/msg/FFMPEGPacket"
TYPES = (FOXGLOVE, FFMPEG)

MAX_PACKETS = 1800
"""Largest number of packets between two key frames: a minute at 30 Hz."""
MAX_BYTES = 32 << 20

_CODECS = {
    "h264": "h264",
    "avc": "h264",
    "libx264": "h264",
    "h265": "h265",
    "hevc": "h265",
    "libx265": "h265",
    "vp9": "vp9",
    "av1": "av1",
}
_START = b"\x00\x00\x01"
_HEAD_BYTES = 4096
"""Bytes of a packet in which the kind of its picture is found, after parameter sets."""
_numbers = itertools.count()
"""Numbers of packets; they go on when a display is reset, so that a page is never sent a wrong
rest."""
_KEY_FLAG = 1
"""AV_PKT_FLAG_KEY of FFmpeg."""


class Clip(msgspec.Struct, frozen=True):
    """All packets since the last key frame.

    Args:
        video: None until there is a key frame, or if they became too many.
        problem: why there is no picture.
        size: of all packets in bytes.
    """

    video: Video | None = None
    problem: str = ""
    size: int = 0


def extended(clip: Clip | None, sample: Sample) -> Clip:
    """Return a clip with the packet of one more message; a key frame begins a new one.

    The memory of each packet is counted while it lives.
    """
    clip = clip or Clip()
    message, number = sample.message, next(_numbers)
    name = message.format if sample.type == FOXGLOVE else message.encoding
    data = np.asarray(message.data, np.uint8)
    try:
        codec = codec_of(name)
    except ImageError as error:
        return Clip(None, str(error))
    flags = int(message.flags) if sample.type == FFMPEG else None
    begins = is_key(codec, data, flags)
    if clip.video is None and not begins:
        wait = clip.problem or (
            f"Waiting for a key frame of the {codec} video. Shorten the publisher's key frame "
            "interval if this takes long."
        )
        return Clip(None, wait)
    before = () if begins or clip.video is None else clip.video.packets
    size = len(data) + (clip.size if before else 0)
    if before and (len(before) >= MAX_PACKETS or size > MAX_BYTES):
        problem = (
            f"No key frame within {MAX_PACKETS} packets or {MAX_BYTES >> 20} MB of the {codec} "
            "video. Shorten the publisher's key frame interval."
        )
        return Clip(None, problem)
    packet = Packet(number, data)
    try:
        DECODING.hold(packet, len(data))
    except OverBudgetError as error:
        return Clip(None, f"A packet of the {codec} video {error}. Remove other displays.")
    return Clip(Video(codec, (*before, packet)), size=size)


def codec_of(name: str) -> str:
    """Return the codec that a message names, such as "h264" or FFmpeg's "hevc;yuv420p;bgr8;bgr8".

    Raises:
        ImageError: browsers cannot decode it.
    """
    words = name.lower().partition(";")[0].strip()
    codec_name = next((codec for key, codec in _CODECS.items() if key in words), "")
    if not codec_name:
        raise ImageError(
            f"Unsupported video codec {name[:40]!a}: browsers decode h264, h265, vp9 and av1."
        )
    return codec_name


def stands_alone(message: Any, type_name: str) -> bool:
    """Return whether an image or packet can be shown without those before it."""
    if type_name not in TYPES:
        return True
    is_foxglove = type_name == FOXGLOVE
    try:
        codec = codec_of(message.format if is_foxglove else message.encoding)
    except ImageError:
        return True
    flags = None if is_foxglove else int(message.flags)
    return is_key(codec, np.asarray(message.data, np.uint8), flags)


def is_key(codec: str, data: NDArray[np.uint8], flags: int | None) -> bool:
    """Return whether a packet can be decoded without others.

    Args:
        codec: see `codec_of`.
        data: uint8 (N,), of H.264 and H.265 in the byte stream format (their Annex B).
        flags: of FFmpeg, None if they are unknown.
    """
    if flags is not None:
        return bool(flags & _KEY_FLAG)
    head = data[:_HEAD_BYTES].tobytes()
    if codec == "vp9":  # its uncompressed header: marker 2, profile, 0, key frame 0
        return len(head) > 0 and head[0] >> 6 == 2 and not head[0] & 0x0C
    if codec == "av1":  # a temporal unit with a sequence header, OBU type 1
        return any((byte >> 3) & 15 == 1 for byte in head[:1] + head[2:3])
    kinds = (part[:1] for part in head.split(_START)[1:])
    if codec == "h264":
        return any(kind and kind[0] & 31 == 5 for kind in kinds)  # a slice of an IDR picture
    return any(kind and 16 <= (kind[0] >> 1) & 63 <= 21 for kind in kinds)  # of an IRAP picture
