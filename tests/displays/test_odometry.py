from collections.abc import Mapping
from typing import Any, ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from display_scenes import odometries
from inspecting import Benches
from numpy.typing import NDArray

from webviz.data.rotations import matrices
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.odometry import Odometry
from webviz_displays.odometry.covariance_marks import MAX_COVARIANCES
from webviz_displays.shared.pose_properties import (
    Covariance,
    OrientationCovariance,
    PoseShape,
    PositionCovariance,
)

ODOMETRY = "nav_msgs/msg/Odometry"
NAN, INF = float("nan"), float("inf")

Quaternion = tuple[float, float, float, float]


def about_z(angle: float) -> Quaternion:
    return (0.0, 0.0, float(np.sin(angle / 2)), float(np.cos(angle / 2)))


def odometry(
    x: float = 0.0,
    y: float = 0.0,
    turn: Quaternion = (0, 0, 0, 1),
    covariance: Mapping[str, float] | NDArray[np.float64] = {},  # noqa: B006
) -> dict[str, Any]:
    """A pose, and its covariance or the variances by name."""
    if isinstance(covariance, Mapping):
        names = ("x", "y", "z", "roll", "pitch", "yaw")
        covariance = np.diag([covariance.get(name, 0.0) for name in names])
    pose = {
        "position": {"x": x, "y": y},
        "orientation": dict(zip("xyzw", turn, strict=True)),
    }
    return {"pose": {"pose": pose, "covariance": covariance.ravel()}}


def tails(bench: DisplayBench) -> list[list[float]]:
    return bench.nodes()["poses"].segments[:, 0].round(4).tolist()


def spans(node: Any) -> np.ndarray:
    """Extents (N, 3) of solids along the axes of the fixed frame, exact for unturned ones."""
    return np.abs(matrices(node.wxyzs) * node.scales[:, None, :]).max(axis=2)


def test_transparent_arrows_are_solids_of_the_same_size(turned: Benches) -> None:
    nodes = turned(
        Odometry(shape=PoseShape(alpha=0.5), covariance=Covariance(value=False)), odometry(1)
    )
    shafts, heads = nodes.nodes()["shafts"], nodes.nodes()["heads"]
    assert (shafts.shape, heads.shape) == ("cylinder", "cone")
    assert (shafts.opacity, heads.opacity, heads.colors) == (0.5, 0.5, (255, 25, 0))
    np.testing.assert_allclose(shafts.positions, [(10, 1.5, 0)], atol=1e-6)
    np.testing.assert_allclose(shafts.scales, [(0.1, 0.1, 1.0)], atol=1e-6)
    np.testing.assert_allclose(heads.positions, [(10, 2.15, 0)], atol=1e-6)
    np.testing.assert_allclose(heads.scales, [(0.2, 0.2, 0.3)], atol=1e-6)


def test_an_arrow_stands_for_each_pose_in_the_fixed_frame(turned: Benches) -> None:
    bench = turned(Odometry(), odometry(1), odometry(2, turn=about_z(np.pi / 2)))
    node = bench.nodes()["poses"]
    expected = [[(10, 1, 0), (10, 2.3, 0)], [(10, 2, 0), (8.7, 2, 0)]]
    np.testing.assert_allclose(node.segments, expected, atol=1e-6)
    assert (node.colors, node.head_length) == ((255, 25, 0), 0.3)
    assert bench.statuses()["Pose"] == ("OK", "Showing 2 poses.")


def test_radii_are_radii(turned: Benches) -> None:
    shape = PoseShape(shaft_radius=0.2, head_radius=0.4)
    node = turned(Odometry(shape=shape), odometry()).nodes()["poses"]
    assert (node.shaft_radius, node.head_radius) == (0.2, 0.4)


def test_axes_are_turned_as_the_robot(turned: Benches) -> None:
    node = turned(
        Odometry(shape=PoseShape(value="Axes")), odometry(turn=about_z(np.pi / 2))
    ).nodes()["poses"]
    np.testing.assert_allclose(np.abs(node.wxyzs), [(0, 0, 0, 1)], atol=1e-6)
    assert (node.length, node.radius) == (1.0, 0.1)


def test_a_pose_is_added_once_the_robot_moved_or_turned_enough(turned: Benches) -> None:
    bench = turned(
        Odometry(position_tolerance=0.5, angle_tolerance=0.2),
        odometry(0.0),
        odometry(0.25),
        odometry(0.49),
        odometry(0.5),
        odometry(0.75),
        odometry(0.875, turn=about_z(0.19)),
        odometry(0.875, turn=about_z(0.21)),
    )
    assert tails(bench) == [[10, 0, 0], [10, 0.5, 0], [10, 0.875, 0]]


def test_the_sign_of_a_quaternion_is_ignored(turned: Benches) -> None:
    assert len(tails(turned(Odometry(), odometry(), odometry(turn=(0, 0, 0, -1))))) == 1


def test_without_tolerances_every_pose_is_added(turned: Benches) -> None:
    standing = [odometry()] * 5
    assert len(tails(turned(Odometry(position_tolerance=0.0), *standing))) == 5


def test_the_newest_poses_stay(turned: Benches) -> None:
    bench = turned(Odometry(keep=3), *map(odometry, range(6)))
    assert [y for _, y, _ in tails(bench)] == [3, 4, 5]
    bench.set("keep", 1)
    assert [y for _, y, _ in tails(bench)] == [5]


def test_a_trail_that_grew_pose_by_pose_is_the_one_drawn_at_once(turned: Benches) -> None:
    poses = [odometry(float(x), 0.5 * x, about_z(0.3 * x)) for x in range(9)]
    grown = turned(Odometry(keep=4))
    for number, pose in enumerate(poses):
        if number == 6:
            grown.fixed_frame = "odom"
        if number == 7:
            grown.fixed_frame = "map"
        grown.send(ODOMETRY, pose, frame="odom")
        grown.turn()
        at_once = turned(Odometry(keep=4), *poses[max(0, number - 3) : number + 1])
        at_once.fixed_frame = grown.fixed_frame
        at_once.turn()
        np.testing.assert_allclose(
            grown.nodes()["poses"].segments, at_once.nodes()["poses"].segments, atol=1e-6
        )


def test_keep_0_keeps_all(turned: Benches) -> None:
    assert len(tails(turned(Odometry(keep=0), *map(odometry, range(150))))) == 150


def test_a_long_trail_is_one_node(turned: Benches) -> None:
    off = Covariance(value=False)
    bench = turned(Odometry(keep=0, covariance=off), *map(odometry, range(2000)))
    assert {key: len(node.segments) for key, node in bench.nodes().items()} == {"poses": 2000}


# Covariance


def test_a_planar_covariance_is_an_ellipse_and_a_wedge(turned: Benches) -> None:
    bench = turned(Odometry(), odometry(turn=about_z(np.pi / 2), covariance={"yaw": 0.01}))
    assert bench.nodes().keys() == {"poses", "ellipses", "wedges"}
    wedge = bench.nodes()["wedges"]
    assert (wedge.color, wedge.opacity) == ((255, 255, 127), 0.5)
    width = np.tan(0.1)
    expected = [(10, 0, 1e-3), (9, width, 1e-3), (9, -width, 1e-3)]
    np.testing.assert_allclose(wedge.vertices, expected, atol=1e-6)


def test_the_ellipse_lies_along_the_frame_and_the_wedge_along_the_robot(turned: Benches) -> None:
    # In odom the robot looks along y, and its position along x is uncertain; odom's x is map's y.
    bench = turned(
        Odometry(), odometry(turn=about_z(np.pi / 2), covariance={"x": 4.0, "yaw": 0.01})
    )
    ellipse = bench.nodes()["ellipses"]
    assert ellipse.shape == "cylinder"
    assert ellipse.positions[0] == pytest.approx((10, 0, 1e-3), abs=1e-6)
    assert spans(ellipse)[0] == pytest.approx((0, 4, 1e-3), abs=1e-5)
    tip = bench.nodes()["wedges"].vertices[1:].mean(axis=0)
    assert tip == pytest.approx((9, 0, 1e-3), abs=1e-6)
    bench.set("covariance.orientation.frame", "Fixed")
    tip = bench.nodes()["wedges"].vertices[1:].mean(axis=0)
    assert tip == pytest.approx((10, 1, 1e-3), abs=1e-6)


def test_a_covariance_in_space_is_an_ellipsoid_and_three_discs(turned: Benches) -> None:
    look = Covariance(
        position=PositionCovariance(scale=2.0), orientation=OrientationCovariance(color_style="RGB")
    )
    variances = {"x": 0.01, "y": 0.04, "z": 0.09, "roll": 0.01, "pitch": 0.01, "yaw": 0.01}
    nodes = turned(Odometry(covariance=look), odometry(covariance=variances)).nodes()
    ellipsoid, discs = nodes["ellipsoids"], nodes["discs"]
    assert (ellipsoid.shape, ellipsoid.colors, ellipsoid.opacity) == ("sphere", (204, 51, 204), 0.3)
    assert spans(ellipsoid)[0] == pytest.approx((0.8, 0.4, 1.2), rel=1e-5)
    expected = [(10, 1, 0), (9, 0, 0), (10, 0, 1)]
    np.testing.assert_allclose(discs.positions, expected, atol=1e-6)
    assert discs.colors.tolist() == [[255, 0, 0], [0, 255, 0], [0, 0, 255]]
    width = 2 * np.tan(0.1)
    thin = 1e-3  # along the axis whose tip it is, which is turned left here
    expected = [(width, thin, width), (thin, width, width), (width, width, thin)]
    np.testing.assert_allclose(spans(discs), expected, atol=1e-5)


def test_correlated_and_mirrored_axes_make_an_ellipsoid_of_the_same_spread(turned: Benches) -> None:
    random = np.random.default_rng(2)
    for _ in range(20):
        root = random.normal(size=(3, 3)) * 0.3
        covariance = np.diag([0, 0, 0, 1e-4, 1e-4, 1e-4])
        covariance[:3, :3] = root @ root.T
        node = turned(Odometry(), odometry(covariance=covariance)).nodes()["ellipsoids"]
        axes = matrices(node.wxyzs[0]) * node.scales[0] / 2
        in_map = np.array([(0, -1, 0), (1, 0, 0), (0, 0, 1)]) @ root
        np.testing.assert_allclose(axes @ axes.T, in_map @ in_map.T, atol=1e-5)


def test_covariances_are_drawn_for_the_newest_poses_only(turned: Benches) -> None:
    count = MAX_COVARIANCES + 20
    bench = turned(Odometry(keep=0), *map(odometry, range(count)))
    assert len(tails(bench)) == count
    assert len(bench.nodes()["wedges"].faces) == MAX_COVARIANCES
    assert bench.statuses()["Covariance"][1].endswith(f"{MAX_COVARIANCES} of {count} covariances.")


def test_an_invalid_covariance_is_skipped_and_reported(turned: Benches) -> None:
    bad = odometry(1, covariance=np.full(36, NAN))
    bench = turned(Odometry(), odometry(0), bad, odometry(2, covariance=-np.eye(6)))
    assert len(tails(bench)) == 3
    assert len(bench.nodes()["wedges"].faces) == 1
    level, text = bench.statuses()["Covariance"]
    assert level == "WARN"
    assert text.startswith("2 of 3")


@pytest.mark.parametrize("size", [NAN, 1e300, -1.0])
def test_a_bad_covariance_of_a_robot_at_rest_is_named(turned: Benches, size: float) -> None:
    good, bad = odometry(covariance=np.eye(6)), odometry(covariance=np.eye(6) * size)
    bench = turned(Odometry(), good, bad)
    level, text = bench.statuses()["Covariance"]
    assert level == "WARN"
    assert text.startswith("1 of 2 covariances are invalid and not drawn")
    assert len(bench.nodes()["ellipsoids"].positions) == 1


def test_a_negative_variance_out_of_the_plane_counts_as_none_and_is_named(turned: Benches) -> None:
    bench = turned(Odometry(), odometry(covariance=np.diag([1.0, 1.0, -1.0, 0.0, 0.0, 1.0])))
    assert "ellipses" in bench.nodes()
    level, text = bench.statuses()["Covariance"]
    assert level == "WARN"
    assert text.startswith("1 of 1 covariances have a negative variance of z")


# Messages that cannot be shown


@pytest.mark.parametrize(
    ("message", "words"),
    [
        (odometry(NAN), "not finite: position (nan"),
        (odometry(INF), "not finite"),
        (odometry(turn=(0, 0, NAN, 1)), "orientation (0, 0, nan, 1)"),
        (odometry(1e300), "too far away"),
        (odometry(turn=(0, 0, 0, 0)), "all zeros"),
        (odometry(turn=(0, 0, 0, 1.01)), "not normalised: its squared length is 1.0201"),
        (odometry(turn=(0, 0, 1e300, 0)), "not normalised"),
    ],
)
def test_a_bad_pose_is_named_and_the_trail_stays(
    turned: Benches, message: dict[str, Any], words: str
) -> None:
    bench = turned(Odometry(), odometry(0), odometry(1), *[message] * 500)
    assert tails(bench) == [[10, 0, 0], [10, 1, 0]]
    level, text = bench.statuses()["Message"]
    assert level == "ERROR"
    assert words in text
    bench.send(ODOMETRY, odometry(1), frame="odom")
    bench.turn()
    assert bench.statuses()["Pose"][0] == "OK"


def test_a_nearly_normalized_quaternion_is_accepted(turned: Benches) -> None:
    assert len(tails(turned(Odometry(), odometry(turn=(0, 0, 0, 1.004))))) == 1


def test_only_bad_poses_draw_nothing(turned: Benches) -> None:
    bench = turned(Odometry(), odometry(NAN))
    assert bench.nodes() == {}
    assert bench.statuses()["Message"][0] == "ERROR"


def test_far_from_the_origin_a_trail_keeps_its_millimetres(bench: Benches) -> None:
    at = bench(Odometry(), fixed_frame="odom")
    at.transform("utm", "odom")
    for x in (448_262.123, 448_262.373):
        at.send(ODOMETRY, odometry(x, 5_411_932.456), frame="odom")
    at.turn()
    xyz = at.nodes()["poses"].segments[:, 0].astype(float) + at.poses()["poses"].position
    expected = [(448_262.123, 5_411_932.456, 0), (448_262.373, 5_411_932.456, 0)]
    np.testing.assert_allclose(xyz, expected, atol=1e-4, rtol=0)


class TestOdometry(BuiltInChecks):
    display = Odometry
    scene = odometries
    variants = (
        Odometry,
        lambda: Odometry(shape=PoseShape(value="Axes")),
    )
    later = ("angle_tolerance", "keep", "position_tolerance")
    needs: ClassVar = {
        "position_tolerance": {"angle_tolerance": 10.0},
        "angle_tolerance": {"position_tolerance": 1000.0},
    }


def test_selecting_odometry_with_covariance(bench: Benches) -> None:
    at = bench(Odometry())
    at.transform("map", "odom")
    for x in (0.0, 1.0, 2.0):
        pose = {
            "pose": {"position": {"x": x}},
            "covariance": np.diag([0.04, 0, 0, 0, 0, 1]).ravel(),
        }
        twist = {"twist": {"linear": {"x": 0.5}, "angular": {"z": -0.25}}}
        message = {"child_frame_id": "base", "pose": pose, "twist": twist}
        at.send("nav_msgs/msg/Odometry", message, frame="odom")
        at.turn()
    assert at.pick("ellipses", 1) == at.pick("poses", 1)
    check_details(
        at.pick("poses", 1),
        "Odometry 1",
        {
            "Speed": "0.5, 0, 0 m/s",
            "Turn rate": "0, 0, -0.25 rad/s",
            "Child frame": "base",
            "Standard deviations": "x 0.2, y 0, z 0, roll 0, pitch 0, yaw 1",
        },
    )
