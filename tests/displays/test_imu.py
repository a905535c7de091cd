"""Imu and Mag."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from mapping_scenes import FIELD as INSPECTED_FIELD
from mapping_scenes import FIELD as SCENE_FIELD
from mapping_scenes import IMU as INSPECTED_IMU
from mapping_scenes import IMU as SCENE_IMU
from plain_scenes import in_moving_frame

from webviz.data.rotations import multiply
from webviz.shell.testing import DisplayBench, check_details
from webviz_displays.imu import Imu, Mag
from webviz_displays.imu.imu import AccelerationSettings, AxesSettings, BoxSettings

NAN = math.nan
ROOT = math.sqrt(0.5)
LEFT = (0.0, 0.0, ROOT, ROOT)
IMU, FIELD = "sensor_msgs/msg/Imu", "sensor_msgs/msg/MagneticField"
MEASURED = {
    "orientation": dict(zip("xyzw", LEFT, strict=True)),
    "linear_acceleration": {"x": 3.0, "z": 4.0},
}
ARROW = AccelerationSettings(enable_acceleration=True, acc_vector_scale=0.1)


def arrow(at: DisplayBench, key: str) -> tuple[np.ndarray, np.ndarray]:
    """Tail and tip of an arrow along its x axis or as it lies, in the fixed frame."""
    parts = [at.nodes()[f"{key}shafts"], at.nodes()[f"{key}heads"]]
    shaft, head = (at.xyz(f"{key}{part}")[0] for part in ("shafts", "heads"))
    way = (head - shaft) / np.linalg.norm(head - shaft)
    return shaft - way * parts[0].scales[0, 2] / 2, head + way * parts[1].scales[0, 2] / 2


def test_the_orientation_is_in_the_fixed_frame_or_that_of_the_sensor(turned: Callable) -> None:
    at = turned(Imu(), MEASURED)
    for is_fixed, expected in ((True, (ROOT, 0, 0, ROOT)), (False, (0, 0, 0, 1))):
        at.set("fixed_frame_orientation", is_fixed)
        turn = multiply(at.poses()["axes"].wxyz, at.nodes()["axes"].wxyzs[0])
        np.testing.assert_allclose(turn, expected, atol=1e-6)
        np.testing.assert_allclose(at.xyz("axes"), [(10, 0, 0)], atol=1e-6)
    assert at.statuses()["Imu"] == ("OK", "Acceleration 3, 0, 4 m/s².")


def test_the_box_has_its_size_and_turns(turned: Callable) -> None:
    box = BoxSettings(enable_box=True, x_scale=2.0, z_scale=0.5, box_alpha=0.5)
    at = turned(Imu(box_properties=box, axes_properties=AxesSettings(axes_scale=2.0)), MEASURED)
    node = at.nodes()["box"]
    assert (node.scales.tolist(), node.opacity) == ([[2.0, 1.0, 0.5]], 0.5)
    np.testing.assert_allclose(node.wxyzs, [(ROOT, 0, 0, ROOT)], atol=1e-6)
    assert (at.nodes()["axes"].length, at.nodes()["axes"].radius) == (2.0, 0.1)


def test_the_acceleration_is_turned_by_the_orientation(turned: Callable) -> None:
    """Its head of a scale follows the shaft of |a| scales."""
    at = turned(Imu(acceleration_properties=ARROW), MEASURED)
    tail, tip = arrow(at, "acceleration ")
    np.testing.assert_allclose(tail, (10, 0, 0), atol=1e-6)
    np.testing.assert_allclose(tip - tail, 0.6 * np.array((0, 0.6, 0.8)), atol=1e-6)
    at.set("acceleration_properties.derotate_acceleration", False)
    tail, tip = arrow(at, "acceleration ")
    np.testing.assert_allclose(tip - tail, 0.6 * np.array((0.6, 0, 0.8)), atol=1e-6)


@pytest.mark.parametrize(
    ("change", "key", "level"),
    [
        ({"orientation": {"w": NAN}}, "Orientation", "ERROR"),
        ({"orientation": {"w": 0.0}}, "Orientation", "WARN"),
        ({"orientation": {"w": 2.0}}, "Orientation", "WARN"),
        ({"orientation_covariance": [-1.0] + [0.0] * 8}, "Orientation", "WARN"),
        ({"linear_acceleration": {"x": NAN}}, "Acceleration", "ERROR"),
        ({"linear_acceleration": {"x": 1e300}}, "Acceleration", "ERROR"),
        ({"linear_acceleration": {}}, "Acceleration", "WARN"),
    ],
)
def test_invalid_measurements_are_reported(
    turned: Callable, change: dict[str, Any], key: str, level: str
) -> None:
    at = turned(Imu(acceleration_properties=ARROW), MEASURED | change)
    assert at.statuses()[key][0] == level
    assert (at.nodes() == {}) == (key == "Orientation" and level == "ERROR")


def test_an_imu_with_nothing_enabled_has_a_status(turned: Callable) -> None:
    at = turned(Imu(axes_properties=AxesSettings(enable_axes=False)), MEASURED)
    assert at.nodes() == {}
    assert at.statuses()["Imu"][0] == "WARN"


def test_a_field_is_an_arrow_of_one_length(turned: Callable) -> None:
    values = {"magnetic_field": {"x": 3e-200, "z": 4e-200}}
    at = turned(Mag(scale=0.5), values)
    tail, tip = arrow(at, "")
    np.testing.assert_allclose(tail, (10, 0, 0), atol=1e-6)
    np.testing.assert_allclose(tip - tail, (0, 1.1, 0), atol=1e-6)
    at.set("is_2d", False)
    tail, tip = arrow(at, "")
    np.testing.assert_allclose(tip - tail, 1.1 * np.array((0, 0.6, 0.8)), atol=1e-6)


@pytest.mark.parametrize(
    ("field", "alpha", "level"),
    [({"x": NAN}, 1.0, "ERROR"), ({"z": 1.0}, 1.0, "WARN"), ({"x": 1.0}, 0.0, "WARN")],
)
def test_a_field_without_a_direction_has_a_status(
    turned: Callable, field: dict[str, float], alpha: float, level: str
) -> None:
    at = turned(Mag(alpha=alpha), {"magnetic_field": field})
    assert at.nodes() == {}
    assert at.statuses()["Field"][0] == level


class TestImu(BuiltInChecks):
    display = Imu
    scene = in_moving_frame("sensor_msgs/msg/Imu", SCENE_IMU)
    variants = (
        lambda: Imu(acceleration_properties=AccelerationSettings(enable_acceleration=True)),
    )


class TestMag(BuiltInChecks):
    display = Mag
    scene = in_moving_frame("sensor_msgs/msg/MagneticField", SCENE_FIELD)
    variants = (lambda: Mag(is_2d=False),)


def test_selecting_inertial_sensor(turned: Benches) -> None:
    check_details(
        turned(Imu(), INSPECTED_IMU).pick("axes", 0),
        "Inertial sensor",
        {
            "Orientation": "x 0.0000, y 0.0000, z 0.6000, w 0.8000",
            "Acceleration in odom": "1, 0, 9 m/s²",
        },
    )


def test_selecting_magnetic_field(turned: Benches) -> None:
    check_details(
        turned(Mag(), INSPECTED_FIELD).pick("heads", 0),
        "Magnetic field",
        {"Field in odom": "2e-05, 1e-05, -4e-05 T"},
    )
