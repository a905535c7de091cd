"""Range, the four scalars and the older point cloud."""

from __future__ import annotations

import math
from typing import Any, ClassVar

import numpy as np
import pytest
from built_in_checks import BuiltInChecks
from inspecting import Benches
from plain_scenes import in_moving_frame, old_clouds

from webviz.data.rotations import matrices
from webviz.shell.testing import check_details
from webviz_displays.sensors import (
    FluidPressure,
    Illuminance,
    PointCloud,
    Range,
    RelativeHumidity,
    Temperature,
)

NAN, INF = float("nan"), float("inf")
CLOUD = "sensor_msgs/msg/PointCloud"


def measured(distance: float, low: float = 0.25, high: float = 4.0, angle: float = 1.0) -> Any:
    return {"field_of_view": angle, "min_range": low, "max_range": high, "range": distance}


def test_a_range_is_a_cone_with_its_tip_at_the_sensor(turned: Benches) -> None:
    at = turned(Range(), measured(2.0))
    node = at.nodes()["cone"]
    assert (node.shape, node.colors, node.opacity) == ("cone", (255, 255, 255), 0.5)
    np.testing.assert_allclose(at.xyz("cone"), [(10, 1, 0)], atol=1e-6)
    width = 2 * 2.0 * math.tan(0.5)
    np.testing.assert_allclose(node.scales, [(width, width, 2.0)], rtol=1e-6)
    pose = at.poses()["cone"]
    tip = matrices(pose.wxyz) @ matrices(node.wxyzs[0]) @ (0, 0, 1)
    np.testing.assert_allclose(tip, (0, -1, 0), atol=1e-6)


@pytest.mark.parametrize(
    ("message", "distance"),
    [
        (measured(0.25), 0.25),
        (measured(4.0), 4.0),
        (measured(4.5), 0.0),
        (measured(0.125), 0.0),
        (measured(INF), 0.0),
        (measured(-INF), 0.0),
        (measured(NAN), 0.0),
        (measured(-INF, 2.0, 2.0), 2.0),
        (measured(2.0, 2.0, 2.0), 2.0),
        (measured(INF, 2.0, 2.0), 0.0),
        (measured(NAN, 2.0, 2.0), 0.0),
    ],
)
def test_a_range_out_of_its_limits_has_no_cone(
    turned: Benches, message: Any, distance: float
) -> None:
    at = turned(Range(), message)
    lengths = [node.scales[0, 2] for node in at.nodes().values()]
    assert lengths == ([distance] if distance else [])
    is_fault = not distance and message["range"] != INF
    assert at.statuses()["Range"][0] == ("WARN" if is_fault else "OK")


@pytest.mark.parametrize("angle", [0.0, -0.5, math.pi, NAN])
def test_a_cone_needs_a_field_of_view(turned: Benches, angle: float) -> None:
    at = turned(Range(), measured(2.0, angle=angle))
    assert at.nodes() == {}
    assert at.statuses()["Range"][0] == "ERROR"


def test_former_ranges_stay(turned: Benches) -> None:
    at = turned(Range(buffer_length=2), *map(measured, (1.0, 2.0, 3.0)))
    assert sorted(node.scales[0, 2] for node in at.nodes().values()) == [2.0, 3.0]


@pytest.mark.parametrize(
    ("display", "field", "value", "color", "status"),
    [
        (Temperature, "temperature", 0.0, (255, 0, 255), "0 °C"),
        (Temperature, "temperature", 100.0, (255, 0, 0), "100 °C"),
        (FluidPressure, "fluid_pressure", 98_000.0, (255, 0, 0), "98000 Pa"),
        (Illuminance, "illuminance", 1000.0, (255, 0, 255), "1000 lx"),
        (RelativeHumidity, "relative_humidity", 0.2, (255, 255, 0), "0.2"),
    ],
)
def test_a_measurement_colours_a_point_at_its_sensor(
    turned: Benches, display: type, field: str, value: float, color: tuple[int, ...], status: str
) -> None:
    at = turned(display(), {field: value})
    np.testing.assert_allclose(at.xyz("points"), [(10, 0, 0)], atol=1e-6)
    assert at.nodes()["points"].colors.tolist() == [list(color)]
    assert at.statuses()["Value"] == ("OK", status)
    scale = at.runner.report().color_scale
    assert scale is not None
    assert (scale.low, scale.high) == (display().min_intensity, display().max_intensity)


def test_a_trail_of_measurements_is_one_node(bench: Benches) -> None:
    at = bench(Temperature(decay_time=10.0))
    for x, value in ((1.0, 20.0), (2.0, NAN), (3.0, 40.0)):
        at.transform("map", "sensor", (x, 0.0, 0.0), stamp_ns=at.now_ns)
        at.send("sensor_msgs/msg/Temperature", {"temperature": value}, frame="sensor")
        at.turn(0.1)
        assert at.statuses()["Value"][0] == ("OK" if math.isfinite(value) else "ERROR")
    np.testing.assert_allclose(at.xyz("points"), [(1, 0, 0), (3, 0, 0)], atol=1e-6)
    assert at.nodes()["points"].ids.tolist() == [0, 2]


def old_cloud(**channels: list[float]) -> dict[str, Any]:
    named = [{"name": name, "values": values} for name, values in channels.items()]
    return {"points": np.array([(1.0, 0.0, 0.0), (2.0, 0.0, 0.0)]), "channels": named}


def test_the_channels_of_an_older_cloud_are_its_fields(turned: Benches) -> None:
    at = turned(PointCloud(), old_cloud(intensity=[3.0, 5.0]))
    np.testing.assert_allclose(at.xyz("points"), [(10, 1, 0), (10, 2, 0)], atol=1e-6)
    assert at.nodes()["points"].colors.tolist() == [[255, 0, 0], [255, 0, 255]]
    assert at.statuses()["Colors"] == ("OK", "Intensity, by the fields: x, y, z, intensity.")
    packed = np.array([0x00FF8000, 0x000080FF], np.uint32).view(np.float32).tolist()
    at.send(CLOUD, old_cloud(rgb=packed), frame="odom")
    at.turn()
    assert at.nodes()["points"].colors.tolist() == [[255, 128, 0], [0, 128, 255]]


def test_a_channel_of_another_length_is_named(turned: Benches) -> None:
    at = turned(PointCloud(), old_cloud(intensity=[3.0]))
    assert len(at.nodes()["points"].xyz) == 2
    level, text = at.statuses()["Data"]
    assert (level, "ignored: 'intensity' with 1." in text) == ("WARN", True)


class TestFluidPressure(BuiltInChecks):
    display = FluidPressure
    scene = in_moving_frame(
        "sensor_msgs/msg/FluidPressure", {"fluid_pressure": 1e5}, {"fluid_pressure": 1.01e5}
    )


class TestIlluminance(BuiltInChecks):
    display = Illuminance
    messages: ClassVar = {}
    scene = in_moving_frame(
        "sensor_msgs/msg/Illuminance", {"illuminance": 300.0}, {"illuminance": 400.0}
    )


class TestPointCloud(BuiltInChecks):
    display = PointCloud
    scene = old_clouds
    variants = (lambda: PointCloud(style="Boxes"),)
    needs: ClassVar = {"max_points": {"max_points": 3}}


class TestRange(BuiltInChecks):
    display = Range
    scene = in_moving_frame(
        "sensor_msgs/msg/Range",
        *({"field_of_view": 0.5, "max_range": 4.0, "range": each} for each in (1.0, 2.0)),
    )
    later = ("buffer_length",)


class TestRelativeHumidity(BuiltInChecks):
    display = RelativeHumidity
    messages: ClassVar = {}
    scene = in_moving_frame(
        "sensor_msgs/msg/RelativeHumidity",
        {"relative_humidity": 0.3},
        {"relative_humidity": 0.4},
    )


class TestTemperature(BuiltInChecks):
    display = Temperature
    scene = in_moving_frame(
        "sensor_msgs/msg/Temperature", {"temperature": 30.0}, {"temperature": 40.0}
    )


def test_selecting_cone_of_a_range(turned: Benches) -> None:
    values = {"radiation_type": 1, "field_of_view": 0.5, "max_range": 4.0, "range": 0.7}
    check_details(
        turned(Range(), values).pick("cone", 0),
        "Range 0",
        {
            "Range": "0.7 m",
            "Field of view": "28.65°",
            "Limits": "0 to 4 m",
            "Radiation": "infrared",
        },
    )


def test_selecting_temperature(turned: Benches) -> None:
    values = {"temperature": 21.5, "variance": 0.25}
    check_details(
        turned(Temperature(), values).pick("points", 0),
        "Temperature 0",
        {"Value": "21.5 °C", "Standard deviation": "0.5 °C"},
    )


def test_selecting_point_of_an_older_cloud(turned: Benches) -> None:
    channels = [{"name": "ring", "values": [3.0, 5.0]}]
    values = {"points": np.array([(math.nan, 0, 0), (1, 2, 3)], np.float32), "channels": channels}
    cloud = PointCloud(color_transformer="FlatColor")
    check_details(
        turned(cloud, values).pick("points", 0),
        "Point 1",
        {"ring": "5.0", "Points in the cloud": "2"},
    )
