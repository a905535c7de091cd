"""Faults of the content of messages, and of displays that hide it."""

from __future__ import annotations

import cmath
import itertools
import math
import re
from collections.abc import Callable
from typing import Any

import building
import examining
import numpy as np
import pytest
from examining import HERE, SCAN, display, look

import webviz
from webviz import Finding, Severity, Symptom, Topic, TryYaw
from webviz.api.finding import CauseLevel
from webviz.api.offer import Offer, Publisher
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.messages import header
from webviz.shell.testing.source import SECOND
from webviz_displays.image import Image
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.odometry import Odometry
from webviz_displays.path import Path
from webviz_displays.robot_model import RobotModel
from webviz_sim.pose import Pose2D

ROBOT = """<robot name="r"><link name="map"><visual><geometry>
<mesh filename="package://nowhere/part.stl"/></geometry></visual></link></robot>"""

PROOF = {
    "DATA001": r"\d+% of its points lie on walls of /map; turned by -90°, (9\d|100)% would\.",
    "DATA003": r"\d+% of its points lie on walls of /map; moved by \(.*\) m, (9\d|100)% would\.",
    "DATA004": r"\d+% of its points lie on walls of /map\.",
}

Make = Callable[..., Harness]


def examined(stage: Harness, level: CauseLevel = CauseLevel.DATA) -> dict[str, Finding]:
    """The findings on a level."""
    return examining.examined(stage, level)


@pytest.mark.parametrize(
    ("id", "pose", "scan"),
    [
        ("DATA001", Pose2D(-2.0, 0.0, math.pi / 2), None),
        ("DATA003", Pose2D(-1.0, 0.5, 0.0), None),
        ("DATA004", HERE, {"ranges": np.full(360, 2.0, np.float32)}),
    ],
)
def test_scans_beside_the_map(
    webviz_harness: Make, id: str, pose: Pose2D, scan: dict[str, Any] | None
) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    look(stage, pose, scan and building.scan(HERE) | scan)
    findings = examined(stage)
    assert [*findings] == [f"{id} Scan"]
    assert findings[f"{id} Scan"].explains == (Symptom(display(stage, "Scan"), "Map"),)
    assert re.fullmatch(PROOF[id], findings[f"{id} Scan"].proof)
    look(stage, HERE)
    assert examined(stage) == {}


def test_the_button_of_a_turned_scan_tries_the_yaw_with_which_it_fits(
    webviz_harness: Make,
) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    look(stage, Pose2D(HERE.x, HERE.y, 0.3), building.scan(HERE))
    (finding,) = examined(stage).values()
    assert isinstance(finding.button, TryYaw)
    assert (finding.button.frame, finding.button.yaw) == ("laser", pytest.approx(-0.3, abs=0.05))


def test_a_mirrored_scan(webviz_harness: Make) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    here = Pose2D(-2.0, 0.0, 0.6)
    measured = building.scan(here)
    upside_down = measured | {"ranges": np.roll(measured["ranges"][::-1], 1)}
    look(stage, here, upside_down)
    (finding,) = examined(stage).values()
    assert finding.id == "DATA002"
    assert "; mirrored, " in finding.proof
    look(stage, here, upside_down, roll=math.pi)
    assert examined(stage) == {}


def test_a_path_through_an_obstacle(webviz_harness: Make) -> None:
    stage = webviz_harness(LaserScan(), Map(), Path(name="Plan"), fixed_frame="map")
    way = building.path([(HERE.x, HERE.y), (3.0, 0.0)])
    stage.publish("/path", "nav_msgs/msg/Path", {"header": header("map", stage.source.now)} | way)
    look(stage, HERE, building.scan(HERE, building.with_box(1.5, 0.0, 0.8)))
    assert [*examined(stage)] == ["DATA005 Plan"]
    look(stage, HERE)
    assert examined(stage) == {}


@pytest.mark.parametrize(
    ("id", "values"),
    [
        ("DATA006 /scan", {"ranges": [math.nan] * 5}),
        (
            "DATA007 /scan",
            {"ranges": [2500.0, 2400.0, 2300.0, 2200.0, 2100.0], "range_max": 5000.0},
        ),
        ("DATA007 /scan", {"ranges": [2500.0, 2400.0, 2300.0, 2200.0, 2100.0]}),
        ("DATA008 /scan", {"ranges": [2.0] * 9}),
        ("", {"ranges": [math.inf] * 5}),
        ("", {"ranges": [2.0] * 5}),
    ],
)
def test_scans(webviz_harness: Make, id: str, values: dict[str, Any]) -> None:
    stage = webviz_harness(LaserScan(), fixed_frame="map")
    angles = {"angle_min": -1.0, "angle_max": 1.0, "angle_increment": 0.5, "range_max": 10.0}
    stage.publish("/scan", SCAN, angles | values, frame="map")
    stage.turn()
    assert [*examined(stage)] == ([id] if id else [])


def test_a_laser_that_sees_a_post_of_its_robot(webviz_harness: Make) -> None:
    stage = webviz_harness(LaserScan(), fixed_frame="map")

    def stand(*poses: tuple[Pose2D, Pose2D]) -> list[tuple[str, Severity]]:
        """The findings about the laser at poses, each with that of a post in its plane."""
        for here, post in poses:
            world = building.with_box(post.x, post.y, 0.06)
            look(stage, here, building.scan(here, world, range_min=0.03))
            examined(stage)
        findings = stage.viewer.snapshot().findings
        return [(each.id, each.severity) for each in findings if each.id == "DATA014"]

    there = Pose2D(2.0, 0.0, 0.0)
    beside = Pose2D(HERE.x + 0.08, HERE.y)
    assert stand((HERE, beside)) == [("DATA014", Severity.NOTE)], "it may stand beside a post"
    assert stand((there, beside)) == [], "it did"
    assert stand((HERE, beside), (there, Pose2D(there.x + 0.08, there.y))) == [
        ("DATA014", Severity.WARNING)
    ]
    assert stand((there, beside)) == []


@pytest.mark.parametrize(
    ("changed", "severity"),
    [
        ({"encoding": "mono8"}, Severity.WARNING),
        ({"encoding": "rgba8", "step": 0}, Severity.ERROR),
        ({"step": 10}, Severity.ERROR),
        ({"height": 7}, Severity.ERROR),
        ({"encoding": "bgra8", "step": 512}, Severity.ERROR),
        ({"encoding": "mono8", "width": 32, "height": 12, "step": 96}, Severity.WARNING),
        ({"encoding": "mono8", "width": 32, "height": 18, "step": 64}, None),  # aligned rows
        ({"encoding": "nv21", "width": 192, "height": 4}, None),
        ({}, None),
    ],
)
def test_images_whose_fields_contradict_their_data(
    webviz_harness: Make, changed: dict[str, Any], severity: Severity | None
) -> None:
    stage = webviz_harness(Image(name="Camera", topic=Topic("/image")), fixed_frame="map")
    pixels = np.zeros((6, 64, 3), np.uint8)
    right = {"width": 64, "height": 6, "encoding": "rgb8", "step": 192, "data": pixels.ravel()}
    stage.publish("/image", "sensor_msgs/msg/Image", right | changed, frame="camera")
    stage.turn()
    findings = examined(stage)
    assert [each.severity for each in findings.values()] == ([severity] if severity else [])
    if severity:
        (finding,) = findings.values()
        assert (finding.id, finding.subject) == ("DATA015", "/image")
        explained = (Symptom(display(stage, "Camera"), "Image"),)
        assert finding.explains == (explained if severity is Severity.ERROR else ())


def notes(stage: Harness) -> set[str]:
    """The ids of all findings."""
    examined(stage)
    return {each.id for each in stage.viewer.snapshot().findings}


def test_notes_on_data(webviz_harness: Make) -> None:
    stage = webviz_harness(LaserScan(), Odometry(), fixed_frame="map")
    angles = {"angle_max": 0.9, "angle_increment": 0.1, "range_max": 10.0, "ranges": [2.0] * 10}

    def publish(intensities: list[float], variance: float, x: float = 0.0) -> None:
        stage.publish("/scan", SCAN, angles | {"intensities": intensities}, frame="map")
        place = {"position": {"x": x}, "orientation": {"w": 1.0}}
        pose = {"pose": place, "covariance": [variance] + [0.0] * 35}
        stage.publish("/odom", "nav_msgs/msg/Odometry", {"pose": pose}, frame="map")
        stage.turn()

    publish([47.0] * 10, 0.0)
    assert {"DATA009", "DATA010"} <= notes(stage)
    publish([float(n) for n in range(10)], 0.1, 5.0)
    assert not {"DATA009", "DATA010"} & notes(stage)


def test_missing_meshes(webviz_harness: Make) -> None:
    stage = webviz_harness(RobotModel(name="Robot"), fixed_frame="map")
    stage.publish("/robot_description", "std_msgs/msg/String", {"data": ROBOT})
    stage.settle()
    assert [*examined(stage)] == ["DATA011 Robot"]


def test_displays_hidden_by_their_own_properties(webviz_harness: Make) -> None:
    stage = webviz_harness(
        LaserScan(name="Glass", alpha=0.0),
        LaserScan(name="None", topic=Topic("")),
        fixed_frame="map",
    )
    stage.publish("/scan", SCAN, {"ranges": [2.0], "range_max": 10.0}, frame="map")
    stage.turn()
    findings = examined(stage, CauseLevel.VIEW)
    assert [*findings] == ["VIEW001 Glass", "VIEW002 None"]
    change = findings["VIEW001 Glass"].button
    assert isinstance(change, webviz.ChangeDisplay)
    stage.set(change.remedy.path, change.remedy.value, "Glass")
    assert [*examined(stage, CauseLevel.VIEW)] == ["VIEW002 None"]


@pytest.mark.parametrize(
    ("speed", "turn", "ids"),
    [
        (0.5, 0.4, []),
        (-0.5, 0.4, ["DATA013 /odom"]),
        (0.5, -0.4, ["DATA013 /odom"]),
        (0.0, 0.0, []),
        (0.7, 0.4, []),  # the wheels slip
        (3.6 * 0.5, 0.4, ["DATA020 /odom"]),
        (0.5, math.degrees(0.4), ["DATA020 /odom"]),
        (0.5, math.radians(0.4), ["DATA020 /odom"]),
    ],
)
def test_odometry_against_its_own_twist(
    webviz_harness: Make, speed: float, turn: float, ids: list[str]
) -> None:
    stage = webviz_harness(Odometry(), fixed_frame="odom")
    began = stage.source.now

    def publish() -> None:
        at_s = (stage.source.now - began) / SECOND
        yaw = 0.4 * at_s
        place = {
            "position": {"x": math.sin(yaw) * 1.25, "y": (1.0 - math.cos(yaw)) * 1.25},
            "orientation": {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)},
        }
        twist = {"linear": {"x": speed}, "angular": {"z": turn}}
        values = {
            "header": header("odom", stage.source.now),
            "pose": {"pose": place, "covariance": [0.1] * 36},
            "twist": {"twist": twist},
        }
        stage.publish("/odom", "nav_msgs/msg/Odometry", values)

    for _ in range(3):
        examining.examined(stage, CauseLevel.DATA, 0.5, publish)
    findings = examining.examined(stage, CauseLevel.DATA, 0.5, publish)
    assert [*findings] == ids
    if ids == ["DATA020 /odom"]:
        unit = "km/h" if speed > 1.0 else "degrees per second" if turn > 1.0 else ""
        text = findings["DATA020 /odom"].cause
        assert text.endswith(
            f", as if it were in {unit}." if unit else " times as fast as its pose moves."
        )


@pytest.mark.parametrize(("worst", "ids"), [(4.0, ["DATA020 /odom"]), (6.0, [])])
def test_a_twist_of_unsteady_motion_is_not_compared(
    webviz_harness: Make, worst: float, ids: list[str]
) -> None:
    stage = webviz_harness(Odometry(), fixed_frame="odom")
    at_s, speeds = 0.0, itertools.cycle([4.0, worst])

    def publish() -> None:
        nonlocal at_s
        at_s += 1.1
        values = {
            "header": header("odom", stage.source.now),
            "pose": {
                "pose": {"position": {"x": at_s}, "orientation": {"w": 1.0}},
                "covariance": [0.1] * 36,
            },
            "twist": {"twist": {"linear": {"x": next(speeds)}}},
        }
        stage.publish("/odom", "nav_msgs/msg/Odometry", values)

    for _ in range(3):
        examining.examined(stage, CauseLevel.DATA, 1.1, publish)
    assert [*examining.examined(stage, CauseLevel.DATA, 1.1, publish)] == ids


@pytest.mark.parametrize(
    ("apart_m", "node", "ids"),
    [(0.0, "/wheels", []), (0.4, "/wheels", ["DATA021 /odom"]), (0.4, "/filter", [])],
)
def test_odometry_against_the_transform_of_its_node(
    webviz_harness: Make, apart_m: float, node: str, ids: list[str]
) -> None:
    stage = webviz_harness(Odometry(), fixed_frame="odom")
    for topic, sender, type_name in (
        ("/tf", node, "tf2_msgs/msg/TFMessage"),
        ("/odom", "/wheels", "nav_msgs/msg/Odometry"),
    ):
        publisher = Publisher(sender, type_name, "reliable", "volatile")
        stage.source.topics[topic] = Offer((publisher,), ("reliable", "volatile"))

    def publish() -> None:
        now = stage.source.now
        stage.transform("odom", "base_link", (1.0, 0.0, 0.0), stamp_ns=now)
        place = {"position": {"x": 1.0 + apart_m}, "orientation": {"w": 1.0}}
        values = {"header": header("odom", now), "child_frame_id": "base_link"}
        pose = {"pose": {"pose": place, "covariance": [0.1] * 36}}
        stage.publish("/odom", "nav_msgs/msg/Odometry", values | pose)

    assert [*examining.examined(stage, CauseLevel.DATA, 0.5, publish)] == ids


def test_angles_in_degrees_come_before_the_map(webviz_harness: Make) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    measured = building.scan(HERE)
    degrees = {"angle_min": -180.0, "angle_max": 179.0, "angle_increment": 1.0}
    look(stage, HERE, measured | degrees)
    assert [*examined(stage)] == ["DATA016 /scan"]
    look(stage, HERE, measured)
    assert examined(stage) == {}


@pytest.mark.parametrize("is_of_laser", [False, True])
def test_a_shift_that_turns_with_the_robot_is_of_its_laser(
    webviz_harness: Make, is_of_laser: bool
) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    texts: list[str] = []
    for yaw in (0.0, 0.3, 0.6, 0.9):
        way = complex(0.6, 0.3) * (cmath.rect(1.0, yaw) if is_of_laser else 1.0)
        pose = Pose2D(HERE.x + way.real, HERE.y + way.imag, yaw)
        look(stage, Pose2D(HERE.x, HERE.y, yaw), building.scan(pose))
        texts = [each.remedy for each in examined(stage).values()]
    assert len(texts) == 1
    assert (texts[0] == "Correct the transform of 'laser'.") == is_of_laser
    assert texts[0].startswith("Give the pose") != is_of_laser


@pytest.mark.parametrize(("way", "is_found"), [(0.35, True), (0.1, False)])
def test_a_laser_that_is_a_little_off_fits_now_and_then(
    webviz_harness: Make, way: float, is_found: bool
) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), Map(), fixed_frame="map")
    stage.viewer.doctor.slice_s = math.inf
    result: dict[str, Finding] = {}
    is_off = itertools.cycle([True, False])
    for step in range(24):  # a busy machine compares in between, too
        yaw = 0.4 * step
        off = cmath.rect(way if next(is_off) else 0.0, yaw)
        pose = Pose2D(HERE.x + off.real, HERE.y + off.imag, yaw)
        look(stage, Pose2D(HERE.x, HERE.y, yaw), building.scan(pose))
        stage.clock += 1.1
        stage.source.now += SECOND
        stage.turn()
        result = examining.by_key(stage.state().findings, CauseLevel.DATA)
        if result:
            break
    assert [*result] == (["DATA003 Scan"] if is_found else [])
    assert all(each.remedy == "Correct the transform of 'laser'." for each in result.values())


def test_a_map_without_a_known_cell(webviz_harness: Make) -> None:
    stage = webviz_harness(Map(), fixed_frame="map")
    stage.transform("map", "odom")
    grid = building.grid()
    unknown = np.full_like(grid["data"], -1)
    one = unknown.copy()
    one[0] = 0
    for cells, ids in ((unknown, ["DATA018 /map"]), (one, [])):
        values = grid | {"header": header("map", stage.source.now), "data": cells}
        stage.publish("/map", "nav_msgs/msg/OccupancyGrid", values)
        assert [*examined(stage)] == ids


def test_data_that_a_display_cannot_draw(webviz_harness: Make) -> None:
    stage = webviz_harness(Map(name="Rooms"), fixed_frame="map")
    stage.transform("map", "odom")
    grid = building.grid()
    for resolution, ids in ((0.0, ["DATA019 Rooms, Map"]), (0.05, [])):
        values = grid | {"header": header("map", stage.source.now)}
        values["info"] = grid["info"] | {"resolution": resolution}
        stage.publish("/map", "nav_msgs/msg/OccupancyGrid", values)
        findings = examined(stage)
        assert [*findings] == ids
        if ids:
            assert findings[ids[0]].cause.startswith(
                "Rooms cannot draw /map: The map's resolution is 0 m"
            )


def test_an_unknown_encoding(webviz_harness: Make) -> None:
    stage = webviz_harness(Image(name="Camera", topic=Topic("/image")), fixed_frame="map")
    values = {"width": 1, "height": 1, "encoding": "whatever", "step": 3, "data": bytes(3)}
    stage.publish("/image", "sensor_msgs/msg/Image", values, frame="camera")
    assert [*examined(stage)] == ["DATA019 Camera, Image"]


WHEEL = """<robot name="r"><link name="map"/><link name="wheel"/>
<joint name="axle" type="continuous"><parent link="map"/><child link="wheel"/></joint></robot>"""


@pytest.mark.parametrize(
    ("name", "positions"),
    [("axle", []), ("axle", [1.0, 2.0]), ("axle", [math.nan]), ("arm", [1.0])],
)
def test_joint_states_that_are_invalid(
    webviz_harness: Make, name: str, positions: list[float]
) -> None:
    stage = webviz_harness(RobotModel(), fixed_frame="map")
    state = "sensor_msgs/msg/JointState"
    stage.source.topics["/joint_states"] = Offer(
        (Publisher("/wheels", state, "reliable", "volatile"),), ("reliable", "volatile")
    )
    stage.publish("/robot_description", "std_msgs/msg/String", {"data": WHEEL})
    stage.transform("map", "other")
    stage.settle()  # the robot is loaded in the background

    def publish(joint: str, values: list[float]) -> None:
        text = {"header": header("", stage.source.now), "name": [joint], "position": values}
        stage.publish("/joint_states", state, text)

    for joint, values, is_found in ((name, positions, True), ("axle", [1.0], False)):
        for _ in range(3):
            examining.examined(
                stage, CauseLevel.DATA, publish=lambda j=joint, v=values: publish(j, v)
            )
        findings = [each.id for each in stage.viewer.snapshot().findings]
        assert ("DATA017" in findings) == is_found, findings
        assert not is_found or not {"TF013", "TF017"} & {*findings}, "they follow"
