import math
from typing import Any

import numpy as np
import pytest
import yourdfpy
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from rosbags.typesys import Stores, get_typestore

from webviz.data.messages import FrameTransform
from webviz_sim import messages
from webviz_sim.description import demo_description, read_joints
from webviz_sim.pose import Pose2D

STORE = get_typestore(Stores.ROS2_JAZZY)
FRAMES = st.text(st.characters(codec="utf-8", exclude_characters="\0"), max_size=12)
NUMBERS = st.floats(allow_nan=False)


@pytest.fixture(scope="module")
def robot(tmp_path_factory: pytest.TempPathFactory) -> yourdfpy.URDF:
    """The bundled robot, read by another library, without its meshes."""
    path = tmp_path_factory.mktemp("urdf") / "robot.urdf"
    path.write_text(demo_description())
    return yourdfpy.URDF.load(str(path), load_meshes=False, build_scene_graph=True)


def read_cdr(raw: bytes, kind: str) -> Any:
    return STORE.deserialize_cdr(raw, kind)


def matrix(quaternion: tuple[float, float, float, float]) -> NDArray[np.float64]:
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


@pytest.mark.parametrize("angle", [0.0, 0.7, -2.5, 100.0])
def test_joints_move_the_links_as_another_urdf_reader_moves_them(
    robot: yourdfpy.URDF, angle: float
) -> None:
    joints = read_joints(demo_description())
    assert [j.name for j in joints if j.kind == "continuous"] == robot.actuated_joint_names
    robot.update_cfg([angle] * len(robot.actuated_joint_names))
    for joint in joints:
        transform = joint.transform(0, angle if joint.kind == "continuous" else 0.0)
        expected = robot.get_transform(transform.child, transform.parent)
        assert np.allclose(matrix(transform.rotation), expected[:3, :3])
        assert np.allclose(transform.translation, expected[:3, 3])


def test_the_bundled_robot_is_valid_and_stands_on_the_floor(robot: yourdfpy.URDF) -> None:
    assert robot.validate()
    assert robot.base_link == "base_link"
    wheel = robot.get_transform("wheel_left_link")
    radius = robot.link_map["wheel_left_link"].visuals[0].geometry.cylinder.radius
    assert wheel[2, 3] == radius


@settings(deadline=None)
@given(
    st.lists(
        st.builds(
            FrameTransform,
            FRAMES,
            FRAMES,
            st.integers(0, 2**31 * 10**9 - 1),
            st.tuples(*[NUMBERS] * 3),
            st.tuples(*[NUMBERS] * 4),
        ),
        max_size=4,
    )
)
def test_serialised_transforms_are_read_back_as_they_were(transforms: list[FrameTransform]) -> None:
    message = read_cdr(messages.tf(transforms), "tf2_msgs/msg/TFMessage")
    assert len(message.transforms) == len(transforms)
    for read, transform in zip(message.transforms, transforms, strict=True):
        time, turn, shift = read.header.stamp, read.transform.rotation, read.transform.translation
        assert time.sec * 10**9 + time.nanosec == transform.stamp_ns
        assert (read.header.frame_id, read.child_frame_id) == (transform.parent, transform.child)
        assert (shift.x, shift.y, shift.z) == transform.translation
        assert (turn.x, turn.y, turn.z, turn.w) == transform.rotation


def test_a_serialised_path_is_read_back_with_poses_along_it() -> None:
    points = np.array([[0.0, 0.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]])
    raw = messages.path(points, 1_500_000_007)
    path = read_cdr(raw, "nav_msgs/msg/Path")
    assert path.header.frame_id == "map"
    assert [[p.pose.position.x, p.pose.position.y] for p in path.poses] == points.tolist()
    for pose in path.poses:
        assert (pose.header.stamp.sec, pose.header.stamp.nanosec) == (1, 500_000_007)
        assert pose.header.frame_id == "map"
    yaws = [2 * math.atan2(p.pose.orientation.z, p.pose.orientation.w) for p in path.poses]
    assert yaws == pytest.approx([math.pi / 4, math.atan2(2, 1), math.atan2(1, -1), math.pi])


@pytest.mark.parametrize(
    ("x", "reason"),
    [(math.nan, "that is not finite"), (-1e308, "that is farther than 1e+09 m"), (3.0, "")],
)
def test_a_pose_must_be_finite_and_within_reach(x: float, reason: str) -> None:
    pose = messages.encode(
        "geometry_msgs/msg/PoseStamped",
        {"header": {"frame_id": "map"}, "pose": {"position": {"x": x}, "orientation": {"w": 1.0}}},
    )
    read = read_cdr(pose, "geometry_msgs/msg/PoseStamped")
    result = messages.to_map_pose(read.header, read.pose)
    assert result == (reason or Pose2D(x, 0.0, 0.0))
