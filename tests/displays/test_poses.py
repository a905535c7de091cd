"""Pose, PoseWithCovariance, PoseArray, ParticleCloud and PointStamped."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import POSE as INSPECTED_POSE
from inspecting import POSE_TOLD, Benches
from plain_scenes import COVARIANCE, at, in_moving_frame, turned

from webviz.data.rotations import matrices
from webviz.shell.testing import check_details
from webviz_displays.poses import (
    ParticleCloud,
    PointStamped,
    Pose,
    PoseArray,
    PoseWithCovariance,
)
from webviz_displays.poses import pose_set as pose_sets

NAN = float("nan")
POSE = "geometry_msgs/msg/PoseStamped"
ARRAY = "geometry_msgs/msg/PoseArray"
POINT = "geometry_msgs/msg/PointStamped"


def pose(x: float, y: float = 0.0, turn: tuple[float, ...] = (0, 0, 0, 1)) -> dict[str, Any]:
    return {"position": {"x": x, "y": y}, "orientation": dict(zip("xyzw", turn, strict=True))}


def test_a_pose_is_an_arrow_along_x_of_rvizs_size(turned: Benches) -> None:
    at = turned(Pose(), {"pose": pose(1.0)})
    node = at.nodes()["poses"]
    np.testing.assert_allclose(at.xyz("poses"), [[(10, 1, 0), (10, 2.3, 0)]], atol=1e-6)
    assert (node.shaft_radius, node.head_radius, node.head_length) == (0.05, 0.1, 0.3)
    assert node.colors == (255, 25, 0)
    assert at.statuses()["Pose"] == ("OK", "Showing 1 pose.")


def test_former_poses_stay_where_their_frame_was(bench: Benches) -> None:
    at = bench(Pose(history_length=2))
    for x in (1.0, 2.0, 3.0):
        at.transform("map", "odom", (x, 0.0, 0.0), stamp_ns=at.now_ns)
        at.send(POSE, {"pose": pose(0.0)}, frame="odom")
        at.turn(0.1)
    np.testing.assert_allclose(at.xyz("poses")[:, 0], [(2, 0, 0), (3, 0, 0)], atol=1e-6)


@pytest.mark.parametrize(
    ("turn", "sentence"),
    [((0, 0, 0, 0), "all zeros"), ((0, 0, 0, 7), "not normalised"), ((0, 0, 0, 1e200), "not norm")],
)
def test_an_unnormalised_quaternion_is_drawn_as_the_nearest_rotation(
    turned: Benches, turn: tuple[float, ...], sentence: str
) -> None:
    at = turned(Pose(), {"pose": pose(0.0, turn=turn)})
    np.testing.assert_allclose(at.xyz("poses")[0, 1], (10, 1.3, 0), atol=1e-6)
    level, text = at.statuses()["Orientation"]
    assert (level, sentence in text) == ("WARN", True)


def test_an_invalid_pose_is_named_and_the_former_ones_stay(turned: Benches) -> None:
    at = turned(Pose(history_length=3), {"pose": pose(1.0)}, {"pose": pose(NAN)})
    assert len(at.xyz("poses")) == 1
    level, text = at.statuses()["Pose"]
    assert (level, "not finite: position (nan" in text) == ("ERROR", True)
    at.send(POSE, {"pose": pose(2.0)}, frame="odom")
    at.turn()
    assert at.nodes()["poses"].ids.tolist() == [0, 2]
    assert at.statuses()["Pose"] == ("OK", "Showing 2 poses.")


def test_a_covariance_surrounds_its_pose(turned: Benches) -> None:
    covariance = np.diag([4.0, 0.0, 0.0, 0.0, 0.0, 0.01]).ravel()
    invalid = {"pose": {"pose": pose(NAN), "covariance": covariance}}
    message = {"pose": {"pose": pose(1.0), "covariance": covariance}}
    at = turned(PoseWithCovariance(history_length=2), invalid, message)
    assert at.nodes().keys() == {"poses", "ellipses", "wedges"}
    ellipse = at.nodes()["ellipses"]
    np.testing.assert_allclose(at.xyz("ellipses"), [(10, 1, 1e-3)], atol=1e-6)
    extent = np.abs(matrices(ellipse.wxyzs) * ellipse.scales[:, None, :]).max(axis=2)
    np.testing.assert_allclose(extent, [(0, 4, 1e-3)], atol=1e-5)  # odom's x is map's y
    assert ellipse.ids.tolist() == at.nodes()["poses"].ids.tolist() == [1]


def test_a_flat_arrow_is_three_lines_of_a_pixel(turned: Benches) -> None:
    at = turned(PoseArray(arrow_length=2.0), {"poses": [pose(1.0), pose(3.0)]})
    node = at.nodes()["poses"]
    assert (node.width, node.unit, node.ids.tolist()) == (1.0, "px", [0, 0, 0, 1, 1, 1])
    expected = [
        [(10, 1, 0), (10, 3, 0)],
        [(10, 3, 0), (9.6, 2.5, 0)],
        [(10, 3, 0), (10.4, 2.5, 0)],
    ]
    np.testing.assert_allclose(at.xyz("poses")[:3], expected, atol=1e-6)


def test_an_array_of_solid_arrows_or_axes(turned: Benches) -> None:
    at = turned(PoseArray(shape="Arrow (3D)"), {"poses": [pose(1.0)]})
    np.testing.assert_allclose(at.nodes()["shafts"].scales, [(0.02, 0.02, 0.23)], atol=1e-6)
    np.testing.assert_allclose(at.nodes()["heads"].scales, [(0.06, 0.06, 0.07)], atol=1e-6)
    np.testing.assert_allclose(at.xyz("heads"), [(10, 1.265, 0)], atol=1e-6)
    at.set("shape", "Axes")
    assert (at.nodes()["poses"].length, at.nodes()["poses"].radius) == (0.3, 0.01)


def test_poses_that_are_not_finite_are_left_out_and_counted(turned: Benches) -> None:
    at = turned(PoseArray(), {"poses": [pose(NAN), pose(1.0), pose(1e300)]})
    assert at.nodes()["poses"].ids.tolist() == [1, 1, 1]
    level, text = at.statuses()["Poses"]
    assert (level, text.startswith("2 of 3 poses are not finite")) == ("WARN", True)
    at.send(ARRAY, {"poses": []}, frame="odom")
    at.turn()
    assert at.statuses()["Poses"][0] == "WARN"


def test_poses_over_the_limit_are_thinned_evenly(
    turned: Benches, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(pose_sets, "MAX_POSES", 10)
    at = turned(PoseArray(shape="Axes"), {"poses": [pose(i) for i in range(100)]})
    ids = at.nodes()["poses"].ids
    assert (len(ids), set(ids // 10)) == (10, set(range(10)))
    assert at.statuses()["Poses"] == ("WARN", "Showing 10 of 100 poses, evenly picked.")


def particles(*weights: float) -> dict[str, Any]:
    return {"particles": [{"pose": pose(i), "weight": w} for i, w in enumerate(weights)]}


@pytest.mark.parametrize(
    ("weight", "length"), [(0.0, 0.02), (0.5, 0.16), (1.0, 0.3), (7.0, 0.3), (-1.0, 0.02)]
)
def test_the_length_of_a_particle_is_its_weight(
    turned: Benches, weight: float, length: float
) -> None:
    at = turned(ParticleCloud(), particles(weight))
    tail, tip = at.xyz("poses")[0]
    assert tip - tail == pytest.approx((0, length, 0), abs=1e-6)


def test_solid_particles_have_the_proportions_of_rvizs(turned: Benches) -> None:
    at = turned(ParticleCloud(shape="Arrow (3D)", max_arrow_length=1.0), particles(1, 0))
    heads, shafts = at.nodes()["heads"], at.nodes()["shafts"]
    np.testing.assert_allclose(heads.scales[0], (0.1304, 0.1304, 0.3043), atol=1e-6)
    np.testing.assert_allclose(shafts.scales[0], (0.0435, 0.0435, 0.6957), atol=1e-6)
    np.testing.assert_allclose(heads.scales[1], np.multiply(0.02, heads.scales[0]), atol=1e-6)
    at.set("shape", "Axes")
    axes = at.nodes()["poses"]
    np.testing.assert_allclose(axes.scales[:3], [(0.0435, 0.0435, 1.0)] * 3, atol=1e-6)
    # Turned left, x is along y, y against x, and z up.
    middles = at.xyz("poses")[:3] - (10, 0, 0)
    np.testing.assert_allclose(middles, [(0, 0.5, 0), (-0.5, 0, 0), (0, 0, 0.5)], atol=1e-6)


def test_lengths_that_are_swapped_are_put_right(turned: Benches) -> None:
    at = turned(ParticleCloud(min_arrow_length=0.5), particles(1.0))
    assert at.statuses()["Length"][0] == "WARN"
    at.press("Length")


def test_non_finite_weights_count_as_zero(turned: Benches) -> None:
    at = turned(ParticleCloud(), particles(NAN, 1.0))
    assert at.xyz("poses")[0, 1] == pytest.approx((10, 0.02, 0), abs=1e-6)
    assert at.statuses()["Weight"][0] == "WARN"


def test_a_point_is_a_sphere_that_stays_where_its_frame_was(bench: Benches) -> None:
    at = bench(PointStamped(history_length=2))
    for x in (1.0, 2.0, 3.0):
        at.transform("map", "gripper", (x, 0.0, 0.0), stamp_ns=at.now_ns)
        at.send(POINT, {"point": {"z": 0.5}}, frame="gripper")
        at.turn(0.1)
    node = at.nodes()["points"]
    assert (node.shape, node.colors) == ("sphere", (204, 41, 204))
    np.testing.assert_allclose(node.scales, np.full((2, 3), 0.4), atol=1e-6)
    np.testing.assert_allclose(at.xyz("points"), [(2, 0, 0.5), (3, 0, 0.5)], atol=1e-6)
    at.transform("map", "gripper", stamp_ns=at.now_ns)
    at.send(POINT, {"point": {"x": NAN}}, frame="gripper")
    at.turn()
    assert len(at.xyz("points")) == 1
    assert at.statuses()["Point"][0] == "ERROR"


def test_far_from_the_origin_points_and_poses_keep_their_millimetres(turned: Benches) -> None:
    east = 448_262.123
    at = turned(PointStamped(), {"point": {"x": east}})
    assert at.xyz("points")[0] == pytest.approx((10, east, 0), abs=1e-4)
    at = turned(Pose(), {"pose": pose(east)})
    assert at.xyz("poses")[0, 0] == pytest.approx((10, east, 0), abs=1e-4)
    at = turned(PoseArray(shape="Axes"), {"poses": [pose(east)]})
    assert at.xyz("poses")[0] == pytest.approx((10, east, 0), abs=1e-4)


class TestParticleCloud(BuiltInChecks):
    display = ParticleCloud
    scene = in_moving_frame(
        "nav2_msgs/msg/ParticleCloud",
        *({"particles": [{"pose": at(x), "weight": 0.3}]} for x in (0.0, 1.0)),
    )
    variants = (
        lambda: ParticleCloud(shape="Axes"),
        ParticleCloud,
    )


class TestPointStamped(BuiltInChecks):
    display = PointStamped
    scene = in_moving_frame(
        "geometry_msgs/msg/PointStamped", {"point": {"x": 1.0}}, {"point": {"x": 2.0}}
    )


class TestPose(BuiltInChecks):
    display = Pose
    scene = in_moving_frame("geometry_msgs/msg/PoseStamped", {"pose": at(1.0)}, {"pose": at(2.0)})
    variants = (
        Pose,
        lambda: Pose(shape="Axes", history_length=3),
    )


class TestPoseArray(BuiltInChecks):
    display = PoseArray
    scene = in_moving_frame(
        "geometry_msgs/msg/PoseArray", {"poses": [at(1.0)]}, {"poses": [at(2.0), at(3.0)]}
    )
    variants = (
        PoseArray,
        lambda: PoseArray(shape="Arrow (3D)", history_length=3),
    )


class TestPoseWithCovariance(BuiltInChecks):
    display = PoseWithCovariance
    scene = in_moving_frame(
        "geometry_msgs/msg/PoseWithCovarianceStamped",
        *({"pose": {"pose": turned(x), "covariance": COVARIANCE}} for x in (1.0, 2.0)),
    )


def test_selecting_pose(turned: Benches) -> None:
    check_details(
        turned(Pose(), {"pose": INSPECTED_POSE}).pick("poses", 0),
        "Pose 0",
        {"Pose in odom": POSE_TOLD},
    )


def test_selecting_pose_with_covariance(turned: Benches) -> None:
    values = {
        "pose": {"pose": INSPECTED_POSE, "covariance": np.diag([0.04, 0, 0, 0, 0, 1]).ravel()}
    }
    check_details(
        turned(PoseWithCovariance(), values).pick("ellipses", 0),
        "Pose 0",
        {
            "Pose in odom": POSE_TOLD,
            "Standard deviations": "x 0.2, y 0, z 0, roll 0, pitch 0, yaw 1",
        },
    )


def test_selecting_pose_of_an_array(turned: Benches) -> None:
    """The last line of the second arrow."""
    values = {"poses": [{"position": {"x": math.nan}}, INSPECTED_POSE]}
    check_details(
        turned(PoseArray(), values).pick("poses", 2),
        "Pose 1",
        {"Pose in odom": POSE_TOLD, "Poses in the message": "2"},
    )


def test_selecting_particle(turned: Benches) -> None:
    """The y axis of the second."""
    values = {"particles": [{"pose": INSPECTED_POSE, "weight": w} for w in (0.25, 0.75)]}
    cloud = ParticleCloud(shape="Axes")
    check_details(
        turned(cloud, values).pick("poses", 4),
        "Particle 1",
        {"Weight": "0.75", "Particles in the message": "2"},
    )


def test_selecting_point(turned: Benches) -> None:
    values = {"point": {"x": 1.0, "y": 2.5}}
    check_details(
        turned(PointStamped(), values).pick("points", 0),
        "Point 0",
        {"Point in odom": {"fields": {"x": "1", "y": "2.5", "z": "0"}}},
    )
