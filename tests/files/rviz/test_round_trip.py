"""Import then export of a .rviz file loses nothing, and export makes files RViz2 opens."""

from __future__ import annotations

import contextlib
import functools
import textwrap
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rviz_trees import differences, loaded, texts

from webviz.api.declared import Topic, make, set_property
from webviz.api.registry import display_types
from webviz.api.views import Orbit
from webviz.files import config as config_file
from webviz.files import opening, rviz
from webviz.files.config import Config, ConfigError, dump
from webviz.files.opening import parse
from webviz.files.rviz.tree import write
from webviz.panels.nav2 import Nav2
from webviz_displays.camera import Camera
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map

NASTY = """\
Panels: ~
Visualization Manager:
  Class: ""
  Displays:
    - Class: rviz_default_plugins/LaserScan
      Topic: /scan
      Unreliable: true
      Queue Size: 10
      Size (m): 0.029999999329447746
      Min Intensity: 999999
      Max Intensity: -999999
      Color: '#ff0000'
      Color Transformer: ""
      Value: true
    - Class: rviz_default_plugins/LaserScan
      Name: 007
      Enabled: true
      Value: false
      Durability Policy: Volatile
      Topic:
        Value: <namespace>/scan
        Reliability Policy: System Default
      Style: Cones
      Alpha: {Value: 0.5, Extra: 1e-3}
      Size (m): -1
      Autocompute Value Bounds: false
    - Class: rviz_default_plugins/LaserScan
      Name: 007
      Selectable: false
    - Class: rviz_default_plugins/MarkerArray
      Name: Markers
      Namespaces:
        "": true
        0: false
        1: true
    - Class: rviz_default_plugins/Camera
      Name: Camera
      Topic: {Value: /camera/image_raw}
      Image Rendering: overlay
      Overlay Alpha: 0.25
      Zoom Factor: 2
      Far Plane Distance: 50
      Visibility:
        Grid: true
        Full: {TF: false, Robot: true, Value: true}
        Empty: {Value: false}
        Value: true
      Value: true
    - Class: rviz_plugins::Thing
      Name: Thing
    - {}
    - just text
    - Class: rviz_common/Group
      Name: Empty
      Displays: ~
    - Class: rviz_common/Group
      Name: Full
      Enabled: true
      Secret: yes
      Displays:
        - Class: rviz_default_plugins/TF
          Name: TF
          Frames:
            All Enabled: false
            odd [frame]: {Value: true}
            0: {Value: false, More: ~}
          Tree: {map: {odom: {}}}
        - Class: rviz_default_plugins/RobotModel
          Name: Robot
          Description Topic: {Value: robot_description, Durability Policy: Volatile}
          Links:
            All Links Enabled: false
            Link Tree Style: ""
            base: {Alpha: 0.30000001192092896, Value: true, Show Axes: no}
        - Class: rviz_default_plugins/Grid
          Line Style: Billboards
          Offset: {X: 1, Y: two, Z: 3}
  Global Options:
    Background Color: 48; 48; 48
    Default Light: true
    Fixed Frame: /map
    Frame Rate: 1000
  Tools: [{Class: rviz_default_plugins/SetGoal, Topic: /goal}]
  Views:
    Current: {Class: rviz_default_plugins/TopDownOrtho, Scale: 54, X: 1, Y: 2, Angle: 0.5}
    Saved:
      - {Class: rviz_default_plugins/Orbit, Name: Corner, Distance: 3}
Window Geometry:
  QMainWindow State: 0000123400000000
  Width: 1e3
Unheard Of: 2001-01-01
"""


@functools.cache
def again(text: str) -> str:
    """The text after import, a save as YAML, and export."""
    config, _ = rviz.read(text, "x.rviz")
    return rviz.write(parse(dump(config), "x.yaml"))[0]


def test_real_files_come_back_whole(real_file: Path) -> None:
    text = real_file.read_text()
    assert list(differences(texts(text), texts(again(text)))) == []


def test_real_files_mean_the_same_when_they_come_back(real_file: Path) -> None:
    text = real_file.read_text()
    config, back = (rviz.read(each, "x.rviz")[0] for each in (text, again(text)))
    for each in (config, back):
        each.settings.rviz = {}  # what comes back spells out more
    assert dump(back) == dump(config)


def test_nasty_files_come_back_whole() -> None:
    assert list(differences(texts(NASTY), texts(again(NASTY)))) == []


def test_a_file_that_was_exported_comes_back_to_the_letter() -> None:
    first = again(NASTY)
    assert again(first) == first


def test_an_exported_config_is_imported_as_it_was() -> None:
    text = again(NASTY)
    assert dump(rviz.read(text, "x.rviz")[0]) == dump(rviz.read(again(text), "x.rviz")[0])


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("rviz/Grid", "rviz_default_plugins/Grid"),
        ("rviz/WrenchStamped", "rviz_default_plugins/Wrench"),
        ("octomap_rviz_plugin/OccupancyGrid", "octomap_rviz_plugins/OccupancyGrid"),
        ("octomap_rviz_plugin/ColorOccupancyGrid", "octomap_rviz_plugins/ColorOccupancyGrid"),
        ("octomap_rviz_plugin/OccupancyMap", "octomap_rviz_plugins/OccupancyMap"),
        ("rtabmap_ros/Info", "rtabmap_rviz_plugins/Info"),
        ("rtabmap_ros/MapCloud", "rtabmap_rviz_plugins/MapCloud"),
        ("rtabmap_ros/MapGraph", "rtabmap_rviz_plugins/MapGraph"),
    ],
)
def test_ros_1_classes_are_written_as_those_of_ros_2(old: str, new: str) -> None:
    text = f"Visualization Manager:\n  Displays: [{{Class: {old}, Name: A, Value: true}}]\n"
    where = ["/Visualization Manager/Displays[0]/Class"]
    assert list(differences(texts(text), texts(again(text)))) == where
    assert f"Class: {new}\n" in again(text)


def test_every_display_type_goes_to_rviz_and_back() -> None:
    types = {name: cls for name, cls in display_types().items() if cls.rviz and name != "Group"}
    config = Config(displays=[make(cls, {"name": f"my {name}"}) for name, cls in types.items()])
    text, report = rviz.write(config)
    back, _ = rviz.read(text, "x.rviz")
    assert report.notes == []
    assert [type(display) for display in back.displays] == list(types.values())
    for before, after in zip(config.displays, back.displays, strict=True):
        assert dump(Config(displays=[after])) == dump(Config(displays=[before]))
    assert rviz.write(back)[0] == text


def test_a_new_file_hears_the_usual_publishers_and_has_panels_and_tools() -> None:
    config = config_file.standard()
    config.displays.append(make(display_types()["PointCloud2"], {}))
    tree = loaded(rviz.write(config)[0])
    manager = tree["Visualization Manager"]
    by_name = {display["Name"]: display for display in manager["Displays"]}
    assert by_name["LaserScan"]["Topic"]["Reliability Policy"] == "Best Effort"
    assert by_name["PointCloud2"]["Color Transformer"] == ""
    assert by_name["Map"]["Topic"]["Durability Policy"] == "Transient Local"
    assert by_name["Map"]["Update Topic"]["Value"] == "/map_updates"
    robot = by_name["RobotModel"]["Description Topic"]
    assert (robot["Value"], robot["Durability Policy"]) == ("/robot_description", "Transient Local")
    assert {panel["Class"] for panel in tree["Panels"]} >= {"rviz_common/Displays"}
    (goal,) = [tool for tool in manager["Tools"] if tool["Class"].endswith("/SetGoal")]
    assert goal["Topic"] == {
        "Value": "/goal_pose",
        "Depth": 5,
        "History Policy": "Keep Last",
        "Reliability Policy": "Reliable",
        "Durability Policy": "Volatile",
    }
    assert manager["Displays"][0]["Line Style"] == {"Line Width": 0.03, "Value": "Lines"}


def test_automatic_qos_hears_all_publishers_in_rviz_and_is_automatic_again_here() -> None:
    chosen = Topic("/map", reliability="best_effort")
    displays = [LaserScan(topic=Topic("/scan")), Map(topic=chosen)]
    text, _ = rviz.write(Config(displays=displays))
    scan, map = loaded(text)["Visualization Manager"]["Displays"]
    assert (scan["Topic"]["Reliability Policy"], scan["Topic"]["Automatic QoS"]) == (
        "Best Effort",
        True,
    )
    assert map["Topic"]["Durability Policy"] == "Transient Local"
    back, report = rviz.read(text, "x.rviz")
    assert report.is_complete
    assert back.displays[0].topic == Topic("/scan")  # pyright: ignore
    assert back.displays[1].topic == chosen  # pyright: ignore
    # RViz drops the mark, and so what it writes is a choice.
    plain = text.replace("Automatic QoS: true", "")
    assert rviz.read(plain, "x.rviz")[0].displays[0].topic.reliability == "best_effort"  # pyright: ignore
    # What RViz writes by default has no mark when it comes back.
    usual = text.replace("Best Effort", "Reliable").replace("Transient Local", "Volatile")
    assert "Automatic QoS" not in again(usual.replace("Automatic QoS: true", ""))


def test_qos_of_a_camera_and_the_form_of_its_topic_come_back() -> None:
    text = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Camera
      Topic: {Value: /a, Reliability Policy: Reliable}
    - Class: rviz_default_plugins/Camera
      Topic: /b
"""
    back = again(text)
    assert list(differences(texts(text), texts(back))) == []
    policy = {"auto"}
    for config in (rviz.read(text, "x.rviz")[0], rviz.read(back, "x.rviz")[0]):
        for camera in config.displays:
            assert isinstance(camera, Camera)
            assert {camera.topic.reliability, camera.camera_info_topic.reliability} == policy


def test_a_qos_that_a_file_does_not_name_stays_automatic() -> None:
    text = """\
Visualization Manager:
  Displays:
    - Class: rviz/Image
      Image Topic: /a
      Unreliable: false
    - Class: rviz_default_plugins/Camera
      Image Topic: /b
      Queue Size: 2
    - Class: rviz/RobotModel
      Robot Description: robot_description
    - Class: rviz/Image
      Image Topic: /a
      Unreliable: true
"""
    back = again(text)
    assert all(place.endswith("/Class") for place in differences(texts(text), texts(back)))
    expected = ["auto", "auto", "auto", "best_effort"]
    for each in (text, back):
        image, camera, robot, lossy = rviz.read(each, "x.rviz")[0].displays
        assert isinstance(camera, Camera)
        topics = [image.topic, camera.topic, robot.joint_states_topic, lossy.topic]  # pyright: ignore
        assert [topic.reliability for topic in topics] == expected


def test_all_that_a_rviz_file_cannot_hold_is_reported() -> None:
    config = parse(
        "robots: [one, two]\npublish: [/a]\n"
        "panels: [{type: Plot}, {type: Joints}, {type: Nav2, namespace: one}]\n",
        "x.yaml",
    )
    text, report = rviz.write(config)
    assert report.sentences() == [
        "Settings: publish, robots: not in RViz's format, so it is left out.",
        "Plot: Plot: skipped, because RViz has no such panel.",
        "Joints: Joints: skipped, because RViz has no such panel.",
    ]
    back, _ = rviz.read(text, "x.rviz")
    (nav2,) = (each for each in back.panels if isinstance(each, Nav2))
    assert nav2.namespace == "one"
    back.panels = [each for each in back.panels if each is not nav2]
    assert "Navigation 2" not in rviz.write(back)[0]


def test_saving_as_rviz_returns_the_unsupported_parts(tmp_path: Path) -> None:
    config = parse("robots: [one]", "x.yaml")
    assert opening.save(config, tmp_path / "a.yaml") == []
    (sentence,) = opening.save(config, tmp_path / "a.rviz")
    assert sentence.startswith("Settings: robots: not in RViz's format")


def scan(text: str) -> Config:
    head = "Visualization Manager:\n  Displays:\n    - Class: rviz_default_plugins/LaserScan\n"
    return rviz.read(head + textwrap.indent(textwrap.dedent(text), "      "), "x.rviz")[0]


def exported(config: Config) -> dict[str, Any]:
    return loaded(rviz.write(config)[0])["Visualization Manager"]


def test_a_change_made_here_wins_over_the_spelling_of_the_file() -> None:
    config = scan("Topic: /scan\nUnreliable: true\nColor: red\nSelectable: false\n")
    display: Any = config.displays[0]
    assert exported(config)["Displays"][0]["Color"] == "red"
    set_property(display, "color", [0, 0, 255])
    set_property(display, "topic", {"name": "/front", "reliability": "auto"})
    tree = exported(config)["Displays"][0]
    assert tree["Color"] == "0; 0; 255"
    assert tree["Topic"]["Value"] == "/front"
    assert tree["Selectable"] is False


def test_preserved_entries_stay_with_their_display() -> None:
    config = scan("Name: A\nGlow: 1\n")
    text = rviz.write(config)[0].replace("Name: A", "Name: B").replace("Glow: 1", "Glow: 2")
    config.displays += rviz.read(text, "x.rviz")[0].displays
    config.settings.rviz["Visualization Manager"]["Displays"] += [
        {"Class": "rviz_default_plugins/LaserScan", "Name": "B", "Glow": 2}
    ]
    config.displays.reverse()
    assert [d["Glow"] for d in exported(config)["Displays"]] == [2, 1]
    del config.displays[0]
    assert [d["Glow"] for d in exported(config)["Displays"]] == [1]


def test_a_view_that_was_moved_is_written_as_orbit() -> None:
    config, _ = rviz.read(NASTY, "x.rviz")
    assert exported(config)["Views"]["Current"]["Class"] == "rviz_default_plugins/TopDownOrtho"
    config.settings.view = Orbit(distance=2.0)
    current = exported(config)["Views"]["Current"]
    assert (current["Class"], current["Distance"]) == ("rviz_default_plugins/Orbit", 2)
    assert "Scale" not in current
    assert exported(config)["Views"]["Saved"][0]["Name"] == "Corner"


def test_parts_unsupported_by_rviz_are_reported() -> None:
    config = parse("displays: [{type: LaserScan, size: -1}, {type: Grid}]", "x.yaml")
    text, report = rviz.write(config)
    assert len(loaded(text)["Visualization Manager"]["Displays"]) == 1
    assert "LaserScan: this entry: skipped: x.yaml:1: displays[0].size" in report.sentences()[0]


def test_the_format_follows_the_extension(tmp_path: Path) -> None:
    path = tmp_path / "x.RVIZ"
    opening.save(config_file.standard(), path)
    assert "Visualization Manager" in path.read_text()
    names = [getattr(display, "name", "") for display in opening.load(path).displays]
    assert names == list(config_file.STANDARD)


def test_hundreds_of_nested_displays_come_back() -> None:
    lines = ["Visualization Manager:", "  Displays:"]
    for depth in range(6):
        pad = "    " + "  " * 2 * depth
        lines += [
            f"{pad}- Class: rviz_default_plugins/LaserScan\n{pad}  Name: {i}" for i in range(40)
        ]
        lines += [f"{pad}- Class: rviz_common/Group\n{pad}  Name: G{depth}\n{pad}  Displays:"]
    lines += ["    " + "  " * 12 + "- {Class: rviz_default_plugins/Grid, Name: last}"]
    text = "\n".join(lines)
    assert list(differences(texts(text), texts(again(text)))) == []
    assert rviz.read(text, "x.rviz")[1].total["displays"] == 247


WORDS = [
    "Visualization Manager",
    "Displays",
    "Class",
    "rviz_default_plugins/LaserScan",
    "rviz_default_plugins/TF",
    "rviz_default_plugins/Orbit",
    "rviz_common/Group",
    "Topic",
    "Frames",
    "Links",
    "Value",
    "Enabled",
    "Views",
    "Current",
    "Global Options",
    "Fixed Frame",
    "Background Color",
    "Distance",
    "Depth",
    "Size (m)",
]
SCALARS = (
    st.none()
    | st.booleans()
    | st.integers()
    | st.floats()
    | st.text(max_size=5)
    | st.sampled_from(WORDS)
)
TREES = st.recursive(
    SCALARS,
    lambda inner: (
        st.lists(inner, max_size=4)
        | st.dictionaries(st.sampled_from(WORDS) | st.text(max_size=3), inner, max_size=5)
    ),
    max_leaves=20,
)


@settings(deadline=None, max_examples=60)
@given(st.text())
def test_any_text_is_a_config_or_one_sentence(text: str) -> None:
    with contextlib.suppress(ConfigError):
        rviz.read(text, "x.rviz")


@settings(deadline=None, max_examples=100)
@given(
    st.fixed_dictionaries(
        {
            "Displays": st.lists(
                st.dictionaries(st.sampled_from(WORDS), TREES, max_size=6).map(
                    lambda tree: {**tree, "Class": tree.get("Class", WORDS[3])}
                ),
                max_size=4,
            )
            | TREES,
            "Views": TREES,
            "Global Options": TREES,
        }
    )
)
def test_any_values_are_a_config_that_is_written_again(manager: dict[str, Any]) -> None:
    tree = {"Visualization Manager": manager}
    text = write(tree)
    config, _ = rviz.read(text, "x.rviz")
    first = rviz.write(config)[0]
    assert list(lost_but_shape(texts(text), texts(first))) == []
    assert again(first) == first


def lost_but_shape(before: Any, after: Any) -> list[str]:
    """Return the losses besides lists of displays that are not lists."""
    return [path for path in differences(before, after) if not path.endswith("/Displays")]


@settings(deadline=None, max_examples=40)
@given(TREES)
def test_any_kept_part_of_a_config_is_written(entries: Any) -> None:
    config = Config()
    config.settings.rviz = {"Visualization Manager": entries}
    loaded(rviz.write(config)[0])


def test_many_names_of_two_words_survive_the_config_file() -> None:
    frames = {f"left wheel {i}": bool(i % 2) for i in range(60)}
    config = parse(dump(Config(displays=[make(display_types()["TF"], {"frames": frames})])), "x")
    tf: Any = config.displays[0]
    assert tf.frames == frames


def test_marks_of_yaml_in_names_survive_the_config_file() -> None:
    frames = {":0": True, "?1": False, "a: b": True, "#c": True, "- d": False, "": True}
    config = Config(displays=[make(display_types()["TF"], {"name": "?x", "frames": frames})])
    tf: Any = parse(dump(config), "x").displays[0]
    assert (tf.name, tf.frames) == ("?x", frames)


@pytest.mark.parametrize("background", [None, (48, 48, 48), (1, 2, 3)])
def test_a_background_is_written_unless_it_follows_the_theme(
    background: tuple[int, int, int] | None,
) -> None:
    config = Config(settings=config_file.Settings(background=background))
    text, _ = rviz.write(config)
    assert ("Background Color" in text) == (background is not None)
    assert parse(text, "a.rviz").settings.background == background


THICK = """\
Visualization Manager:
  Displays:
    - {Class: rviz_default_plugins/Axes, Name: Axes, Radius: 0.3}
    - {Class: rviz_default_plugins/Pose, Name: Pose, Shaft Radius: 0.07, Axes Radius: 0.1}
    - {Class: rviz_default_plugins/PointStamped, Name: Point}
    - Class: rviz_default_plugins/Odometry
      Name: Odometry
      Shape: {Value: Axes, Axes Radius: 0.02, Shaft Radius: 0.05}
"""


def test_radii_of_rviz_which_are_diameters_are_halved_and_doubled_again() -> None:
    config = parse(THICK, "a.rviz")
    axes, pose, point, odometry = (each for each in config.displays)
    read = [axes.radius, pose.shaft_radius, pose.head_radius, point.radius]  # pyright: ignore[reportAttributeAccessIssue]
    assert read == [0.15, 0.035, 0.05, 0.1]
    assert odometry.shape.axes_radius == 0.01  # pyright: ignore[reportAttributeAccessIssue]
    rviz_text, _ = opening.text_of(config, "b.rviz")
    for line in ("Radius: 0.3\n", "Shaft Radius: 0.07\n", "Axes Radius: 0.02\n"):
        assert line in rviz_text
    again = parse(rviz_text, "b.rviz").displays
    assert [again[0].radius, again[3].shape] == [axes.radius, odometry.shape]  # pyright: ignore[reportAttributeAccessIssue]
