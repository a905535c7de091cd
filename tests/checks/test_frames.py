"""Faults of transforms, provoked with real transforms."""

from __future__ import annotations

import math
from collections.abc import Callable

import examining
import pytest
from examining import SCAN, display, three_ranges

from webviz import Display, Finding, OtherFixedFrame, Symptom, Topic
from webviz.api.finding import CauseLevel
from webviz.api.offer import Offer, Publisher
from webviz.shell.testing.harness import Harness
from webviz.shell.testing.source import SECOND
from webviz_displays.laser_scan import LaserScan
from webviz_displays.robot_model import RobotModel

AWAY = (0.1, 0.0, 0.0)
LINKS = """<robot name="r"><link name="base_link"/><link name="arm"/>
<joint name="j" type="revolute"><parent link="base_link"/><child link="arm"/>
<limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>"""

Make = Callable[..., Harness]


@pytest.fixture
def robot(webviz_harness: Make) -> Harness:
    """A viewer of a robot that is well."""
    stage = viewer(webviz_harness)
    drive(stage)
    return stage


def viewer(make: Make, display: Display | None = None) -> Harness:
    """A viewer whose static transforms are latched."""
    stage = make(display or LaserScan(name="Scan"), fixed_frame="map")
    latched = Publisher("/test", "tf2_msgs/msg/TFMessage", "reliable", "transient_local")
    stage.source.topics["/tf_static"] = Offer((latched,), ("reliable", "transient_local"))
    return stage


def drive(stage: Harness, stamp_ns: int = 0, child: str = "odom") -> None:
    """Publish where the robot is."""
    stage.transform("map", child, stamp_ns=stamp_ns or stage.source.now)


def scan(stage: Harness, frame: str = "laser", stamp_ns: int | None = None) -> None:
    """Publish a scan."""
    stamp_ns = stage.source.now if stamp_ns is None else stamp_ns
    stage.publish("/scan", SCAN, three_ranges(frame, stamp_ns))


def mount(stage: Harness) -> None:
    """Publish where the laser is mounted."""
    stage.transform("odom", "base_link")
    stage.transform("base_link", "laser", AWAY)
    stage.turn()


def examined(
    stage: Harness, seconds: float = 1.1, publish: Callable[[], object] = lambda: None
) -> dict[str, Finding]:
    """The findings about frames."""
    return examining.examined(stage, CauseLevel.FRAMES, seconds, publish)


def only(findings: dict[str, Finding]) -> Finding:
    """The only finding."""
    (finding,) = findings.values()
    return finding


def test_a_robot_that_is_well_has_no_finding(robot: Harness) -> None:
    mount(robot)
    for _ in range(5):
        robot.source.now += SECOND // 10
        robot.clock += 0.1
        drive(robot)
        scan(robot)
        robot.turn()
    assert examined(robot, seconds=0.4) == {}


def test_no_transforms(webviz_harness: Make) -> None:
    stage = webviz_harness(LaserScan(), LaserScan(topic=Topic("/front")), fixed_frame="map")
    scan(stage)
    finding = only(examined(stage))
    assert finding.id == "TF001"
    assert {each.status for each in finding.explains} == {"Fixed Frame", "Transform"}
    talker = Publisher("/talker", "tf2_msgs/msg/TFMessage", "reliable", "volatile")
    stage.source.topics["/tf"] = Offer((talker,))
    assert examined(stage) == {}, "webviz has not subscribed yet"
    stage.source.topics["/tf"] = Offer((talker,), ("reliable", "volatile"))
    assert only(examined(stage)).cause == "/talker publishes transforms, but none has arrived."


@pytest.mark.parametrize(
    ("frame", "id", "cause"),
    [
        ("lasr", "TF016 lasr", 'The frame "lasr" does not exist, but "laser" does.'),
        ("", "TF015", "The messages of a display have no frame id."),
        ("camera", "TF017 camera", 'No transform leads to the frame "camera".'),
    ],
)
def test_the_frame_id_of_data(robot: Harness, frame: str, id: str, cause: str) -> None:
    mount(robot)
    scan(robot, frame)
    drive(robot)
    robot.turn()
    findings = examined(robot)
    assert [*findings] == [id]
    assert findings[id].cause == cause
    assert findings[id].explains == (Symptom(display(robot, "Scan"), "Transform"),)


@pytest.mark.parametrize(("frame", "is_mounted"), [("camera", True), ("world", False)])
def test_no_command_mounts_the_world_on_the_robot(
    robot: Harness, frame: str, is_mounted: bool
) -> None:
    mount(robot)
    scan(robot, frame)
    drive(robot)
    robot.turn()
    command = examined(robot)[f"TF017 {frame}"].command
    assert ("--frame-id base_link" in command) is is_mounted


def test_a_leading_slash(robot: Harness) -> None:
    mount(robot)
    scan(robot, "/laser")
    robot.turn()
    finding = only(examined(robot))
    assert (finding.id, finding.subject) == ("TF014", "/laser")


def test_static_transforms_that_are_not_latched(robot: Harness) -> None:
    volatile = Publisher("/mount", "tf2_msgs/msg/TFMessage", "reliable", "volatile")
    robot.source.topics["/tf_static"] = Offer((volatile,), ("reliable", "volatile"))
    finding = only(examined(robot))
    assert (finding.id, finding.subject) == ("TF024", "/mount")


def test_static_transforms_that_were_missed_come_before_their_symptoms(
    webviz_harness: Make,
) -> None:
    stage = webviz_harness(LaserScan(name="Scan"), fixed_frame="map")
    volatile = Publisher("/mount", "tf2_msgs/msg/TFMessage", "reliable", "volatile")
    stage.source.topics["/tf_static"] = Offer((volatile,), ("reliable", "volatile"))
    scan(stage)
    finding = only(examined(stage))  # not that no transform has arrived
    assert finding.id == "TF024"
    assert "Transform" in {each.status for each in finding.explains}
    drive(stage)
    scan(stage)
    assert only(examined(stage)).id == "TF024"  # not that no frame is named so


def test_a_misspelt_fixed_frame(robot: Harness) -> None:
    mount(robot)
    robot.set_fixed_frame("mapp")
    scan(robot)
    drive(robot)
    finding = only(examined(robot))
    assert (finding.id, finding.button) == ("TF002", OtherFixedFrame("map"))
    robot.set_fixed_frame("map")
    assert examined(robot, 0.5) == {}


def test_an_unknown_fixed_frame(robot: Harness) -> None:
    robot.set_fixed_frame("utm")
    drive(robot)
    assert only(examined(robot)).id == "TF004"


@pytest.mark.parametrize("prefix", ["", "robot1/", "robot1_"])
@pytest.mark.parametrize("is_known", [False, True])
def test_localisation_is_missing(webviz_harness: Make, is_known: bool, prefix: str) -> None:
    stage = viewer(webviz_harness)
    stage.transform(f"{prefix}odom", f"{prefix}base_link", stamp_ns=stage.source.now)
    stage.transform(f"{prefix}base_link", f"{prefix}laser")
    if is_known:
        stage.transform("map", "dock")
    stage.turn()
    scan(stage, f"{prefix}laser")
    finding = only(examined(stage))
    assert finding.id == "TF003"
    assert Symptom(display(stage, "Scan"), "Transform") in finding.explains
    assert finding.button == OtherFixedFrame(f"{prefix}odom")


def test_localisation_of_one_of_two_robots_is_missing(webviz_harness: Make) -> None:
    stage = webviz_harness(*(LaserScan(topic=Topic(f"/r{n}/scan")) for n in (1, 2)))
    for number in (1, 2):
        stage.transform(f"r{number}/odom", f"r{number}/laser", stamp_ns=stage.source.now)
    stage.transform("map", "r1/odom", stamp_ns=stage.source.now)
    stage.turn()
    for number in (1, 2):
        values = {"ranges": [2.0] * 3, "range_max": 10.0}
        stage.publish(f"/r{number}/scan", SCAN, values, frame=f"r{number}/laser")
    stage.turn()
    assert [*examined(stage)] == ["TF003 r2/odom"]


@pytest.mark.parametrize("prefix", ["", "robot1/", "robot1_"])
def test_odometry_is_missing(webviz_harness: Make, prefix: str) -> None:
    stage = viewer(webviz_harness)
    drive(stage, child=f"{prefix}odom")
    stage.transform(f"{prefix}base_link", f"{prefix}laser")
    stage.turn()
    scan(stage, f"{prefix}laser")
    finding = only(examined(stage))
    assert (finding.id, finding.subject) == ("TF005", f"{prefix}base_link")
    assert finding.cause.startswith(f'Nothing publishes the transform from "{prefix}odom"')


def test_two_trees(robot: Harness) -> None:
    robot.transform("sensor mount", "laser")
    robot.turn()
    scan(robot)
    finding = only(examined(robot))
    assert (finding.id, finding.subject) == ("TF006", "sensor mount")


def test_an_optical_frame_that_is_not_rotated(robot: Harness) -> None:
    mount(robot)
    robot.transform("base_link", "camera_optical_frame")
    robot.turn()
    assert only(examined(robot)).id == "TF025"
    robot.transform("base_link", "camera_optical_frame", xyzw=(-0.5, 0.5, -0.5, 0.5))
    robot.turn()
    assert "TF025 camera_optical_frame" not in examined(robot)


def test_a_loop(robot: Harness) -> None:
    mount(robot)
    for parent, child in (("base_link", "odom"), ("odom", "base_link")):
        robot.transform(parent, child, stamp_ns=robot.source.now)
    scan(robot)
    key, finding = next(iter(examined(robot).items()))
    assert key == "TF007 base_link odom"
    assert "base_link" in finding.cause


def alternating(stage: Harness, *publish: Callable[[], None]) -> None:
    """Let publishers take turns."""
    for _ in range(10):
        for each in publish:
            stage.source.now += SECOND // 20
            each()
            stage.turn()


@pytest.mark.parametrize(
    ("id", "first", "second"),
    [
        ("TF008 laser", ("base_link", AWAY, True), ("odom", AWAY, True)),
        ("TF009 laser", ("base_link", AWAY, True), ("base_link", (0.5, 0.0, 0.0), True)),
        ("TF010 laser", ("base_link", AWAY, True), ("base_link", AWAY, False)),
        ("TF011 laser", ("base_link", AWAY, False), ("base_link", (3.0, 0.0, 0.0), False)),
        ("TF008 laser", ("base_link", AWAY, False), ("odom", AWAY, False)),
    ],
)
def test_two_publishers_of_a_frame(
    robot: Harness,
    id: str,
    first: tuple[str, tuple[float, float, float], bool],
    second: tuple[str, tuple[float, float, float], bool],
) -> None:
    robot.transform("odom", "base_link")

    def publish(parent: str, xyz: tuple[float, float, float], is_static: bool) -> None:
        stamp_ns = None if is_static else robot.source.now
        robot.transform(parent, "laser", xyz, stamp_ns=stamp_ns)

    alternating(robot, lambda: publish(*first), lambda: publish(*second))
    drive(robot)
    assert [*examined(robot)] == [id]


def test_robot_state_publisher_is_missing(robot: Harness) -> None:
    del robot.source.topics["/tf_static"]
    scan(robot)
    drive(robot)
    assert only(examined(robot)).id == "TF012"


def test_joint_states_are_missing(webviz_harness: Make) -> None:
    stage = viewer(webviz_harness, RobotModel(name="Robot"))
    stage.transform("map", "base_link")
    stage.publish("/robot_description", "std_msgs/msg/String", {"data": LINKS})
    stage.settle()
    finding = only(examined(stage))
    assert (finding.id, finding.evidence["links"]) == ("TF013", ("arm",))


def test_a_link_that_has_stopped(robot: Harness) -> None:
    mount(robot)
    scan(robot)
    robot.turn()
    for _ in range(40):
        robot.source.now += SECOND // 10
        robot.clock += 0.1
        scan(robot)
        robot.turn()
    finding = only(examined(robot))
    assert (finding.id, finding.evidence["link"]) == ("TF018", "odom")


@pytest.mark.parametrize("count", [1, 4])
def test_a_link_that_is_rare_has_not_stopped(robot: Harness, count: int) -> None:
    mount(robot)
    robot.source.now += 30 * SECOND

    def turn(seconds: int) -> None:
        for _ in range(seconds * 10):
            robot.source.now += SECOND // 10
            robot.clock += 0.1
            robot.transform("odom", "base_link", stamp_ns=robot.source.now)
            scan(robot)
            robot.turn()

    for _ in range(count):
        drive(robot)
        turn(3)
    findings = examined(robot, 0.1)
    assert not [each.cause for each in findings.values() if "no longer" in each.cause]
    if count > 1:
        assert [*findings] == ["TF019 odom"]


@pytest.mark.parametrize(
    ("child", "every", "ids"),
    [
        ("odom", 5, ["TF026 odom"]),
        ("odom", 40, []),  # localisation has corrected itself
        ("base_link", 15, ["TF026 base_link"]),
        ("base_link", 0, []),
    ],
)
def test_transforms_that_jump(webviz_harness: Make, child: str, every: int, ids: list[str]) -> None:
    stage = viewer(webviz_harness)
    for number in range(60):
        stage.source.now += SECOND // 10
        x = 0.05 * number
        for parent, name in (("map", "odom"), ("odom", "base_link")):
            jump = 1.5 * (number // every % 2) if name == child and every else 0.0
            stage.transform(parent, name, (x + jump, 0.0, 0.0), stamp_ns=stage.source.now)
        stage.turn()
    assert [*examined(stage, 0.1)] == ids


def test_refused_transforms(robot: Harness) -> None:
    mount(robot)
    for _ in range(3):
        robot.transform("base_link", "arm", (math.nan, 0.0, 0.0), stamp_ns=robot.source.now)
    drive(robot)
    finding = only(examined(robot))
    assert (finding.id, finding.subject) == ("TF023", "arm")


@pytest.mark.parametrize("child", ["laser", "base_link"])
@pytest.mark.parametrize(
    ("parent", "rotation", "why"),
    [
        ("odom", (0.0, 0.0, 0.0, 0.0), "rotation holds a NaN or has length zero"),
        ("odom", (math.nan, 0.0, 0.0, 1.0), "rotation holds a NaN or has length zero"),
        ("", (0.0, 0.0, 0.0, 1.0), "parent frame id is empty"),
    ],
)
def test_a_static_transform_that_is_refused_matters_until_it_is_replaced(
    robot: Harness, child: str, parent: str, rotation: tuple[float, float, float, float], why: str
) -> None:
    if child == "base_link":
        robot.transform("base_link", "laser", AWAY)
    robot.transform(parent, child, xyzw=rotation)

    def go_on() -> None:
        drive(robot)
        scan(robot)

    examined(robot, 4.0, go_on)  # longer than moving transforms that are refused are reported
    finding = only(examined(robot, 4.0, go_on))
    assert (finding.id, finding.subject) == ("TF023", child)
    assert why in finding.cause
    assert {each.status for each in finding.explains} >= {"Transform", "Transforms"}
    assert "no transform to it" not in robot.status("Scan").text
    assert f'the transform of "{child}" was refused' in robot.status("Scan").text
    robot.transform("odom", child)
    assert not examined(robot, 4.0, go_on)


def test_a_transform_that_becomes_invalid_has_not_stopped(robot: Harness) -> None:
    mount(robot)

    def diverge() -> None:
        robot.transform("map", "odom", (math.nan, 0.0, 0.0), stamp_ns=robot.source.now)
        scan(robot)

    finding = only(examined(robot, 0.5, diverge))
    assert (finding.id, finding.subject) == ("TF023", "odom")


def test_a_frame_that_is_too_far(robot: Harness) -> None:
    mount(robot)
    robot.transform("base_link", "laser", (1e13, 0.0, 0.0))
    drive(robot)
    scan(robot)
    robot.turn()
    assert "TF022" in {each.id for each in examined(robot).values()}


@pytest.mark.parametrize(("every", "id"), [(5, "TF019 odom"), (1, "")])
def test_a_transform_slower_than_the_data(robot: Harness, every: int, id: str) -> None:
    mount(robot)
    count = 0

    def publish() -> None:
        nonlocal count
        count += 1
        if count % every == 0:
            drive(robot)
        scan(robot)

    for _ in range(25):
        robot.source.now += SECOND // 5
        robot.clock += 0.2
        publish()
        robot.turn()
    assert [*examined(robot, 0.2, publish)] == ([id] if id else [])


@pytest.mark.parametrize(("late_s", "id"), [(30, "TF020 odom"), (0, "")])
def test_data_older_than_the_transforms(robot: Harness, late_s: int, id: str) -> None:
    mount(robot)

    def publish() -> None:
        drive(robot)
        scan(robot, stamp_ns=robot.source.now - late_s * SECOND)

    # Less than one message a second: the stamps of more would be the cause, TIME009.
    assert [*examined(robot, 1.1, publish)] == ([id] if id else [])


@pytest.mark.parametrize(("size", "id"), [(2, "TF021 odom"), (20, "")])
def test_a_queue_too_short_for_its_transform(webviz_harness: Make, size: int, id: str) -> None:
    stage = viewer(webviz_harness, LaserScan(topic=Topic("/scan", filter_size=size)))
    mount(stage)

    def publish() -> None:
        drive(stage, stage.source.now - 6 * SECOND // 10)
        scan(stage)

    assert [*examined(stage, 0.1, publish)] == ([id] if id else [])


@pytest.mark.parametrize(("fixed_frame", "is_found"), [("map", True), ("utm", False)])
def test_a_robot_at_utm_coordinates(
    webviz_harness: Callable[..., Harness], fixed_frame: str, is_found: bool
) -> None:
    stage = webviz_harness(LaserScan(), fixed_frame=fixed_frame)
    mount(stage)
    stage.transform(fixed_frame, "odom", (4.5e5, 5.4e6, 0.0))
    stage.transform("odom", "base_link")
    scan(stage)
    findings = {each.id: each for each in examined(stage).values()}
    assert ("TF022" in findings) is is_found
    if is_found:
        assert findings["TF022"].subject == "odom"
