"""CameraInfo and DepthCloud, without a browser."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
import photos
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import camera_infos
from inspecting import Benches

from webviz import Topic
from webviz.shell.testing import DisplayBench
from webviz_displays.camera_info import CameraInfo
from webviz_displays.depth_cloud import DepthCloud

COLORS, DEPTHS = photos.room(16, 12)
FACING_X = (-0.5, 0.5, -0.5, 0.5)
"""Rotation of an optical frame that looks along x of its parent."""
DEPTH, INFO, COLOR = "/depth/image/compressedDepth", "/depth/camera_info", "/color"


def send_info(at: DisplayBench, topic: str = "", frame: str = "camera", **changes: Any) -> None:
    at.send(photos.INFO, photos.info(16, 12, **changes), frame=frame, topic=topic)


def test_a_pyramid_reaches_from_the_camera_to_the_far_end(bench: Benches) -> None:
    at = bench(CameraInfo(far_clip=2.0))
    at.transform("map", "camera", (1.0, 0.0, 0.0), FACING_X)
    send_info(at)
    at.turn()
    corners = at.xyz("polygons")
    np.testing.assert_allclose(corners[0], (1.0, 0.0, 0.0), atol=1e-6)
    # 16 pixels at a focal length of 16 are 2 m wide at 2 m; 12 are 1.5 m high.
    np.testing.assert_allclose(corners[1], (3.0, 1.0, 0.75), atol=1e-6)
    np.testing.assert_allclose(corners[3], (3.0, -1.0, -0.75), atol=1e-6)
    assert at.statuses()["Camera Info"] == ("OK", "16 x 12, focal length 16 px.")


def test_the_image_lies_at_the_far_end(bench: Benches) -> None:
    at = bench(CameraInfo(far_clip=2.0, show_image=True))
    at.transform("map", "camera")
    at.send(photos.RAW, photos.raw(COLORS, "rgb8"), frame="camera", topic="/camera/image_raw")
    at.turn()
    assert at.statuses()["Image"][0] == "WARN"
    send_info(at, "/camera/camera_info")
    at.turn()
    at.settle()
    image, pose = at.nodes()["image"], at.poses()["image"]
    assert (image.width, image.height) == pytest.approx((2.0, 1.5))
    np.testing.assert_array_equal(image.cells[..., :3], COLORS)
    assert at.statuses()["Image"] == ("OK", "16 x 12.")
    # The corner of the upper left pixel, 8 and 6 pixels from the middle.
    assert pose.position == pytest.approx((-1.0, -0.75, 2.0))
    send_info(at, "/camera/camera_info", binning_x=2)
    at.turn()
    at.settle()
    assert "belong to different cameras" in at.statuses()["Image"][1]


@pytest.mark.parametrize(
    ("frame", "changes", "level", "sentence"),
    [
        ("camera", {"p": [0.0] * 12, "k": [0.0] * 9}, "ERROR", "not calibrated"),
        ("camera", {"k": [float("nan")] * 9}, "WARN", "K of the camera info is invalid"),
        ("camera_link", {}, "WARN", "'camera_optical_frame'"),
        ("camera", {"p": [1e-300, *[0.0] * 4, 1e-300, *[0.0] * 6]}, "ERROR", "do not fit"),
    ],
)
def test_a_camera_that_cannot_be_right_is_named(
    bench: Benches, frame: str, changes: dict[str, Any], level: str, sentence: str
) -> None:
    at = bench(CameraInfo())
    at.transform("map", frame)
    send_info(at, frame=frame, **changes)
    at.turn()
    assert at.statuses()["Camera Info"][0] == level
    assert sentence in at.statuses()["Camera Info"][1]


def cloud(bench: Benches, **values: Any) -> DisplayBench:
    at = bench(DepthCloud(topic=Topic(DEPTH), **{"auto_size": False, **values}))
    at.transform("map", "camera", (1.0, 0.0, 0.0), FACING_X)
    return at


def send_depth(at: DisplayBench, depths: Any, encoding: str = "32FC1", **options: Any) -> None:
    at.send(photos.RAW, photos.raw(depths, encoding), frame="camera", topic=DEPTH, **options)


@pytest.mark.parametrize(("encoding", "scale"), [("32FC1", 1.0), ("16UC1", 1000.0)])
def test_depths_are_points_where_the_camera_sees_them(
    bench: Benches, encoding: str, scale: float
) -> None:
    at = cloud(bench)
    depths = np.zeros((12, 16))
    depths[3, 10] = 2.0
    send_info(at, INFO)
    send_depth(at, (depths * scale).astype("f4" if scale == 1.0 else "u2"), encoding)
    at.turn()
    at.settle()
    # Right of the middle by (10 - 7.5) / 16 · 2 m, above it by (5.5 - 3) / 16 · 2 m.
    np.testing.assert_allclose(at.xyz("points"), [(3.0, -0.3125, 0.3125)], atol=1e-5)
    assert at.statuses()["Points"] == ("OK", "1 point of 192 pixels.")


def test_a_missing_camera_info_is_named_and_helps_at_once(bench: Benches) -> None:
    at = cloud(bench)
    send_depth(at, DEPTHS)
    at.turn()
    at.settle()
    assert "No camera info yet" in at.statuses()["Camera Info"][1]
    assert INFO in at.statuses()["Topic (camera_info_topic)"][1]
    send_info(at, INFO)
    at.turn()
    at.settle()
    assert len(at.xyz("points")) == np.isfinite(DEPTHS).sum()
    spread = np.ptp(at.xyz("points")[:, 1])
    p = photos.info(16, 12)["p"]
    send_info(at, INFO, p=[p[0] / 2, *p[1:]])
    at.turn()
    at.settle()
    assert np.ptp(at.xyz("points")[:, 1]) == pytest.approx(2 * spread, rel=1e-5)


def test_points_have_the_colors_of_the_image_of_their_stamp(bench: Benches) -> None:
    at = cloud(bench, color_topic=Topic(COLOR))
    send_info(at, INFO)
    for value, late in ((10, 0.0), (20, 0.02)):
        at.turn(1.0)
        colors = np.full_like(COLORS, value)
        stamp_ns = at.now_ns + round(late * 1e9)
        values = photos.jpeg(colors)
        at.send(photos.COMPRESSED, values, frame="camera", topic=COLOR, stamp_ns=stamp_ns)
        send_depth(at, DEPTHS)
        at.turn(0.1)
        at.settle()
        assert abs(int(at.nodes()["points"].colors[0, 0]) - value) <= 2
    values = photos.jpeg(np.zeros((6, 8, 3), np.uint8))
    at.send(photos.COMPRESSED, values, frame="camera", topic=COLOR)
    send_depth(at, DEPTHS)
    at.turn()
    at.settle()
    assert "8 x 6 pixels, the depth image 16 x 12" in at.statuses()["Points"][1]


@pytest.mark.parametrize(
    ("depths", "encoding", "sentence"),
    [
        (COLORS, "rgb8", "Expected depths as 16UC1 (mm) or 32FC1 (m), got rgb8"),
        (DEPTHS[:6], "32FC1", "has 16 x 6 pixels, the camera info 16 x 12"),
        (np.full((12, 16), np.nan, np.float32), "32FC1", "No pixel has a depth"),
        (np.full((12, 16), 1e38, np.float32), "32FC1", "No pixel has a depth"),
        (np.full((12, 16), -1.0, np.float32), "32FC1", "No pixel has a depth"),
    ],
)
def test_invalid_depth_images_are_reported(
    bench: Benches, depths: Any, encoding: str, sentence: str
) -> None:
    at = cloud(bench)
    send_info(at, INFO)
    send_depth(at, depths, encoding)
    at.turn()
    at.settle()
    assert sentence in at.statuses()["Points"][1]


def test_an_image_that_comes_while_the_first_is_computed_follows_it(bench: Benches) -> None:
    at = cloud(bench)
    send_info(at, INFO)
    for _ in range(2):
        send_depth(at, np.full((12, 16), 2000, "u2"), "16UC1")
        at.turn()
    at.settle()
    assert at.statuses()["Points"] == ("OK", "192 points of 192 pixels.")


def test_an_equal_camera_info_redraws_nothing(bench: Benches) -> None:
    at = cloud(bench)
    send_info(at, INFO)
    send_depth(at, np.full((12, 16), 2.0, np.float32))
    at.turn()
    at.settle()
    (node,) = at.nodes().values()
    send_info(at, INFO)
    at.turn()
    assert at.nodes()["points"] is node
    at.set("color_transformer", "FlatColor")
    assert at.nodes()["points"].colors == (255, 255, 255)


def test_depths_of_a_right_camera_are_seen_from_its_own_frame(bench: Benches) -> None:
    at = cloud(bench)
    p = photos.info(16, 12)["p"]
    send_info(at, INFO, p=[*p[:3], -1.92, *p[4:]])
    depths = np.zeros((12, 16), np.float32)
    depths[3, 10] = 2.0
    send_depth(at, depths)
    at.turn()
    at.settle()
    # As without the last column of P, which is the place of the camera beside the left one.
    np.testing.assert_allclose(at.xyz("points"), [(3.0, -0.3125, 0.3125)], atol=1e-5)


def test_points_of_a_thinned_image_are_as_large_as_those_left_are_apart(bench: Benches) -> None:
    at = cloud(bench, auto_size=True, max_points=12, style="Boxes")
    send_info(at, INFO)
    send_depth(at, np.full((12, 16), 2.0, np.float32))
    at.turn()
    at.settle()
    solids = at.nodes()["solids"]
    assert len(solids.positions) == 12  # every fourth pixel, at a focal length of 16 px
    np.testing.assert_allclose(solids.scales, 2.0 * 4 / 16)
    across = np.unique(np.round(solids.positions[:, 1], 4))
    np.testing.assert_allclose(np.diff(across), 2.0 * 4 / 16, atol=1e-4)


def test_points_are_as_large_as_neighbours_are_apart(bench: Benches) -> None:
    at = cloud(bench, auto_size=True, auto_size_factor=2.0)
    depths = np.full((12, 16), 1.0, np.float32)
    depths[0, 0] = 8.0
    send_info(at, INFO)
    send_depth(at, depths)
    at.turn()
    at.settle()
    # The focal length is 16 px, hence 2/16 m at 1 m.
    node = at.nodes()["points"]
    assert node.size == 2 / 16
    a, b, c, d = node.plane
    np.testing.assert_allclose(node.xyz @ (a, b, c) + d, [8.0, *[1.0] * 191], rtol=1e-6)
    at.set("style", "Boxes")
    np.testing.assert_allclose(at.nodes()["solids"].scales[:2, 0], (8 * 2 / 16, 2 / 16))


def hiding(bench: Benches, **values: Any) -> DisplayBench:
    """A wall 4 m ahead, then something 2 m ahead of one of its pixels."""
    at = cloud(bench, occlusion_compensation=True, color_topic=Topic(COLOR), **values)
    send_info(at, INFO)
    depths = np.full((12, 16), 4.0, np.float32)
    for value in (200, 100):
        colors = np.full_like(COLORS, value)
        at.send(photos.RAW, photos.raw(colors, "rgb8"), frame="camera", topic=COLOR)
        send_depth(at, depths)
        depths[3, 10], depths[0, 0] = 2.0, 4.005
        at.turn(1.0)
        at.settle()
    return at


def test_points_hidden_by_nearer_ones_stay_at_half_their_brightness(bench: Benches) -> None:
    at = hiding(bench)
    points = at.nodes()["points"]
    assert at.statuses()["Points"] == ("OK", "192 points of 192 pixels, and 1 hidden behind them.")
    assert at.xyz("points")[-1] == pytest.approx((5.0, -0.625, 0.625))
    assert points.colors[-1].tolist() == [100, 100, 100]
    assert (points.colors[:-1] == 100).all()
    assert points.ids[-1] == points.ids[3 * 16 + 10] == 3 * 16 + 10
    # A pixel without a depth hides what was there as well.
    at.send(photos.RAW, photos.raw(COLORS, "rgb8"), frame="camera", topic=COLOR)
    send_depth(at, np.full((12, 16), np.nan, np.float32))
    at.turn(1.0)
    at.settle()
    assert len(at.xyz("points")) == 192


@pytest.mark.parametrize(("distance", "remaining"), [(0.009, 193), (0.011, 192)])
def test_hidden_points_go_when_the_camera_moves(
    bench: Benches, distance: float, remaining: int
) -> None:
    at = hiding(bench)
    at.transform("map", "camera", (1.0 + distance, 0.0, 0.0), FACING_X)
    near = np.full((12, 16), 4.0, np.float32)
    near[3, 10] = 1.0
    at.send(photos.RAW, photos.raw(COLORS, "rgb8"), frame="camera", topic=COLOR)
    send_depth(at, near)
    at.turn(0.1)
    at.settle()
    assert len(at.xyz("points")) == remaining


def test_hidden_points_go_after_the_time_out(bench: Benches) -> None:
    at = hiding(bench, occlusion_time_out=0.5)
    assert len(at.xyz("points")) == 192


class TestCameraInfo(BuiltInChecks):
    display = CameraInfo
    messages: ClassVar = {}
    scene = camera_infos
