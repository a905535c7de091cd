"""A .rviz file opens as RViz2 would open it."""

from __future__ import annotations

import textwrap
from typing import Any

import pytest

from webviz.api.declared import Topic, to_values
from webviz.api.display import Display
from webviz.files import rviz
from webviz.files.config import Branch, Config, ConfigError, Unreadable, dump
from webviz.files.opening import parse
from webviz_displays.autoware import PredictedObjects
from webviz_displays.laser_scan import LaserScan
from webviz_displays.map import Map
from webviz_displays.odometry import Odometry
from webviz_displays.robot_model import RobotModel
from webviz_displays.tf import TF


def read_config(displays: str = "", manager: str = "") -> tuple[Config, rviz.Report]:
    """A file with these displays and more of the manager's keys."""
    head = "Visualization Manager:\n"
    if displays:
        head += "  Displays:\n" + textwrap.indent(textwrap.dedent(displays), "    ")
    return rviz.read(head + textwrap.indent(textwrap.dedent(manager), "  ") or "", "x.rviz")


def one(text: str, cls: str = "LaserScan") -> Any:
    """The only display of a file, of a class and enabled."""
    lines = [f"- Class: rviz_default_plugins/{cls}", "  Enabled: true"]
    lines += ["  " + line for line in textwrap.dedent(text).strip().splitlines()]
    config, _ = read_config("\n".join(lines) + "\n")
    return config.displays[0]


def report_text(report: rviz.Report) -> str:
    return "\n".join(report.sentences())


def test_global_options_are_the_settings() -> None:
    config, _ = read_config(
        manager="""\
        Global Options:
          Background Color: 10; 20; 30
          Fixed Frame: /odom
          Frame Rate: 12
        """
    )
    settings = config.settings
    assert (settings.fixed_frame, settings.background) == ("odom", (10, 20, 30))
    assert settings.frame_rate == 12


def test_missing_values_have_the_defaults_of_rviz() -> None:
    config, _ = read_config(manager="Class: ''\n")
    assert (config.settings.fixed_frame, config.settings.frame_rate) == ("base_link", 30)
    assert one("Name: Scan").topic.name == ""


@pytest.mark.parametrize(
    ("keys", "enabled"),
    [
        ("", False),
        ("Value: true", True),
        ("Value: false", False),
        ("Enabled: true\n  Value: false", True),
        ("Enabled: false\n  Value: true", False),
        ("Enabled: 'True'", True),
        ("Enabled: maybe", False),
    ],
)
def test_enabled_counts_before_value_and_neither_is_off(keys: str, enabled: bool) -> None:
    config, _ = read_config(f"- Class: rviz_default_plugins/Grid\n  {keys}\n")
    grid: Any = config.displays[0]
    assert grid.enabled is enabled


def test_properties_have_rvizs_names_and_spellings() -> None:
    scan: LaserScan = one(
        """
        Name: Front
        Size (m): 0.029999999329447746
        Size (Pixels): 5
        Style: Spheres
        Color Transformer: FlatColor
        Color: 255; 0; 300
        Use rainbow: false
        Autocompute Value Bounds: {Value: false, Min Value: -2, Max Value: 2.5}
        """
    )
    assert (scan.name, scan.size, scan.size_pixels, scan.style) == ("Front", 0.03, 5.0, "Spheres")
    assert (scan.color, scan.use_rainbow) == ((255, 0, 255), False)
    bounds = scan.autocompute_value_bounds
    assert (bounds.value, bounds.min_value, bounds.max_value) == (False, -2.0, 2.5)


@pytest.mark.parametrize("color", ["0; 128; 0", "'#008000'", "green", "0;128;0"])
def test_colours_are_written_in_several_ways(color: str) -> None:
    assert one(f"Color: {color}").color == (0, 128, 0)


def test_nested_properties_have_their_own_value() -> None:
    odometry: Odometry = one(
        """
        Shape: {Value: Axes, Axes Length: 0.5}
        Covariance: {Value: true, Position: {Value: false, Scale: 3}}
        """,
        "Odometry",
    )
    assert (odometry.shape.value, odometry.shape.axes_length) == ("Axes", 0.5)
    assert odometry.shape.head_length == 0.3
    position = odometry.covariance.position
    assert (position.value, position.scale) == (False, 3.0)
    grid = one(
        "Line Style: {Value: Billboards, Line Width: 0.1}\nOffset: {X: 1, Y: 2, Z: 3}", "Grid"
    )
    assert (grid.line_style, grid.line_width, grid.offset) == ("Billboards", 0.1, (1.0, 2.0, 3.0))


def test_nested_properties_may_have_their_own_value_alone() -> None:
    config, report = read_config(
        "- {Class: rviz_default_plugins/Odometry, Name: Odometry, Shape: Axes, Covariance: false}\n"
    )
    odometry: Any = config.displays[0]
    assert (odometry.shape.value, odometry.covariance.value) == ("Axes", False)
    assert report_text(report) == ""


def test_frames_and_links_are_switched_by_name() -> None:
    tf: TF = one("Frames: {All Enabled: false, odom: {Value: true}, tb3/a b: {Value: false}}", "TF")
    assert (tf.all_enabled, tf.frames) == (False, {"odom": True, "tb3/a b": False})
    robot: RobotModel = one(
        """
        Links:
          All Links Enabled: true
          Expand Tree: false
          Link Tree Style: Links in Alphabetic Order
          base: {Alpha: 0.5, Show Axes: true, Show Trail: false}
          wheel: {Alpha: 1, Value: false}
        """,
        "RobotModel",
    )
    assert list(robot.links) == ["base", "wheel"]
    assert (robot.links["base"].enabled, robot.links["base"].alpha) == (True, 0.5)
    assert (robot.links["base"].show_axes, robot.links["wheel"].enabled) == (True, False)


def test_rvizs_default_qos_is_auto_and_all_else_a_choice() -> None:
    usual = one(
        """
        Topic:
          Value: /scan
          Depth: 5
          History Policy: Keep Last
          Reliability Policy: Reliable
          Durability Policy: Volatile
          Filter size: 10
        """
    )
    assert to_values(usual) == {}
    topic = one(
        """
        Topic:
          Value: /map
          Depth: 1
          Reliability Policy: Best Effort
          Durability Policy: Transient Local
          Filter size: 3
        """,
        "Map",
    ).topic
    assert (topic.reliability, topic.durability) == ("best_effort", "transient_local")
    assert (topic.depth, topic.filter_size) == (1, 3)


@pytest.mark.parametrize("durability", ["Volatile", "Transient Local"])
def test_a_description_is_always_latched(durability: str) -> None:
    text = f"Description Topic: {{Value: robot_description, Durability Policy: {durability}}}"
    robot: RobotModel = one(text, "RobotModel")
    assert robot.description_topic.name == "robot_description"
    assert robot.description_topic.durability == "auto"


def test_an_update_topic_that_follows_from_the_topic_is_left_to_follow() -> None:
    map: Map = one("Topic: {Value: /a}\nUpdate Topic: {Value: /a_updates}", "Map")
    assert map.update_topic.name == ""
    map = one("Topic: {Value: /a}\nUpdate Topic: {Value: /b_updates}", "Map")
    assert map.update_topic.name == "/b_updates"


def test_old_forms_are_understood() -> None:
    scan: LaserScan = one("Topic: /scan\nUnreliable: true\nQueue Size: 20")
    assert (scan.topic.name, scan.topic.reliability) == ("/scan", "best_effort")
    assert scan.topic.depth == 20
    assert one("Topic: /scan\nQueue Size: 10").topic.depth == 0
    config, report = read_config(
        """\
        - Class: rviz/LaserScan
          Name: Old
          Value: true
          Topic: /scan
        - Class: rviz/RobotModel
          Value: true
        - Class: rviz/Group
          Enabled: true
        """
    )
    old, robot, group = config.displays
    assert isinstance(old, LaserScan)
    assert isinstance(robot, RobotModel)
    assert robot.description_topic.name == "/robot_description"
    assert isinstance(group, Branch)
    assert "Old: rviz/LaserScan: ROS 1's class" in report_text(report)


def test_groups_nest() -> None:
    config, _ = read_config(
        """\
        - Class: rviz_common/Group
          Name: Outer
          Enabled: false
          Displays:
            - Class: rviz_common/Group
              Name: Inner
              Enabled: true
              Displays:
                - Class: rviz_default_plugins/Grid
                  Name: Floor
        """
    )
    outer = config.displays[0]
    assert isinstance(outer, Branch)
    inner = outer.displays[0]
    assert isinstance(inner, Branch)
    assert (outer.group.name, outer.group.enabled, inner.group.enabled) == ("Outer", False, True)
    assert [getattr(each, "name", "") for each in inner.displays] == ["Floor"]


def test_an_unknown_class_is_a_row_with_an_error_and_survives_the_config_file() -> None:
    config, report = read_config(
        "- {Class: my_plugins/Laser, Name: Mine, Enabled: true, Power: 007}\n"
    )
    config = parse(dump(config), "x.yaml")
    mine = config.displays[0]
    assert isinstance(mine, Unreadable)
    assert mine.name == "Mine"
    assert "Unsupported display class my_plugins/Laser." in mine.reason
    assert mine.values["rviz"]["Power"] == "007"
    assert "Mine: my_plugins/Laser: unsupported display class" in report_text(report)


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("Size (m): 0", "Size (m): 0 is out of range, clamped to 0.0001"),
        ("Size (m): wide", "Size (m): expected a number, got `wide`; using the default"),
        ("Size (m): .nan", "Size (m): expected a number, got `.nan`"),
        ("Style: Cones", "Style: expected Points, Squares, Flat Squares, Spheres"),
        ("Color: loud", "Color: expected a colour, got `loud`"),
        ("Use rainbow: [1]", "Use rainbow: it has no value"),
        ("Alpha: 7", "Alpha: 7 is out of range, clamped to 1"),
        ("Topic: {Value: /a, Depth: deep}", "Topic/Depth: expected a number, got `deep`"),
        ("Glow: true", "Glow: unsupported"),
    ],
)
def test_an_unusable_value_is_reported(text: str, what: str) -> None:
    _, report = read_config(f"- {{Class: rviz_default_plugins/LaserScan, Name: Scan, {text}}}\n")
    at_line = "Scan" if what.endswith("unsupported") else "Scan (line 3)"
    assert f"{at_line}: {what}" in report_text(report)


def test_the_last_of_duplicate_keys_counts() -> None:
    assert one("Alpha: 0.5\nAlpha: 0.25").alpha == 0.25


def test_panels_and_tools_of_ros_1_are_those_of_ros_2() -> None:
    _, report = rviz.read(
        "Panels: [{Class: rviz/Displays}, {Class: rviz/Views}]\n"
        "Visualization Manager: {Tools: [{Class: rviz/MoveCamera}]}\n",
        "x.rviz",
    )
    assert report_text(report) == ""
    assert (report.carried["panels"], report.carried["tools"]) == (2, 1)


def test_a_display_without_a_name_is_reported_with_its_line() -> None:
    _, report = read_config("- Class: my_plugins/Laser\n- Class: my_plugins/Laser\n")
    assert report_text(report).startswith("? (line 3), ? (line 4): my_plugins/Laser: unsupported")


def test_names_in_a_file_do_nothing_to_the_terminal() -> None:
    _, report = read_config('- {Class: x/Y, Name: "a\\e[2Jb\\nc"}\n')
    assert report_text(report).startswith("a [2Jb c: x/Y: ")


def test_an_unusable_value_is_reported_once() -> None:
    _, report = read_config("- {Class: rviz_default_plugins/LaserScan, Name: Scan, Style: Cones}\n")
    assert len(report.notes) == 1
    assert (report.carried["properties"], report.total["properties"]) == (0, 1)


def test_a_choice_that_rviz_has_not_made_yet_is_auto_or_the_default() -> None:
    assert one("Color Transformer: ''\nChannel Name: ''").channel_name == "intensity"
    assert one("Color Transformer: ''", "PointCloud2").color_transformer == "Auto"
    _, report = read_config("- {Class: rviz_default_plugins/LaserScan, Color Transformer: ''}\n")
    assert report_text(report) == ""


@pytest.mark.parametrize(
    ("cls", "key", "value"),
    [
        ("TwistStamped", "hide_small_values", True),
        ("AccelStamped", "hide_small_values", True),
        ("MarkerArray", "topic", Topic("visualization_marker_array")),
        ("Effort", "robot_description", Topic("/robot_description")),
        ("LaserScan", "selectable", True),
    ],
)
def test_a_missing_property_has_rvizs_default_where_that_differs(
    cls: str, key: str, value: object
) -> None:
    assert getattr(one("Name: A", cls), key) == value


def test_cloud_that_cannot_be_selected_stays_so() -> None:
    assert one("Selectable: false", "PointCloud2").selectable is False


def test_depth_cloud_as_rviz_writes_it_is_whole() -> None:
    text = """\
        - Class: rviz_default_plugins/DepthCloud
          Name: Depth
          Channel Name: intensity
          Color Image Topic: /rgb/image
          Color Transport Hint: compressed
          Depth Map Topic: /depth/image
          Depth Map Transport Hint: raw
          Queue Size: 2
          Reliability Policy: Best effort
          Topic Filter: true
        """
    config, report = read_config(text)
    cloud: Any = config.displays[0]
    assert report_text(report) == ""
    assert (cloud.topic.name, cloud.topic.depth) == ("/depth/image", 2)
    assert cloud.color_topic.name == "/rgb/image/compressed"
    assert cloud.channel_name == "z"
    assert (report.carried["properties"], report.total["properties"]) == (6, 6)


def test_policy_of_a_depth_cloud_is_that_of_its_images() -> None:
    text = "Depth Map Topic: /depth\nReliability Policy: Reliable"
    assert one(text, "DepthCloud").topic.reliability == "reliable"
    assert one("Depth Map Topic: /depth", "DepthCloud").topic.reliability == "auto"


def test_color_map_of_a_grid_map_in_ros_1_is_the_rainbow() -> None:
    text = "Use ColorMap: false, Invert ColorMap: true"
    config, report = read_config(
        f"- {{Class: grid_map_rviz_plugin/GridMap, {text}, ColorMap: default}}\n"
        f"- {{Class: grid_map_rviz_plugin/GridMap, Name: Other, {text}, ColorMap: viridis}}\n"
    )
    grid: Any = config.displays[0]
    assert (grid.use_rainbow, grid.invert_rainbow) == (False, True)
    assert report_text(report) == "Other: ColorMap: unsupported; kept for export."


def test_ros_1_topics_and_transports_are_those_of_one_input() -> None:
    config, report = read_config(
        """\
        - {Class: rviz/Camera, Image Topic: /image, Transport Hint: theora, Queue Size: 2}
        - {Class: rviz/RobotModel, Robot Description: arm}
        - {Class: rviz/InteractiveMarkers, Update Topic: /controls/update}
        """
    )
    displays: list[Any] = list(config.displays)
    camera, robot, markers = displays
    assert (camera.topic.name, camera.camera_info_topic) == ("/image/theora", Topic())
    assert robot.description_topic.name == "arm"
    assert markers.interactive_markers_namespace == "/controls"
    assert report.carried["properties"] == report.total["properties"]


@pytest.mark.parametrize(
    ("cls", "is_ignored"),
    [
        ("rviz/WrenchStamped", True),
        ("rviz_default_plugins/Wrench", True),
        ("rviz_default_plugins/Pose", False),
    ],
)
def test_keys_that_rviz2_ignores_are_not_reported(cls: str, is_ignored: bool) -> None:
    _, report = read_config(f"        - {{Class: {cls}, Hide Small Values: true}}\n")
    assert ("Hide Small Values" not in report_text(report)) is is_ignored
    assert report.is_complete is is_ignored


def test_keys_without_effect_are_not_reported() -> None:
    _, report = read_config(
        """\
        - Class: rviz_default_plugins/LaserScan
          Position Transformer: XYZ
          Selectable: true
        - Class: rviz_default_plugins/TF
          Tree: {map: {odom: {}}}
        - Class: rviz_default_plugins/RobotModel
          Link/Joint Tree: {base_link: {Details: {Show Axes: true}, Value: true}}
        - Class: rviz/LaserScan
          Channel Name: intensities
        """
    )
    assert [s for s in report.sentences() if "ROS 1's class" not in s] == []


def test_placeholders_are_names_like_others() -> None:
    assert one("Topic: {Value: <namespace>/scan}").topic.name == "<namespace>/scan"
    config, report = read_config(manager="Global Options: {Fixed Frame: [PLANNING_FRAME]}\n")
    assert config.settings.fixed_frame == "base_link"
    assert "Global Options: Fixed Frame: it has no value; using base_link" in report_text(report)


def test_unsupported_panels_and_tools_are_reported_once() -> None:
    _, report = rviz.read(
        textwrap.dedent(
            """\
            Panels:
              - {Class: rviz_common/Displays, Name: Displays}
              - {Class: rviz_common/Time, Name: Time}
              - {Class: rviz_common/Selection, Name: Selection}
              - {Class: rviz_common/Help, Name: Help}
              - {Class: my_package/Lamp, Name: Lamp}
            Visualization Manager:
              Tools:
                - Class: rviz_default_plugins/MoveCamera
                - Class: my_package/Brush
                - Class: rviz_default_plugins/Select
                - Class: rviz_default_plugins/Other
            """
        ),
        "x.rviz",
    )
    sentences = report_text(report)
    assert sentences == (
        "Panels and tools: my_package/Lamp, my_package/Brush, Other: unsupported; kept for export."
    )


def test_autowares_objects_from_before_the_groups_are_read_and_come_back() -> None:
    text = textwrap.dedent(
        """\
        Visualization Manager:
          Displays:
            - Class: autoware_perception_rviz_plugin/PredictedObjects
              CAR: {Alpha: 0.5, Color: 1; 2; 3}
              BUS: {Alpha: 0.5, Color: 4; 5; 6}
              Confidence Interval: 70%
              Display Label: false
              Display Predicted Paths: false
              Display Yaw Rate Covariance: true
              Line Width: 0.1
              Namespaces: {label: true}
              Object Fill Type: skeleton
              Polygon Type: 2d
              Visualization Type: Simple
        """
    )
    config, report = rviz.read(text, "x.rviz")
    again, _ = rviz.write(config)
    assert report.is_complete
    for each in (text, again):
        (display,) = rviz.read(each, "x.rviz")[0].displays
        assert isinstance(display, PredictedObjects)
        colors = display.per_class_color
        assert (colors.value, colors.car, colors.bus) == (True, (1, 2, 3), (4, 5, 6))
        assert (display.alpha, display.shape.shape_type) == (0.5, "Skeleton 2D")
        assert (display.text.label, display.text.uuid) == (False, True)
        assert (display.path.predicted_path, display.path.path_resolution) == (False, "Simple")
        assert (display.covariance.yaw_rate, display.covariance.confidence_interval) == (
            True,
            "70%",
        )


def test_the_tool_of_rviz_visual_tools_keys_opens_its_panel_and_stays_a_tool() -> None:
    text = "Visualization Manager: {Tools: [{Class: rviz_visual_tools/KeyTool}]}"
    config, report = rviz.read(text, "x.rviz")
    assert report.is_complete
    assert [type(each).__name__ for each in config.panels].count("RvizVisualToolsGui") == 1
    again, _ = rviz.write(config)
    assert "KeyTool" in again
    assert "RvizVisualToolsGui" not in again


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "x.rviz is not an RViz config: it has no `Visualization Manager`."),
        ("fixed_frame: map", "x.rviz is not an RViz config: it has no `Visualization Manager`."),
        ("a: [", "x.rviz:1 is not valid YAML"),
        ("[" * 200, "x.rviz"),
        ("a: &a [*a]", "x.rviz is nested deeper than 64 levels."),
        ("? [a]\n: 1", "x.rviz: a key is not a plain word."),
    ],
)
def test_an_invalid_rviz_file_is_refused_in_one_sentence(text: str, sentence: str) -> None:
    with pytest.raises(ConfigError) as excinfo:
        rviz.read(text, "x.rviz")
    assert str(excinfo.value).startswith(sentence)
    assert "\n" not in str(excinfo.value)


def test_a_few_lines_that_unfold_without_end_are_refused() -> None:
    bomb = "a: &a [x, x, x, x, x, x, x, x, x, x]\n"
    for name, before in zip("bcdefg", "abcdef", strict=True):
        bomb += f"{name}: &{name} [{', '.join([f'*{before}'] * 10)}]\n"
    with pytest.raises(ConfigError, match="contains more than 50000 values"):
        rviz.read(bomb, "x.rviz")


PLAIN = """\
- Class: rviz_default_plugins/Temperature
  Enabled: true
  Name: Motor
  Autocompute Intensity Bounds: false
  Autocompute Value Bounds: {Max Value: 10, Min Value: -10, Value: true}
  Axis: Z
  Channel Name: temperature
  Color: 255; 255; 255
  Color Transformer: Intensity
  Invert Rainbow: false
  Max Intensity: 80
  Size (m): 0.5
  Topic: {Value: /motor, Reliability Policy: Best Effort}
  Use Fixed Frame: true
- Class: rviz_default_plugins/TwistStamped
  Enabled: true
  Name: Speed
  Angular Arrow Scale: 3
  Arrow Width: 0.25
  Hide Small Values: true
  History Length: 2
  Linear Color: 1; 2; 3
- Class: rviz_default_plugins/Wrench
  Enabled: true
  Name: Wrist
  Accept NaN Values: true
  Force Arrow Scale: 0.5
- Class: rviz_default_plugins/PoseWithCovariance
  Enabled: true
  Name: Amcl
  Shape: Axes
  Axes Length: 0.5
  Covariance: {Value: true, Position: {Value: false}}
- Class: nav2_rviz_plugins/ParticleCloud
  Enabled: true
  Name: Particles
  Shape: Arrow (3D)
  Max Arrow Length: 0.5
- Class: rviz_default_plugins/Effort
  Enabled: true
  Name: Arm
  Joints: {elbow: {Value: false}, wrist: {Value: true}}
  Robot Description: /arm/robot_description
  TF Prefix: arm
"""


def values_by_name(text: str) -> dict[str, Any]:
    """The values of the displays of a file about which nothing is reported."""
    config, report = read_config(text)
    assert report_text(report) == ""
    displays = [item for item in config.displays if isinstance(item, Display)]
    return {
        display.name: {key: value for key, value in to_values(display).items() if key != "name"}
        for display in displays
    }


def test_the_plain_displays_have_rvizs_names_and_report_nothing() -> None:
    values = values_by_name(PLAIN)
    motor = {"invert_rainbow": False, "max_intensity": 80.0, "size": 0.5}
    assert values["Motor"] == motor | {"topic": {"name": "/motor", "reliability": "best_effort"}}
    assert values["Speed"] == {
        "topic": "",
        "angular_arrow_scale": 3.0,
        "arrow_width": 0.25,
        "hide_small_values": True,
        "history_length": 2,
        "linear_color": (1, 2, 3),
    }
    assert values["Wrist"] == {"topic": "", "accept_nan_values": True, "force_arrow_scale": 0.5}
    halves = {"axes_radius": 0.05, "head_radius": 0.05, "shaft_radius": 0.025}
    amcl = {"topic": "", "shape": "Axes", "axes_length": 0.5, **halves}
    assert values["Amcl"] == amcl | {"covariance": {"position": {"value": False}}}
    particles = {"topic": "", "shape": "Arrow (3D)", "max_arrow_length": 0.5}
    assert values["Particles"] == particles
    assert values["Arm"] == {
        "topic": "",
        "joints": {"elbow": False, "wrist": True},
        "robot_description": "/arm/robot_description",
        "tf_prefix": "arm",
    }


MAPPING = """\
- Class: octomap_rviz_plugins/OccupancyGrid
  Enabled: true
  Name: Voxels
  Max. Height Display: inf
  Max. Octree Depth: 14
  Min. Height Display: -.inf
  Topic: {Value: /octomap_full, Depth: 5}
  Value: true
  Voxel Alpha: 0.5
  Voxel Coloring: Cell Probability
  Voxel Rendering: All Voxels
- Class: grid_map_rviz_plugin/GridMap
  Alpha: 1
  Autocompute Intensity Bounds: true
  Color: 200; 200; 200
  Color Layer: variance
  Color Transformer: GridMapLayer
  Enabled: true
  Height Layer: elevation
  Height Transformer: ""
  History Length: 1
  Invert Rainbow: true
  Name: Terrain
  Show Grid Lines: false
  Topic: {Value: /map_3d}
  Use Rainbow: true
- Class: rviz_imu_plugin/Imu
  Acceleration properties: {Acc. vector scale: 0.5, Enable acceleration: true}
  Axes properties: {Axes scale: 1, Enable axes: false}
  Box properties: {Box alpha: 1, Box color: 255; 0; 0, Enable box: false, x_scale: 2}
  Enabled: true
  Name: Sensor
  fixed_frame_orientation: false
- Class: rviz_imu_plugin/Mag
  2D-visual: false
  Enabled: true
  Name: Compass
  Scale: 2
"""


def test_the_displays_of_maps_have_rvizs_names_and_report_nothing() -> None:
    """Infinite heights and transformers that the plug-in itself does not offer are defaults."""
    values = values_by_name(MAPPING)
    voxels = {"voxel_alpha": 0.5, "max_octree_depth": 14, "voxel_rendering": "All Voxels"}
    assert values["Voxels"] == voxels | {"voxel_coloring": "Cell Probability"}
    terrain = {"invert_rainbow": True, "show_grid_lines": False, "color_layer": "variance"}
    assert values["Terrain"] == terrain | {"topic": "/map_3d"}
    acceleration = {"enable_acceleration": True, "acc_vector_scale": 0.5}
    assert values["Sensor"] == {
        "topic": "",
        "fixed_frame_orientation": False,
        "acceleration_properties": acceleration,
        "axes_properties": {"enable_axes": False},
        "box_properties": {"x_scale": 2.0},
    }
    assert values["Compass"] == {"topic": "", "is_2d": False, "scale": 2.0}


def test_switches_of_a_depth_cloud_have_their_values_below_them() -> None:
    cloud = one(
        """
        Auto Size: {Auto Size Factor: 2.5, Value: true}
        Occlusion Compensation: {Occlusion Time-Out: 12, Value: true}
        """,
        "DepthCloud",
    )
    assert (cloud.auto_size, cloud.auto_size_factor) == (True, 2.5)
    assert (cloud.occlusion_compensation, cloud.occlusion_time_out) == (True, 12.0)
