"""Several robots with frames of the same names, each with a /tf in its own namespace."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
from bench import Benches
from ruamel.yaml import YAML

from webviz import Display, ProtocolClient
from webviz import Pose as At
from webviz.api.connection import GraphConnection
from webviz.api.context import Context
from webviz.api.declared import Topic
from webviz.api.frames import Frames
from webviz.api.robots import NamespacedRobot, RobotFrames, robot_of
from webviz.commands import Open, Save, SetProperty, Undo
from webviz.data.messages.transform_layout import MIN_TRANSFORMS
from webviz.data.transforms import TransformBuffer
from webviz.files.config import Branch, Unreadable, document
from webviz.files.opening import parse
from webviz.shell.cli.demo import standard_config
from webviz.shell.testing.messages import stamped_transform
from webviz_displays.interactive_markers.completion import Completed
from webviz_displays.interactive_markers.feedback import POSE_UPDATE, values_of
from webviz_displays.interactive_markers.tracked import Tracked
from webviz_displays.laser_scan import LaserScan
from webviz_displays.poses import Pose

S = 1_000_000_000
TEMPLATE = """\
version: 1
robots: [robot1, {namespace: fleet/robot2, prefix: r2_, shared: [map, earth]}]
displays:
- {type: Grid}
- type: Group
  name: "{robot}"
  displays: [{type: LaserScan, topic: "/{robot}/scan"}]
tools:
- {type: GoalPose, name: "Goal {robot}", topic: "/{robot}/goal_pose"}
"""


@pytest.mark.parametrize(
    ("robot", "frame", "name"),
    [
        (NamespacedRobot("robot1"), "base_link", "robot1/base_link"),
        (NamespacedRobot("/robot1/"), "/base_link", "robot1/base_link"),
        (NamespacedRobot("robot1"), "map", "map"),
        (NamespacedRobot("robot1"), "robot1/base_link", "robot1/base_link"),
        (NamespacedRobot("robot1"), "", ""),
        (NamespacedRobot("robot1", "r_", ("earth",)), "map", "r_map"),
        (NamespacedRobot("robot1", ""), "base_link", "base_link"),
    ],
)
def test_a_robot_prefixes_its_own_frames(robot: NamespacedRobot, frame: str, name: str) -> None:
    assert robot.frame(frame) == name


def test_a_display_belongs_to_the_robot_whose_namespace_its_topics_have() -> None:
    one, ten = NamespacedRobot("robot1"), NamespacedRobot("robot10")
    assert robot_of(["", "/robot10/scan"], (one, ten)) is ten
    assert robot_of(["/scan", "/robot11/scan"], (one, ten)) is None


def test_alternating_lists_of_frames_of_a_robot_keep_their_names(bench: Benches) -> None:
    b = bench(Pose(topic=Topic("/robot1/pose")), robots=("robot1",))

    def move(names: str, x: float, second: int) -> None:
        transforms = [
            stamped_transform("map", f"{names}{number}", second * S, (x, 0.0, 0.0))
            for number in range(MIN_TRANSFORMS)
        ]
        b.publish("/robot1/tf", "tf2_msgs/msg/TFMessage", {"transforms": transforms})
        b.turn()

    for second in (1, 2):  # the second one is read without being decoded
        for names in ("arm", "leg"):
            move(names, second, second)
    for names in ("arm", "leg"):
        transform = b.viewer.buffer.lookup("map", f"robot1/{names}3", 2 * S)
        assert transform.translation[0] == 2.0


def test_two_robots_with_equal_frames_are_drawn_where_each_is(bench: Benches) -> None:
    displays = [Pose(topic=Topic(f"/{name}/pose")) for name in ("robot1", "robot2")]
    b = bench(*displays, robots=("robot1", "robot2"))
    for x, name in ((1.0, "robot1"), (5.0, "robot2")):
        b.transform("map", "odom", S, x, topic=f"/{name}/tf")
        b.transform("odom", "base_link", 0, 0.5, static=True, topic=f"/{name}/tf_static")
        b.pose(f"/{name}/pose", "base_link", S, 0.25)
    b.turn()
    assert {"robot1/odom", "robot2/odom", "map"} <= {*b.viewer.state().frames}
    assert "odom" not in b.viewer.state().frames
    xs = [b.statuses(index) for index in (0, 1)]
    assert all(statuses["Transform"][0] == "OK" for statuses in xs), xs
    buffer = b.viewer.buffer
    assert buffer.lookup("map", "robot2/base_link", 0).translation[0] == 5.5


def test_a_missing_transform_is_explained_with_the_frame_of_the_robot(bench: Benches) -> None:
    b = bench(Pose(topic=Topic("/robot1/pose")), robots=("robot1",))
    b.pose("/robot1/pose", "base_link", S)
    for _ in range(3):
        b.turn()
        b.clock += 1.0
    assert "robot1/base_link" in b.statuses()["Transform"][1]


def test_entries_with_a_placeholder_are_repeated_for_each_robot() -> None:
    config = parse(TEMPLATE, "x.yaml")
    groups = [item for item in config.displays if isinstance(item, Branch)]
    assert [group.group.name for group in groups] == ["robot1", "fleet/robot2"]
    scans = [scan for group in groups for scan in group.displays]
    assert [s.topic.name for s in scans if isinstance(s, LaserScan)] == [
        "/robot1/scan",
        "/fleet/robot2/scan",
    ]
    assert [tool.name for tool in config.tools] == ["Goal robot1", "Goal fleet/robot2"]


def test_saving_keeps_a_placeholder_until_one_of_its_robots_differs(
    bench: Benches, tmp_path: Path
) -> None:
    file = tmp_path / "fleet.yaml"
    file.write_text(TEMPLATE)
    b = bench()
    b.do(Open(str(file)))
    before, rows = document(parse(TEMPLATE, "x.yaml")), b.states[-1].rows
    assert before["displays"] == YAML(typ="safe").load(TEMPLATE)["displays"]
    assert before["tools"] == YAML(typ="safe").load(TEMPLATE)["tools"]
    b.do(Save())
    assert document(parse(file.read_text(), "y.yaml")) == before
    b.do(SetProperty(rows[2].id, "size", 0.5))
    b.do(Save())
    [_, one, two] = YAML(typ="safe").load(file.read_text())["displays"]
    assert one == {
        "type": "Group",
        "name": "robot1",
        "displays": [{"type": "LaserScan", "topic": "/robot1/scan", "size": 0.5}],
    }
    assert two["name"] == "fleet/robot2"
    b.do(Undo())
    b.do(Save())
    assert document(parse(file.read_text(), "y.yaml")) == before


def test_without_robots_a_placeholder_is_an_error_of_its_display() -> None:
    text = 'version: 1\ndisplays: [{type: LaserScan, topic: "/{robot}/scan", size: -1}]\n'
    [item] = parse(text, "x.yaml").displays
    assert isinstance(item, Unreadable)


class Follower(Display, ProtocolClient):
    """Listens on a topic that no input declares, as displays with a protocol of their own."""

    def communicate(self, connection: GraphConnection, ctx: Context) -> None:
        connection.listen("/robot1/markers/update", "std_msgs/msg/String", 1)
        NAMES.append(ctx.frames.named("base_link"))


NAMES: list[str] = []


def test_a_display_with_a_protocol_of_its_own_belongs_to_the_robot_of_its_topics(
    bench: Benches,
) -> None:
    b = bench(Follower(), robots=("robot1",))
    b.turn()
    assert NAMES[-1] == "robot1/base_link"


@pytest.mark.parametrize(
    ("frame", "stamp_ns", "fixed", "header"),
    [
        ("base_link", 0, "map", ("base_link", 3)),
        ("base_link", 1 * S, "map", ("map", 0)),
        ("base_link", 1 * S, "robot1/odom", ("odom", 0)),
        ("odom", 0, "robot1/odom", ("odom", 0)),
    ],
)
def test_feedback_of_interactive_markers_has_the_frame_names_of_their_robot(
    frame: str, stamp_ns: int, fixed: str, header: tuple[str, int]
) -> None:
    buffer = TransformBuffer()
    for parent, child in (("map", "robot1/odom"), ("robot1/odom", "robot1/base_link")):
        for second in (1, 3):
            buffer.set_transform(parent, child, second * S, (1.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    frames = RobotFrames(Frames(buffer, fixed, 3 * S), NamespacedRobot("robot1"))
    marker = Completed("m", frame, stamp_ns, At(), "", 1.0, (), (), 0, ())
    values: Any = values_of(POSE_UPDATE, Tracked("m", marker), "", frames, "client")
    assert (values["header"]["frame_id"], values["header"]["stamp"]["sec"]) == header


@pytest.mark.parametrize(("robots", "tools"), [(3, 6), (20, 16)])
def test_the_config_of_a_fleet_has_no_more_tools_than_the_toolbar_has_room_for(
    robots: int, tools: int
) -> None:
    with standard_config(robots) as path:
        config = parse(path.read_text(), path.name)
    assert len(config.settings.robots) == robots
    assert len([tool for tool in config.tools if "robot" in tool.name]) == tools
