"""The Camera display, without a browser."""

from __future__ import annotations

from typing import Any, ClassVar

import lenses
import numpy as np
import photos
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import cameras
from inspecting import Benches

from webviz import Topic
from webviz.api.declared import make
from webviz.api.group import DisplayGroup
from webviz.data.images import values as values_of
from webviz.engine.parts.visibility import hidden_in, names
from webviz.engine.state import Row
from webviz.files.rviz import switch_tree
from webviz.files.rviz.values import Unfit
from webviz.shell.testing import DisplayBench
from webviz.shell.testing.source import SECOND
from webviz_displays.axes import Axes
from webviz_displays.camera import Camera

COLORS, DEPTHS = photos.room(16, 12)
IMAGE, INFO = "/camera/image_raw", "/camera/camera_info"


def send(at: DisplayBench, stamp_ns: int | None = None, frame: str = "camera") -> None:
    values = photos.raw(COLORS, "rgb8")
    at.send(photos.RAW, values, frame=frame, topic=IMAGE, stamp_ns=stamp_ns)


def send_info(at: DisplayBench, stamp_ns: int | None = None, **changes: Any) -> None:
    values = photos.info(16, 12) | changes
    at.send(photos.INFO, values, frame="camera", topic=INFO, stamp_ns=stamp_ns)


def test_the_camera_sees_from_where_it_was_at_the_stamp(bench: Benches) -> None:
    at = bench(Camera(overlay_alpha=0.25, zoom_factor=2.0, far_plane_distance=30.0))
    at.transform("map", "camera", (1.0, 2.0, 3.0))
    send(at)
    at.turn()
    assert at.nodes()["pane"].camera is None
    assert "No camera info yet" in at.statuses()["Camera Info"][1]
    p = photos.info(16, 12)["p"]
    send_info(at, p=[*p[:3], -1.6, *p[4:]])
    at.turn()
    camera = at.nodes()["pane"].camera
    assert camera.position == pytest.approx((1.1, 2.0, 3.0))  # of the right camera of a pair
    assert (camera.size, camera.focal, camera.principal) == ((16, 12), (16, 16), (7.5, 5.5))
    assert (camera.part, camera.far, camera.zoom, camera.overlay) == ((0, 0, 1, 1), 30.0, 2.0, 0.25)
    assert camera.is_background
    assert camera.warp is None
    assert at.statuses()["Camera Info"] == ("OK", "16 x 12, focal length 16 px.")
    at.set("image_rendering", "background")
    at.turn()
    assert at.nodes()["pane"].camera.overlay == 0.0
    at.set("image_rendering", "overlay")
    at.turn()
    assert not at.nodes()["pane"].camera.is_background


def test_a_region_of_interest_is_a_part_of_the_camera_image(bench: Benches) -> None:
    at = bench(Camera())
    at.transform("map", "camera")
    send(at)
    roi = {"x_offset": 8, "y_offset": 6, "width": 32, "height": 24, "do_rectify": False}
    values = photos.info(64, 48, roi=roi, binning_x=2, binning_y=2)
    at.send(photos.INFO, values, frame="camera", topic=INFO)
    at.turn()
    camera = at.nodes()["pane"].camera
    assert (camera.size, camera.focal) == ((64, 48), (64, 64))
    assert camera.part == (0.125, 0.125, 0.625, 0.625)
    assert at.statuses()["Camera Info"][0] == "OK"


def test_raw_images_are_undistorted_and_rectified_ones_are_not(bench: Benches) -> None:
    for topic, choice, is_bent in (
        ("/camera/image_raw", "Auto", True),
        ("/camera/image_raw", "Never", False),
        ("/camera/image_rect_color/compressed", "Auto", False),
        ("/camera/image_rect", "Always", True),
        ("/direct/image", "Auto", True),
    ):
        values = {"topic": topic, "camera_info_topic": INFO, "undistort": choice}
        at = bench(make(Camera, values))
        at.transform("map", "camera")
        big = np.zeros((lenses.HEIGHT, lenses.WIDTH), np.uint8)
        at.send(photos.RAW, photos.raw(big, "mono8"), frame="camera", topic=topic)
        at.send(photos.INFO, lenses.info("plumb_bob"), frame="camera", topic=INFO)
        at.turn()
        warp = at.nodes()["pane"].camera.warp
        assert (warp is not None) == is_bent, topic
        level, text = at.statuses()["Camera Info"]
        assert level == "OK"
        assert ("undistorted by plumb_bob" in text) == is_bent
        at.send(photos.RAW, photos.raw(big + 1, "mono8"), frame="camera", topic=topic)
        at.turn()
        assert at.nodes()["pane"].camera.warp is warp


@pytest.mark.parametrize(
    ("frame", "changes", "level", "sentence"),
    [
        ("camera", {"p": [0.0] * 12, "k": [0.0] * 9}, "ERROR", "not calibrated"),
        ("camera", {"p": [float("nan")] * 12}, "ERROR", "invalid"),
        ("camera", {"width": 32}, "WARN", "16 x 12 pixels, the camera info 32 x 12"),
        ("camera", {"d": [1.0], "distortion_model": "other"}, "WARN", "Unsupported distortion"),
        ("camera", {"k": [0.0] * 9}, "WARN", "K of the camera info is invalid"),
        ("camera", {"d": [1e308] * 5, "distortion_model": "plumb_bob"}, "WARN", "sees nothing"),
        ("camera_link", {}, "WARN", "'camera_optical_frame'"),
        ("camera", {"width": 0, "height": 0}, "OK", "16 x 12"),
    ],
)
def test_a_camera_that_cannot_be_right_is_named(
    bench: Benches, frame: str, changes: dict[str, Any], level: str, sentence: str
) -> None:
    at = bench(Camera())
    at.transform("map", frame)
    send(at, frame=frame)
    send_info(at, **changes)
    at.turn()
    assert at.statuses()["Camera Info"][0] == level
    assert sentence in at.statuses()["Camera Info"][1]


def test_the_camera_info_beside_the_images_is_offered_for_a_wrong_one(bench: Benches) -> None:
    camera = Camera(camera_info_topic=Topic("/camera/camera_info"))
    at = bench(camera)
    at.transform("map", "camera")
    send(at)
    send_info(at, width=32)
    at.turn()
    at.press("Camera Info")
    assert camera.camera_info_topic.name == ""


def test_an_image_has_the_camera_info_of_its_stamp(bench: Benches) -> None:
    at = bench(Camera())
    at.transform("map", "camera")
    for second, width in ((1, 16), (2, 20), (3, 24)):
        p = [width, 0, 7.5, 0, 0, width, 5.5, 0, 0, 0, 1, 0]
        send_info(at, second * SECOND, p=p)
        at.turn()
    for second, focal in ((2, 20), (3, 24)):
        send(at, second * SECOND)
        at.turn()
        assert at.nodes()["pane"].camera.focal[0] == focal
        assert at.statuses()["Camera Info"][0] == "OK"
    send(at, 4 * SECOND)
    at.turn()
    assert at.statuses()["Camera Info"][0] == "OK"  # a busy machine skipped one
    send(at, 9 * SECOND)
    at.turn()
    assert "differs by 6 s" in at.statuses()["Camera Info"][1]


def test_an_image_that_is_decompressed_keeps_the_pose_of_its_stamp(bench: Benches) -> None:
    topic = "/camera/image_raw/compressed"
    at = bench(Camera(topic=Topic(topic), camera_info_topic=Topic(INFO)))
    send_info(at)
    for second, x in ((1, 1.0), (2, 2.0)):
        at.transform("map", "camera", (x, 0.0, 0.0), stamp_ns=second * SECOND)
        values = photos.png16(np.full((12, 16), second, np.uint16))
        at.send(photos.COMPRESSED, values, frame="camera", stamp_ns=second * SECOND, topic=topic)
        at.turn()
    observed = set()
    while at.runner.is_busy() or not observed:
        at.turn()
        if pane := at.nodes().get("pane"):
            value = int(values_of(pane.picture.image)[0, 0])
            observed.add((value, pane.camera.position[0]))
    assert observed <= {(1, 1.0), (2, 2.0)}
    assert (2, 2.0) in observed


def test_displays_and_groups_are_left_out_by_their_names() -> None:
    camera = Camera(visibility={"Robot": False, "Map > Axes": False, "Gone": False})
    group, axes = DisplayGroup(name="Group"), Axes(name="Axes")
    rows = (
        Row("0", "Camera", camera, "Camera", {}),
        Row("1", "Group", group, "Robot", {}),
        Row("2", "Group", group, "Arm", {}, depth=1),
        Row("3", "Axes", axes, "Axes", {}, depth=2),
        Row("4", "Group", group, "Map", {}),
        Row("5", "Axes", axes, "Axes", {}, depth=1),
        Row("6", "Axes", axes, "Axes", {}),
    )
    assert hidden_in(rows, rows) == {"0": ["1", "2", "3", "5"]}
    assert list(names(rows, rows[0])) == [
        *("Robot", "Robot > Arm", "Robot > Arm > Axes", "Map", "Map > Axes", "Axes"),
    ]


def test_rviz_nests_the_switches_of_displays() -> None:
    tree = {"Grid": True, "Robot": {"Arm": {"Axes": False, "Value": True}, "Value": False}}
    switches = switch_tree.read({**tree, "Value": True})
    assert switches == {
        "Grid": True,
        "Robot": False,
        "Robot > Arm": True,
        "Robot > Arm > Axes": False,
    }
    assert switch_tree.write(switches) == {**tree, "Value": True}
    deep: dict[str, Any] = {}
    for _ in range(70):
        deep = {"Group": deep}
    for wrong in (deep, "text", {"Grid": "perhaps"}, {"Robot": {"Arm": [1]}}):
        with pytest.raises(Unfit):
            switch_tree.read(wrong)


class TestCamera(BuiltInChecks):
    display = Camera
    messages: ClassVar = {}
    scene = cameras
    later = ("median_window",)
    needs: ClassVar = {"show_labels": {"annotations_topic": Topic("/found")}}
    elsewhere = ("undistort", "visibility")
