"""Messages in Foxglove's own schemas, made by Foxglove's own library."""

from __future__ import annotations

import json
import math
from typing import Any

import foxglove  # pyright: ignore[reportMissingImports]
import foxglove.channels as channels  # pyright: ignore[reportMissingImports]
import foxglove.messages as fox  # pyright: ignore[reportMissingImports]
import numpy as np
import pytest
from bridges import reading

from webviz.data.foxglove import schemas
from webviz.data.foxglove.schemas import Conversion, ConversionError, conversion, problem_of
from webviz.data.messages import decode

TIME = fox.Timestamp(sec=7, nsec=8)
RED = fox.Color(r=1.0, g=0.0, b=0.0, a=0.5)
BASE: dict[str, Any] = {"timestamp": TIME, "frame_id": "base"}
TURNED = fox.Pose(
    position=fox.Vector3(x=10.0, y=0.0, z=0.0),
    orientation=fox.Quaternion(x=0.0, y=0.0, z=math.sqrt(0.5), w=math.sqrt(0.5)),
)


def conversion_of(name: str) -> Conversion:
    result = conversion(f"foxglove.{name}")
    assert result
    return result


def converted(message: Any) -> Any:
    result = conversion_of(type(message).__name__)
    return decode(result.type, result.convert("protobuf", message.encode()))


def test_transforms() -> None:
    one = fox.FrameTransform(
        timestamp=TIME,
        parent_frame_id="odom",
        child_frame_id="base",
        translation=fox.Vector3(x=1.0, y=2.0, z=3.0),
        rotation=fox.Quaternion(x=0.0, y=0.0, z=0.0, w=1.0),
    )
    for message in (one, fox.FrameTransforms(transforms=[one])):
        (transform,) = converted(message).transforms
        assert (transform.parent, transform.child) == ("odom", "base")
        assert transform.stamp_ns == 7_000_000_008


def test_a_scene_is_markers_of_a_namespace_for_each_entity() -> None:
    points = [fox.Point3(x=float(i), y=0.0, z=0.0) for i in range(3)]
    entity = fox.SceneEntity(
        **BASE,
        id="box",
        arrows=[fox.ArrowPrimitive(shaft_length=1.0, head_length=0.5, color=RED)],
        cubes=[fox.CubePrimitive(pose=TURNED, size=fox.Vector3(x=1.0, y=2.0, z=3.0), color=RED)],
        lines=[
            fox.LinePrimitive(
                type=fox.LinePrimitiveLineType.LineLoop, points=points, indices=[2, 0, 9]
            )
        ],
        triangles=[fox.TriangleListPrimitive(points=points, colors=[RED] * 3)],
        texts=[fox.TextPrimitive(text="hello", font_size=0.2)],
    )
    gone = fox.SceneEntityDeletion(id="old", type=fox.SceneEntityDeletionType.MatchingId)
    markers = list(converted(fox.SceneUpdate(entities=[entity], deletions=[gone])).markers)
    assert [(m.ns, m.action) for m in markers[:2]] == [("old", 3), ("box", 3)]
    arrow, cube, loop, triangles, text = markers[2:]
    assert arrow.points[1, 0] == 1.5
    assert (cube.type, cube.scale.y, cube.pose.position.x, cube.color.a) == (1, 2.0, 10.0, 0.5)
    assert loop.points[:, 0].tolist() == [2.0, 0.0, 2.0]
    assert len(triangles.colors) == len(triangles.points) == 3
    assert (text.text, text.id) == ("hello", 4)


def test_a_cloud_is_at_its_pose() -> None:
    xyz = np.array([[1, 0, 0], [0, 1, 0]], np.float32)
    kind = fox.PackedElementFieldNumericType.Float32
    fields = [fox.PackedElementField(name=n, offset=4 * i, type=kind) for i, n in enumerate("xyz")]
    cloud: dict[str, Any] = {**BASE, "point_stride": 12, "fields": fields, "data": xyz.tobytes()}
    still = converted(fox.PointCloud(**cloud))
    assert (still.width, still.point_step) == (2, 12)
    assert still.data.tobytes() == xyz.tobytes()
    positions = converted(fox.PointCloud(**cloud, pose=TURNED)).data.view(np.float32).reshape(2, 3)
    assert positions == pytest.approx(np.array([[10, 1, 0], [9, 0, 0]]), abs=1e-6)
    with pytest.raises(ConversionError, match="fields outside of its points"):
        converted(fox.PointCloud(**{**cloud, "point_stride": 11}))


def test_scans_grids_and_images() -> None:
    ranges = [1.0, 2.0, math.inf]
    scan = converted(fox.LaserScan(**BASE, start_angle=-1.0, end_angle=1.0, ranges=ranges))
    assert (scan.angle_increment, scan.range_max, list(scan.ranges)) == (1.0, 3.0, ranges)
    with pytest.raises(ConversionError, match="which scans of ROS do not have"):
        converted(fox.LaserScan(**BASE, pose=TURNED))
    field = fox.PackedElementField(
        name="cost", offset=1, type=fox.PackedElementFieldNumericType.Int8
    )
    cells = bytes([9, 0, 9, 100, 7, 9, 255, 9, 50, 7])
    grid = converted(
        fox.Grid(
            **BASE,
            column_count=2,
            cell_size=fox.Vector2(x=0.1, y=0.1),
            row_stride=5,
            cell_stride=2,
            fields=[field],
            data=cells,
        )
    )
    assert list(grid.data) == [0, 100, -1, 50]
    assert (grid.info.width, grid.info.height) == (2, 2)
    image = converted(fox.RawImage(**BASE, width=2, height=1, encoding="mono8", step=2, data=b"ab"))
    assert (image.width, image.encoding, bytes(image.data)) == (2, "mono8", b"ab")
    jpeg = converted(fox.CompressedImage(**BASE, data=b"xyz", format="jpeg"))
    assert (jpeg.format, bytes(jpeg.data)) == ("jpeg", b"xyz")
    calibration = converted(
        fox.CameraCalibration(**BASE, width=4, height=3, K=[float(i) for i in range(9)])
    )
    assert list(calibration.p)[:4] == [0.0, 1.0, 2.0, 0.0]
    with pytest.raises(ConversionError, match="matrices of invalid sizes"):
        converted(fox.CameraCalibration(**BASE, K=[1.0]))


def test_poses_places_and_logs() -> None:
    pose = converted(fox.PoseInFrame(**BASE, pose=TURNED))
    assert (pose.header.frame_id, pose.pose.position.x) == ("base", 10.0)
    fix = converted(fox.LocationFix(**BASE, latitude=50.0, longitude=8.0))
    assert (fix.latitude, fix.header.stamp.sec) == (50.0, 7)
    log = converted(fox.Log(timestamp=TIME, level=fox.LogLevel.Warning, message="hot", name="arm"))
    assert (log.level, log.msg, log.name) == (30, "hot", "arm")


def test_json_has_times_as_objects() -> None:
    result = conversion_of("SceneUpdate")
    entity = {
        "timestamp": {"sec": 7, "nsec": 8},
        "lifetime": {"sec": 1, "nsec": 500_000_000},
        "frame_id": "base",
        "id": "a",
        "cubes": [{"size": {"x": 1}, "color": {"r": 1, "a": 1}}],
        "of_the_future": 5,
    }
    payload = json.dumps({"entities": [entity]}).encode()
    cube = list(decode(result.type, result.convert("json", payload)).markers)[1]
    assert (cube.header.stamp.nanosec, cube.lifetime.sec, cube.scale.x) == (8, 1, 1.0)


@pytest.mark.parametrize("payload", [b"", b"{", b"[]", b"[" * 100_000, b'{"entities": 5}'])
def test_invalid_json_is_an_error(payload: bytes) -> None:
    with pytest.raises(ConversionError, match=r"not a valid foxglove\.SceneUpdate"):
        conversion_of("SceneUpdate").convert("json", payload)


def test_invalid_protobuf_is_an_error() -> None:
    with pytest.raises(ConversionError, match=r"not a valid foxglove\.PointCloud"):
        conversion_of("PointCloud").convert("protobuf", b"\xff" * 100)


def test_unsupported_schemas_have_a_reason(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "no equal message in ROS" in problem_of("foxglove.GeoJSON", "foxglove.GeoJSON")
    assert not problem_of("foxglove.Grid", "foxglove.Grid")
    monkeypatch.setattr(schemas, "_is_installed", lambda: False)
    assert "pip install 'ros-webviz[foxglove]'" in problem_of("foxglove.Grid", "foxglove.Grid")


def test_channels_of_a_server_are_topics_of_ros() -> None:
    context = foxglove.Context()
    pose = channels.PoseInFrameChannel("/pose", context=context)
    server = foxglove.start_server(host="127.0.0.1", port=0, context=context)
    try:
        with reading(f"ws://127.0.0.1:{server.port}") as reader:
            reader.until_up()
            reader.want(pose="geometry_msgs/msg/PoseStamped")

            def arrives() -> bool:
                pose.log(fox.PoseInFrame(**BASE, pose=TURNED))
                return reader.source.inbox.received().get("/pose", (0, 0))[0] > 0

            reader.until(arrives)
            message = reader.decoded("/pose", "geometry_msgs/msg/PoseStamped")
            assert message.pose.position.x == 10.0
    finally:
        server.stop()


def test_video_is_kept_byte_for_byte() -> None:
    video = converted(fox.CompressedVideo(**BASE, data=b"\0\0\0\1\x67", format="h264"))
    assert (video.timestamp.sec, video.frame_id, video.format) == (7, "base", "h264")
    assert bytes(video.data) == b"\0\0\0\1\x67"
