"""`--set`: values given besides the config file."""

from __future__ import annotations

from typing import Any

import pytest

from webviz.api.registry import display_types
from webviz.files import rviz
from webviz.files.config import Branch, Config, ConfigError, Unreadable, document, dump, standard
from webviz.files.config.overrides import override
from webviz.files.opening import parse

TEXT = """\
fixed_frame: map
view: {distance: 4.0, yaw: 0.5}
displays:
- {type: Grid, name: Floor}
- {type: LaserScan, name: Scan, topic: {name: /scan, reliability: reliable}}
- type: Group
  name: Sensors
  displays:
  - {type: LaserScan, name: Front}
  - {type: LaserScan, name: Rear}
  - {type: TF, name: my.tf, frames: {a.b: true}}
- {type: LaserScan, name: Twin}
- {type: LaserScan, name: Twin}
- {type: LaserScan, name: Bad, size: -1}
- {type: Sonar, name: Strange}
- {type: Grid, name: 0}
- {type: Grid, name: enabled}
tools:
- {type: GoalPose}
- {type: GoalPose, name: Bad, topic: 5}
"""


@pytest.fixture
def config() -> Config:
    return parse(TEXT.replace("name: 0", "name: '0'"), "lab.yaml")


def changed(config: Config, *assignments: str) -> Any:
    """Return the text of a file with these values, given by path."""
    before = dump(config)
    values = document(override(config, assignments))
    assert dump(config) == before, "the config itself must stay"
    return values


@pytest.mark.parametrize(
    ("assignment", "path", "value"),
    [
        ("fixed_frame=odom", ("fixed_frame",), "odom"),
        ("background=[0, 0, 0]", ("background",), (0, 0, 0)),
        ("background=[48, 9, 48]", ("background",), (48, 9, 48)),
        ("frame_rate=10", ("frame_rate",), 10.0),
        ("view.distance=5", ("view", "distance"), 5.0),
        ("view={distance: 5}", ("view", "yaw"), 0.5),
        ("displays.Scan.size=0.1", ("displays", 1, "size"), 0.1),
        ('tools."2D Goal Pose".topic=/go', ("tools", 0, "topic"), "/go"),
        ("tools[0].topic.depth=1", ("tools", 0, "topic", "depth"), 1),
        ("tools.Bad.topic=/go", ("tools", 1, "topic"), "/go"),
        ("displays.1.size=0.1", ("displays", 1, "size"), 0.1),
        ("displays[1].size=1e-1", ("displays", 1, "size"), 0.1),
        ("displays.Scan.color=[255, 0, 0]", ("displays", 1, "color"), (255, 0, 0)),
        ("displays.Scan.color[0]=1", ("displays", 1, "color"), (1, 255, 255)),
        ("displays.Scan.topic=/front", ("displays", 1, "topic", "reliability"), "reliable"),
        ("displays.Scan.topic.depth=3", ("displays", 1, "topic", "depth"), 3),
        ("displays.Scan.name=a = b.c", None, "a = b.c"),
        ("displays.Sensors.enabled=false", ("displays", 2, "enabled"), False),
        ("displays.Sensors.Front.size=0.1", ("displays", 2, "displays", 0, "size"), 0.1),
        ("displays[2].displays[1].size=0.1", ("displays", 2, "displays", 1, "size"), 0.1),
        ('displays.Sensors."my.tf".show_names=true', ("displays", 2, "displays", 2), None),
        ('displays[2][2].frames["a.b"]=false', ("displays", 2, "displays", 2, "frames"), None),
        ("displays[4].size=0.1", ("displays", 4, "size"), 0.1),
        ("displays.Bad.size=0.1", ("displays", 5, "size"), 0.1),
        ("displays.0.enabled=false", ("displays", 7, "enabled"), False),
        ("displays.enabled.enabled=false", ("displays", 8, "enabled"), False),
    ],
)
def test_a_value_is_set_where_its_path_leads(
    config: Config, assignment: str, path: tuple[str | int, ...] | None, value: Any
) -> None:
    values: Any = changed(config, assignment)
    for step in path or ("displays", 1, "name"):
        values = values[step]
    if value is not None:
        assert values == value


def test_names_with_dots_are_quoted(config: Config) -> None:
    values = changed(config, 'displays.Sensors."my.tf".frames."a.b"=false')
    assert values["displays"][2]["displays"][2]["frames"] == {"a.b": False}


def test_a_later_value_wins_and_nothing_else_changes(config: Config) -> None:
    values = changed(config, "displays.Scan.size=0.1", "displays.Scan.size=0.2")
    assert values["displays"][1].pop("size") == 0.2
    assert values == document(config)


def test_a_value_can_make_a_display_readable(config: Config) -> None:
    assert isinstance(config.displays[5], Unreadable)
    after = override(config, ["displays.Bad.size=0.1"]).displays[5]
    assert isinstance(after, display_types()["LaserScan"])


@pytest.mark.parametrize(
    ("assignment", "reason"),
    [
        ("displays.Scan.size=-1", "expected > 0, got -1."),
        ("displays.Scan.size=big", "expected a number, got `big`."),
        ("displays.Scan.color=[1, 2, 300]", "[2]: expected <= 255, got 300."),
        ("displays.Scan.sise=1", "unknown key, did you mean `size`?"),
        ("displays.Scan.topic.dept=1", "unknown key, did you mean `depth`?"),
        (
            "displays.Scan.style=Sqares",
            "expected Points, Squares, Flat Squares, Spheres, Boxes or Tiles, got `Sqares`.",
        ),
        ("displays.Scn.size=1", "no display `Scn`, did you mean `Scan`?"),
        ("displays.Front.size=1", "no display `Front` here, did you mean displays.Sensors.Front?"),
        ("displays.Sensors.Fron.size=1", "no display `Fron`, did you mean `Front`?"),
        ("displays.Sensors.enable=1", "no display `enable`, known are: Front, Rear, my.tf."),
        ("displays.99.size=1", "no display `99`, known are: 0, Bad, Floor, "),
        ("displays.Twin.size=1", "`Twin` names several displays, use displays[3] or displays[4]."),
        (
            "displays.Bad.sise=1",
            "size: expected > 0, got -1. sise: unknown key, did you mean `size`?",
        ),
        ("displays.Bad.color=red", "size: expected > 0, got -1."),
        ("displays.Strange.x=1", "type: unknown display type `Sonar`, known are: "),
        ("displays.Scan=1", "write it as displays.Scan.size=0.1 or view.distance=5."),
        ("displays=[]", "write it as "),
        ("fixed_fram=map", "unknown key, did you mean `fixed_frame`?"),
        ("version=2", "unknown key, known are: background, bookmarks, displays, "),
        ("view.distance=-1", "expected > 0, got -1."),
        ("view.distanc=1", "unknown key, did you mean `distance`?"),
        (
            "view.type=Orbitt",
            "expected Orbit, XYOrbit, ThirdPersonFollower, FPS, FrameAligned or TopDownOrtho, "
            "got `Orbitt`.",
        ),
        ("fixed_frame", "write it as "),
        ("=1", "write it as "),
        ("", "write it as "),
    ],
)
def test_invalid_assignments_are_refused_in_one_sentence(
    config: Config, assignment: str, reason: str
) -> None:
    with pytest.raises(ConfigError) as excinfo:
        override(config, [assignment])
    assert str(excinfo.value).startswith(f"--set {assignment}: {reason}")
    assert "\n" not in str(excinfo.value)


def test_a_value_that_is_not_yaml_is_refused_in_one_sentence(config: Config) -> None:
    with pytest.raises(ConfigError, match=r"^--set view=\[:1 is not valid YAML: "):
        override(config, ["view=["])


def test_values_can_be_set_in_a_config_of_rviz() -> None:
    text = (
        "Visualization Manager:\n  Displays:\n"
        "    - {Class: rviz_default_plugins/Grid, Name: Floor, Cell Count: 3}\n"
        "    - {Class: x/Laser, Name: Mine}\n"
    )
    config = override(rviz.read(text, "x.rviz")[0], ["displays.Floor.plane_cell_count=20"])
    assert document(config)["displays"][0]["plane_cell_count"] == 20
    with pytest.raises(ConfigError, match=r"Mine\.x=1: this display is not shown: .*x/Laser"):
        override(config, ["displays.Mine.x=1"])


def test_every_display_of_the_standard_config_can_be_switched_off() -> None:
    config = standard()
    names = [item.name for item in config.displays if not isinstance(item, Branch)]
    values = changed(config, *(f"displays.{name}.enabled=false" for name in names))
    assert all(entry["enabled"] is False for entry in values["displays"])
