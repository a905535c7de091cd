"""Images and packets of videos as messages contain them: damaged, oversized, or of false sizes."""

from __future__ import annotations

import io
import json
import struct
import zlib
from functools import cache
from pathlib import Path
from random import Random
from types import SimpleNamespace
from typing import Any

import numpy as np
from PIL import Image

from tests.attack.attack import Case, mutated
from webviz import Sample
from webviz.api.nodes import Pose
from webviz.api.pictures import Encoded
from webviz.data.images import ENCODINGS, ImageError, RawImage, Tone, open_compressed, render
from webviz.data.images.compressed_depth import HEADER
from webviz_displays.image import video
from webviz_displays.image.transports import Decompression, read

EXTREMES = (0, 1, 2, 7, 255, 65_535, 2**31 - 1, 2**32 - 1)
FORMATS = ("jpeg", "png", "webp", "rgb8; jpeg compressed bgr8", "h264", "", "\x00", "x" * 5000)
DEPTHS = ("16UC1; compressedDepth png", "32FC1; compressedDepth png", "16UC1; compressedDepth rvl")
CODECS = ("h264", "h265", "vp9", "av1", "hevc;yuv420p;bgr8;bgr8", "theora")


@cache
def _picture(kind: str, is_deep: bool = False) -> bytes:
    file = io.BytesIO()
    if is_deep:
        Image.fromarray(np.arange(16, dtype=np.uint16).reshape(4, 4)).save(file, kind)
    else:
        Image.new("RGB", (8, 6), (10, 20, 30)).save(file, kind)
    return file.getvalue()


def png_of(width: int, height: int, bits: int, color: int, zeros: int) -> bytes:
    """Return a PNG whose header claims a size, with compressed zeros as pixels.

    Args:
        width, height: in pixels.
        bits: of a channel.
        color: type of colour: 0 is grey, 2 RGB, 3 a palette, 6 RGBA.
        zeros: bytes that the pixels unfold to.
    """

    def chunk(name: bytes, data: bytes) -> bytes:
        checked = name + data
        return struct.pack(">I", len(data)) + checked + struct.pack(">I", zlib.crc32(checked))

    header = struct.pack(">IIBBBBB", width, height, bits, color, 0, 0, 0)
    pixels = zlib.compress(bytes(zeros), 9)
    return (
        b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", pixels) + chunk(b"IEND", b"")
    )


def _bomb(random: Random) -> bytes:
    edge = random.choice((1, 1000, 20_000, 65_535, 2**31 - 1))
    return png_of(
        edge,
        random.choice((1, edge)),
        random.choice((1, 8, 16)),
        random.choice((0, 2, 3, 6)),
        random.choice((0, 1000, 32 << 20)),
    )


def draw(random: Random) -> Case:
    """Decodes attacked images in a process of its own, as displays do."""
    match random.choice(("image", "image", "depth", "raw", "video")):
        case "image":
            data = random.choice((_bomb(random), *map(_picture, ("PNG", "JPEG", "WEBP"))))
            return _case("a.image", random, random.choice(FORMATS), data)
        case "depth":
            columns, rows = random.choice(EXTREMES), random.choice(EXTREMES)
            rvl = struct.pack("<II", columns, rows) + random.randbytes(random.randrange(200))
            data = random.choice((rvl, _picture("PNG", is_deep=True), _bomb(random)))
            numbers = random.choice((0.0, 1.0, 1e38, float("nan"), float("-inf")))
            head = HEADER.pack(0, numbers, random.random())
            return _case("a.depth", random, random.choice(DEPTHS), head + data)
        case "raw":
            fields = {name: random.choice(EXTREMES) for name in ("width", "height", "step")}
            fields["is_bigendian"] = random.randrange(2)
            about = {"encoding": random.choice((*sorted(ENCODINGS), "", "rgb9")), **fields}
            data = random.randbytes(random.choice((0, 1, 300, 6000)))
            return Case("a.raw", json.dumps(about).encode() + b"\n" + data)
        case _:
            start = random.choice((b"\x00\x00\x01\x65", b"\x00\x00\x01\x26", b"\x82", b"\x0a"))
            data = start * random.choice((1, 1, 20_000)) + random.randbytes(50)
            return _case("a.video", random, random.choice(CODECS), data)


def _case(name: str, random: Random, format_: str, data: bytes) -> Case:
    changed = mutated(random, data) if random.random() < 0.5 else data
    return Case(name, json.dumps({"format": format_}).encode() + b"\n" + changed)


def read_media(path: Path) -> None:
    """Decode the image or packets of a file.

    Raises:
        ImageError: they cannot be shown.
    """
    head, _, data = path.read_bytes().partition(b"\n")
    about = json.loads(head)
    array = np.frombuffer(data, np.uint8)
    if path.suffix == ".raw":
        values = SimpleNamespace(**about, data=array, header=None)
        _show(read(_sample(values, "sensor_msgs/msg/Image")))
        return
    message = SimpleNamespace(format=about["format"], data=array)
    if path.suffix == ".video":
        clip = None
        for _ in range(3):
            clip = video.extended(clip, _sample(message, video.FOXGLOVE))
        if clip is not None and clip.video is None:
            raise ImageError(clip.problem)
        return
    _show(read(_sample(message, "sensor_msgs/msg/CompressedImage")))


def _sample(message: Any, type_: str) -> Sample:
    return Sample(message, "camera", 1, 1, 0, Pose(), "topic", type=type_)


def _show(image: RawImage | Encoded | Decompression) -> None:
    """Make the pixels that a page would show."""
    match image:
        case Encoded():
            stream = open_compressed(np.asarray(image.data, np.uint8))
            try:
                stream.load()
            except (OSError, SyntaxError, ValueError) as error:  # left to browsers
                raise ImageError("The image is damaged.") from error
        case Decompression():
            render(image.run(), Tone())
        case RawImage():
            render(image, Tone())
