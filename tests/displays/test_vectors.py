"""Wrench, TwistStamped, AccelStamped and Twist."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from plain_scenes import MOTION, in_moving_frame, velocity
from plain_scenes import NAN as SCENE_NAN

from webviz.shell.testing import check_details
from webviz_displays.vectors import AccelStamped, Twist, TwistStamped, Wrench

NAN = float("nan")
WRENCH = "geometry_msgs/msg/WrenchStamped"


def vector(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> dict[str, float]:
    return {"x": x, "y": y, "z": z}


def wrench(force: dict[str, float], torque: dict[str, float]) -> dict[str, Any]:
    return {"wrench": {"force": force, "torque": torque}}


def twist(linear: dict[str, float], angular: dict[str, float]) -> dict[str, Any]:
    return {"twist": {"linear": linear, "angular": angular}}


def test_a_force_is_an_arrow_from_the_origin_of_its_frame(turned: Benches) -> None:
    at = turned(Wrench(), wrench(vector(x=0.5), vector()))
    shaft, head = at.nodes()["force shafts"], at.nodes()["force heads"]
    # The scale is 2 m/N, and the head comes after the shaft.
    np.testing.assert_allclose(at.xyz("force shafts"), [(10, 0.5, 0)], atol=1e-6)
    np.testing.assert_allclose(shaft.scales, [(0.05, 0.05, 1.0)], atol=1e-6)
    np.testing.assert_allclose(at.xyz("force heads"), [(10, 1.15, 0)], atol=1e-6)
    np.testing.assert_allclose(head.scales, [(0.1, 0.1, 0.3)], atol=1e-6)
    assert shaft.colors == (204, 51, 51)
    assert at.statuses()["Vectors"] == ("OK", "Force 0.5 N; torque 0 Nm, not drawn.")


def test_a_torque_has_a_circle_around_its_arrow(turned: Benches) -> None:
    at = turned(Wrench(arrow_width=0.2), wrench(vector(), vector(z=2.0)))
    np.testing.assert_allclose(at.nodes()["torque shafts"].scales[0, 2], 4.0, atol=1e-6)
    circle = at.xyz("torque circles")
    assert (at.nodes()["torque circles"].width, len(circle)) == (pytest.approx(0.01), 28)
    middle = circle - (10, 0, 2)
    np.testing.assert_allclose(np.linalg.norm(middle, axis=2), np.ones((28, 2)), atol=1e-6)
    np.testing.assert_allclose(middle[:, :, 2], 0.0, atol=1e-6)
    turns = np.cross(middle[:, 0], middle[:, 1])[:, 2]
    assert (turns > 0).all()  # counter-clockwise about the torque
    gap = middle[0, 0] @ middle[-1, 1]
    assert gap == pytest.approx(math.cos(math.pi / 4), abs=1e-6)
    head = at.nodes()["torque circle heads"]
    np.testing.assert_allclose(head.scales, [(0.04, 0.04, 0.02)], atol=1e-6)


def test_a_small_force_is_drawn_although_rviz_hides_it(turned: Benches) -> None:
    at = turned(Wrench(), wrench(vector(x=0.01), vector()))
    assert "force shafts" in at.nodes()


def test_without_force_and_torque_there_is_nothing_to_draw(turned: Benches) -> None:
    at = turned(Wrench(), wrench(vector(), vector()))
    assert at.nodes() == {}
    level, text = at.statuses()["Vectors"]
    assert (level, text.endswith("Both are zero, so there is no arrow.")) == ("WARN", True)


def test_nan_is_an_error_or_zero(turned: Benches) -> None:
    at = turned(Wrench(), wrench(vector(x=1.0, y=NAN), vector()))
    assert at.nodes() == {}
    assert at.statuses()["Values"][0] == "ERROR"
    at.set("accept_nan_values", True)
    assert "Values" not in at.statuses()
    np.testing.assert_allclose(at.xyz("force shafts"), [(10, 1, 0)], atol=1e-6)


def test_a_force_too_large_to_be_drawn_is_an_error(turned: Benches) -> None:
    at = turned(Wrench(), wrench(vector(x=1e300), vector(z=1.0)))
    assert "force shafts" not in at.nodes()
    assert "torque shafts" in at.nodes()
    level, text = at.statuses()["Values"]
    assert (level, text.startswith("The force is too large")) == ("ERROR", True)


def test_former_vectors_stay_where_their_frame_was(bench: Benches) -> None:
    at = bench(Wrench(history_length=2))
    for x in (1.0, 2.0, 3.0):
        at.transform("map", "wrist", (x, 0.0, 0.0), stamp_ns=at.now_ns)
        at.send(WRENCH, wrench(vector(z=1.0), vector()), frame="wrist")
        at.turn(0.1)
    np.testing.assert_allclose(at.xyz("force shafts"), [(2, 0, 1), (3, 0, 1)], atol=1e-6)


@pytest.mark.parametrize(
    ("display", "message", "status"),
    [
        (TwistStamped, "twist", "Linear 0.2 m/s; angular 0.3 rad/s."),
        (AccelStamped, "accel", "Linear 0.2 m/s²; angular 0.3 rad/s²."),
    ],
)
def test_the_first_motion_is_drawn_at_once_unless_it_is_to_be_hidden(
    turned: Benches, display: type, message: str, status: str
) -> None:
    values = {message: {"linear": vector(x=0.2), "angular": vector(z=0.3)}}
    at = turned(display(), values)
    assert {"linear shafts", "angular shafts", "angular circles"} <= at.nodes().keys()
    assert at.statuses()["Vectors"] == ("OK", status)
    at.set("hide_small_values", True)  # 0.4 m and 0.6 m, of a width of 0.5 m
    assert not any(key.startswith("linear") for key in at.nodes())
    assert "angular shafts" in at.nodes()
    at.set("arrow_width", 1.0)
    assert at.nodes() == {}
    level, text = at.statuses()["Vectors"]
    assert (level, "Hide Small Values" in text) == ("WARN", True)
    at.press("Vectors")


def test_a_velocity_without_a_header_moves_with_the_reference_frame(bench: Benches) -> None:
    at = bench(Twist())
    at.send("geometry_msgs/msg/Twist", twist(vector(x=1.0), vector())["twist"])
    at.turn()
    level, text = at.statuses()["Transform"]
    assert (level, "base_link" in text) == ("ERROR", True)
    for x in (1.0, 2.0):
        at.transform("map", "base_link", (x, 0.0, 0.0), stamp_ns=at.now_ns)
        at.turn(0.1)
        np.testing.assert_allclose(at.xyz("linear shafts"), [(x + 1.0, 0, 0)], atol=1e-6)
    at.set("reference_frame", "<Fixed Frame>")
    np.testing.assert_allclose(at.xyz("linear shafts"), [(1.0, 0, 0)], atol=1e-6)


class TestAccelStamped(BuiltInChecks):
    display = AccelStamped
    scene = in_moving_frame("geometry_msgs/msg/AccelStamped", {"accel": MOTION}, {"accel": MOTION})


class TestTwist(BuiltInChecks):
    display = Twist
    scene = velocity
    variants = (lambda: Twist(reference_frame="sensor"),)


class TestTwistStamped(BuiltInChecks):
    display = TwistStamped
    scene = in_moving_frame("geometry_msgs/msg/TwistStamped", {"twist": MOTION}, {"twist": MOTION})


class TestWrench(BuiltInChecks):
    display = Wrench
    scene = in_moving_frame(
        "geometry_msgs/msg/WrenchStamped",
        *(
            {"wrench": {"force": {"x": 1.0, "y": SCENE_NAN}, "torque": {"z": 1.0}}}
            for _ in range(2)
        ),
    )
    variants = (
        Wrench,
        lambda: Wrench(accept_nan_values=True, history_length=3),
    )
    needs: ClassVar = {
        "alpha": {"accept_nan_values": True},
        "arrow_width": {"accept_nan_values": True},
        "force_color": {"accept_nan_values": True},
        "force_arrow_scale": {"accept_nan_values": True},
        "history_length": {"accept_nan_values": True},
        "torque_color": {"accept_nan_values": True},
        "torque_arrow_scale": {"accept_nan_values": True},
    }


def test_selecting_torque(turned: Benches) -> None:
    values = {"wrench": {"force": {"x": 1.5}, "torque": {"z": -2.0}}}
    check_details(
        turned(Wrench(), values).pick("torque circles", 5),
        "Wrench 0",
        {"Force in odom": "1.5, 0, 0 N", "Torque in odom": "0, 0, -2 Nm"},
    )
