"""Pictures of the Image display from messages, without a browser."""

from __future__ import annotations

import gc
import io
import struct
from typing import Any, ClassVar

import numpy as np
import photos
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import images
from inspecting import Benches
from PIL import Image as Pillow

from webviz import Topic
from webviz.api.nodes import Pane
from webviz.api.pictures import Encoded, Pixels, Video
from webviz.data.memory import MemoryBudget
from webviz.data.messages import encode
from webviz.shell.testing import DisplayBench
from webviz.sources import Offer, Publisher
from webviz_displays.image import Image, video
from webviz_displays.image.video import FFMPEG, FOXGLOVE

COLORS, DEPTHS = photos.room(16, 12)
TOPIC = Image().topic.name


def pane_picture(at: DisplayBench) -> Any:
    """The picture in the pane."""
    pane = at.nodes()["pane"]
    assert isinstance(pane, Pane)
    return pane.picture


def test_a_picture_needs_no_transform(bench: Benches) -> None:
    at = bench(Image())
    at.send(photos.RAW, photos.raw(COLORS, "rgb8"), frame="nowhere")
    at.turn()
    assert isinstance(pane_picture(at), Pixels)
    assert at.statuses()["Image"] == ("OK", "16 x 12, rgb8.")
    assert all(level == "OK" for level, _ in at.statuses().values())


def test_the_publisher_decides_how_a_topic_is_read(bench: Benches) -> None:
    at = bench(Image())
    for type_, values, kind in (
        (photos.RAW, photos.raw(COLORS, "rgb8"), Pixels),
        (photos.COMPRESSED, photos.jpeg(COLORS), Encoded),
        (photos.RAW, photos.raw(COLORS, "rgb8"), Pixels),
    ):
        at.send(type_, values, frame="camera")
        at.turn()
        assert at.runner.subscriptions()[TOPIC].type == type_
        assert isinstance(pane_picture(at), kind)
    assert at.statuses()["Image"][0] == "OK"


def test_jpeg_goes_to_the_browser_as_it_is(bench: Benches) -> None:
    at, values = bench(Image()), photos.jpeg(COLORS, "rgb8; jpeg compressed rgb8")
    at.send(photos.COMPRESSED, values, frame="camera")
    at.turn()
    picture = pane_picture(at)
    assert picture.data.tobytes() == values["data"].tobytes()
    assert (picture.mime, picture.size) == ("image/jpeg", (16, 12))
    assert picture.swaps_red_and_blue


def test_compressed_depths_are_decompressed_beside_the_loop(bench: Benches) -> None:
    at, file = bench(Image()), io.BytesIO()
    Pillow.fromarray(np.full((12, 16), 700, np.uint16)).save(file, "PNG")
    data = np.frombuffer(struct.pack("<iff", 0, 0.0, 0.0) + file.getvalue(), np.uint8)
    values = {"format": "16UC1; compressedDepth png", "data": data}
    for _ in range(3):
        at.send(photos.COMPRESSED, values, frame="camera")
        at.turn()
    at.settle()
    assert (pane_picture(at).tone.low, pane_picture(at).tone.high) == (700, 700)
    first = at.nodes()["pane"]
    at.turn()
    assert at.nodes()["pane"] is first
    broken = {"format": "16UC1; compressedDepth png", "data": data[:40]}
    at.send(photos.COMPRESSED, broken, frame="camera")
    at.turn()
    at.settle()
    assert at.statuses()["Image"][0] == "ERROR"
    at.send(photos.COMPRESSED, values, frame="camera")
    at.turn()
    at.settle()
    assert at.statuses()["Image"] == ("OK", "16 x 12, 16UC1.")


def test_the_range_is_the_median_of_the_newest_images(bench: Benches) -> None:
    at = bench(Image(median_window=3))
    for low in (0.2, 0.3, 5.0, 0.4):
        depths = np.array([[low, low + 0.5, np.nan]], np.float32)
        at.send(photos.RAW, photos.raw(depths, "32FC1"), frame="camera")
        at.turn()
    assert pane_picture(at).tone.low == pytest.approx(0.4)
    assert pane_picture(at).tone.high == pytest.approx(0.9)
    at.set("normalize_range", False)
    at.set("max_value", 0.5)
    assert (pane_picture(at).tone.low, pane_picture(at).tone.high) == (0.0, 0.5)
    at.set("min_value", 2.0)
    assert "Min Value 2 is not below Max Value 0.5" in at.statuses()["Image"][1]
    at.press("Image")


@pytest.mark.parametrize(
    ("values", "level", "sentence"),
    [
        (photos.raw(COLORS, "rgb9"), "ERROR", "did you mean rgb8?"),
        (photos.raw(COLORS, "rgb8") | {"step": 7}, "ERROR", "step is 7 bytes"),
        (photos.raw(COLORS, "rgb8") | {"height": 13}, "ERROR", "data has 576 bytes"),
        (photos.raw(COLORS, "rgb8") | {"encoding": "mono8"}, "WARN", None),
        (photos.raw(np.full((2, 2), np.nan, np.float32), "32FC1"), "WARN", "No pixel has a valid"),
    ],
)
def test_inconsistent_images_are_reported(
    bench: Benches, values: dict[str, Any], level: str, sentence: str | None
) -> None:
    if sentence is None:  # mono8 with the bytes of a colour image, and a step that fits
        values, sentence = values | {"step": 16}, "more than 16 x 12 pixels of mono8"
    at = bench(Image())
    at.send(photos.RAW, values, frame="camera")
    at.turn()
    assert at.statuses()["Image"][0] == level
    assert sentence in at.statuses()["Image"][1]
    assert ("pane" in at.nodes()) == (level != "ERROR")


def test_a_type_that_no_image_has_is_named(bench: Benches) -> None:
    at = bench(Image())
    publisher = Publisher("/theora", "theora_image_transport/msg/Packet", "reliable", "volatile")
    at.offers[TOPIC] = Offer((publisher,), ("reliable", "volatile"))
    at.turn()
    level, text = at.statuses()["Topic"]
    assert level == "ERROR"
    assert "theora_image_transport/msg/Packet" in text


KEY, DELTA = b"\0\0\0\1\x67abc\0\0\1\x65key", b"\0\0\1\x41delta"


def packet(data: bytes, codec: str = "h264") -> bytes:
    values = {"frame_id": "camera", "data": np.frombuffer(data, np.uint8), "format": codec}
    return encode(FOXGLOVE, values)


def test_a_video_keeps_the_packets_since_its_key_frame(bench: Benches) -> None:
    at = bench(Image())
    at.send_bytes(FOXGLOVE, packet(DELTA))
    at.turn()
    assert at.statuses()["Image"][0] == "WARN"
    assert "Waiting for a key frame of the h264 video" in at.statuses()["Image"][1]
    for data in (KEY, DELTA, DELTA, KEY, DELTA):
        at.send_bytes(FOXGLOVE, packet(data))
    at.turn()
    picture = pane_picture(at)
    assert isinstance(picture, Video)
    first, second = (each.number for each in picture.packets)
    assert second == first + 1
    assert picture.packets[0].data.tobytes() == KEY
    at.send_bytes(FOXGLOVE, packet(KEY, "mjpeg2000"))
    at.turn()
    assert "Unsupported video codec 'mjpeg2000'" in at.statuses()["Image"][1]


def test_packets_of_a_video_count_as_memory_while_they_are_kept(
    bench: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    budget = MemoryBudget(1000, 150)
    monkeypatch.setattr(video, "DECODING", budget)
    at = bench(Image())

    def send(data: bytes) -> int:
        at.send_bytes(FOXGLOVE, packet(data))
        at.turn()
        gc.collect()
        return budget.room

    assert [send(KEY + bytes(40)) for _ in range(3)] == 3 * [1000 - len(KEY) - 40]
    send(DELTA + bytes(100))
    level, text = at.statuses()["Image"]
    assert (level, text.startswith("A packet of the h264 video takes 0 MB of memory;")) == (
        "WARN",
        True,
    )
    assert send(KEY) == 1000 - len(KEY)
    assert isinstance(pane_picture(at), Video)


def test_key_frames_of_ffmpeg_packets_are_recognised(bench: Benches) -> None:
    at = bench(Image())
    for flags in (1, 0, 0):
        values = {"encoding": "hevc;yuv420p;bgr8;bgr8", "flags": flags, "data": [1, 2, 3]}
        at.send(FFMPEG, values, frame="camera")
    at.turn()
    assert (pane_picture(at).codec, len(pane_picture(at).packets)) == ("h265", 3)


@pytest.mark.parametrize("type_", [photos.RAW, photos.COMPRESSED, FOXGLOVE, FFMPEG])
def test_no_message_breaks_the_display(bench: Benches, type_: str) -> None:
    at, rng = bench(Image()), np.random.default_rng(6)
    good = {
        photos.RAW: encode(photos.RAW, photos.raw(COLORS, "32FC1") | {"step": 48, "width": 12}),
        photos.COMPRESSED: encode(photos.COMPRESSED, photos.jpeg(COLORS)),
        FOXGLOVE: packet(KEY),
        FFMPEG: encode(FFMPEG, {"encoding": "h264", "data": [0, 0, 1, 0x65]}),
    }[type_]
    for _ in range(100):
        broken = bytearray(good)
        for at_ in rng.integers(4, len(good), 6):
            broken[at_] = rng.integers(0, 256)
        at.send_bytes(type_, bytes(broken))
        at.turn()
    at.settle()
    at.statuses()
    at.send_bytes(type_, good)
    at.turn()
    assert "pane" in at.nodes()


class TestImage(BuiltInChecks):
    display = Image
    messages: ClassVar = {}
    scene = images
    later = ("median_window",)
    needs: ClassVar = {"show_labels": {"annotations_topic": Topic("/found")}}
