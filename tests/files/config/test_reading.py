"""Reading of config files: values arrive as written, and every mistake has its error."""

from __future__ import annotations

import contextlib
import io
import time
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from webviz.api.declared import to_values
from webviz.api.views import Orbit
from webviz.files.config import ConfigError, Unreadable, dump, standard
from webviz.files.config.model import STANDARD
from webviz.files.opening import load, parse
from webviz_displays.grid import Grid
from webviz_displays.laser_scan import LaserScan

WHOLE = """\
version: 1
fixed_frame: odom
background: [10, 20, 30]
frame_rate: 30.0
view: {distance: 4.0, yaw: 0.5, focal_point: [1.0, 2.0, 0.0]}
displays:
- {type: Grid, name: Floor, plane_cell_count: 20}
- type: LaserScan
  name: Front
  topic: {name: /front, reliability: reliable}
  size: 0.05
- {type: LaserScan, name: Rear, enabled: false, topic: /rear}
"""


def test_a_config_holds_the_values_of_its_file() -> None:
    config = parse(WHOLE, "x.yaml")
    assert config.settings.fixed_frame == "odom"
    assert config.settings.background == (10, 20, 30)
    assert config.settings.view == Orbit(distance=4.0, yaw=0.5, focal_point=(1.0, 2.0, 0.0))
    floor, front, rear = config.displays
    assert isinstance(floor, Grid)
    assert isinstance(front, LaserScan)
    assert isinstance(rear, LaserScan)
    assert to_values(floor) == {"name": "Floor", "plane_cell_count": 20}
    assert (front.topic.name, front.topic.reliability, front.size) == ("/front", "reliable", 0.05)
    assert (rear.topic.name, rear.enabled) == ("/rear", False)


def test_the_standard_config_shows_the_usual_topics() -> None:
    assert [type(d).__name__ for d in standard().displays] == list(STANDARD)


def test_lines_of_windows_and_its_mark_at_the_beginning_change_nothing(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_bytes(b"\xef\xbb\xbf" + WHOLE.replace("\n", "\r\n").encode())
    assert dump(load(path)) == dump(parse(WHOLE, "x.yaml"))


def test_numbers_have_all_spellings_of_yaml_and_words_stay_words() -> None:
    config = parse(
        "fixed_frame: on\ndisplays:\n"
        "- {type: LaserScan, name: 12:30:45, topic: no, size: 1e-1, size_pixels: 0x10}\n",
        "x.yaml",
    )
    scan = config.displays[0]
    assert isinstance(scan, LaserScan)
    assert (config.settings.fixed_frame, scan.name, scan.topic.name) == ("on", "12:30:45", "no")
    assert (scan.size, scan.size_pixels) == (0.1, 16.0)


def test_anchors_and_merge_keys_are_supported() -> None:
    config = parse(
        "displays:\n- &front {type: LaserScan, size: 0.05}\n- {<<: *front, name: Rear}\n", "x.yaml"
    )
    rear = config.displays[1]
    assert isinstance(rear, LaserScan)
    assert (rear.name, rear.size) == ("Rear", 0.05)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "x.yaml is empty: a config needs at least `version: 1`."),
        ("# nothing\n", "x.yaml is empty: a config needs at least `version: 1`."),
        ("just words", "x.yaml contains no settings such as `fixed_frame: map`."),
        ("Visualization Manager: {}", "x.yaml is RViz's config: its name must end with .rviz."),
        ("a: [", "x.yaml:1 is not valid YAML"),
        ("a:\n\t- b", "x.yaml:2 is not valid YAML: found a tab, expected spaces."),
        ("a: 1\n---\nb: 2", "x.yaml:2 is not valid YAML: but found another document."),
        ("fixed_frame: map\nfixed_frame: odom", "x.yaml:2 is not valid YAML: found duplicate key"),
        ("\nfixed_fram: map", "x.yaml:2: fixed_fram: unknown key, did you mean `fixed_frame`?"),
        ("display: []", "x.yaml:1: display: unknown key, did you mean `displays`?"),
        ("version: 99", "x.yaml has version 99, this webviz reads up to 1: update webviz."),
        ("version: one", "x.yaml:1: version: expected a whole number, got `one`."),
        ("background:\n- 0\n- 0\n- 256", "x.yaml:4: background[2]: expected <= 255, got 256."),
        ("background: red", "x.yaml:1: background: expected a list of 3 numbers, got `red`."),
        ("frame_rate: fast", "x.yaml:1: frame_rate: expected a number, got `fast`."),
        ("view: {\n pitch: 3}", "x.yaml:2: view.pitch: expected <= 1.5698, got 3."),
        ("view: {pich: 1}", "x.yaml:1: view.pich: unknown key, did you mean `pitch`?"),
        ("view: {type: Orbitt}", "x.yaml:1: view.type: expected Orbit, XYOrbit, "),
        ("displays: 5", "x.yaml:1: displays: expected a list, each entry with a `type`."),
        ("a: !!python/object:os.system {}", "x.yaml:1 is not valid YAML"),
        ("a: 2001-13-45", "x.yaml is not valid YAML: month must be in 1..12"),
        ("a: " + "[" * 100 + "]" * 100, "x.yaml is nested deeper than 64 levels."),
        ("a: " + "[" * 9999, "x.yaml is nested deeper than 64 levels."),
        ("a: &a [*a]", "x.yaml is nested deeper than 64 levels."),
    ],
)
def test_a_mistake_is_one_sentence_with_its_line_and_place(text: str, sentence: str) -> None:
    with pytest.raises(ConfigError) as excinfo:
        parse(text, "x.yaml")
    assert str(excinfo.value).startswith(sentence)
    assert "\n" not in str(excinfo.value)


@pytest.mark.parametrize(
    ("entry", "reason"),
    [
        ("{type: Lidar}", "displays[1].type: unknown display type `Lidar`, known are: "),
        ("{type: LaserScann}", "unknown display type `LaserScann`, did you mean `LaserScan`?"),
        ("{size: 1}", "displays[1]: a display needs a `type`"),
        ("just text", "displays[1]: a display needs a `type`"),
        ("{type: LaserScan, size: -1}", "x.yaml:3: displays[1].size: expected > 0, got -1."),
        ("{type: LaserScan,\n   size: 0}", "x.yaml:4: displays[1].size: expected > 0, got 0."),
        ("{type: LaserScan, size: .inf}", "displays[1].size: expected a finite number, got inf."),
        ("{type: LaserScan, size: big}", "displays[1].size: expected a number, got `big`."),
        ("{type: LaserScan, sise: 1}", "displays[1].sise: unknown key, did you mean `size`?"),
        ("{type: LaserScan, topic: 5}", "displays[1].topic: expected the name of a topic, got 5."),
        ("{type: LaserScan, topic: {depth: x}}", "topic.depth: expected a whole number, got `x`."),
        ("{type: LaserScan, topic: {dept: 1}}", "topic.dept: unknown key, did you mean `depth`?"),
        ("{type: LaserScan, style: Sqares}", "Boxes or Tiles, got `Sqares`."),
        ("{type: LaserScan, color: [1, 2]}", "color: expected 3 values, got [1, 2]."),
        ("{type: LaserScan, enabled: on}", "enabled: expected true or false, got `on`."),
        ("{type: Grid, plane_cell_count: 2.5}", "expected a whole number, got 2.5."),
        ("{type: TF, frames: {a b: 1}}", '.frames["a b"]: expected true or false, got 1.'),
        ("{type: TF, frames: {0: true}}", 'frames: expected text as keys, such as "0":'),
        ("{type: RobotModel, links: {b: {alpha: 2}}}", "links.b.alpha: expected <= 1, got 2."),
        ("{type: RobotModel, links: {b: {alfa: 2}}}", "links.b.alfa: unknown key, did you mean"),
        (
            "{type: Group, displays: [{type: Gird}]}",
            "[1].displays[0].type: unknown display type `Gird`",
        ),
        ("{type: Group, displays: 4}", "displays[1].displays: expected a list"),
    ],
)
def test_a_bad_display_keeps_its_text_and_harms_no_other(entry: str, reason: str) -> None:
    text = f"displays:\n- type: Grid\n- {entry}\n- type: TF\n"
    config = parse(text, "x.yaml")
    grid, bad, tf = config.displays
    assert (type(grid).__name__, type(tf).__name__) == ("Grid", "TF")
    bad = getattr(bad, "displays", [bad])[0]
    assert isinstance(bad, Unreadable)
    assert reason in bad.reason
    assert bad.reason.startswith("x.yaml:3: displays[1]" if "\n" not in entry else "x.yaml:4: ")
    again = parse(dump(config), "x.yaml").displays[1]
    again = getattr(again, "displays", [again])[0]
    assert isinstance(again, Unreadable)
    assert again.values == bad.values


def test_all_mistakes_of_a_display_are_reported() -> None:
    text = (
        "displays:\n- type: LaserScan\n  size: -1\n  sise: 1\n  topic: {depth: x}\n"
        "- {type: Group, enable: true, name: 5, displays: []}\n- type: Grid\n"
    ) + "".join(f"  x{i}: 1\n" for i in range(12))
    scan, group, grid = (getattr(each, "reason", "") for each in parse(text, "x.yaml").displays)
    assert scan == (
        "x.yaml:3: displays[0].size: expected > 0, got -1. "
        "x.yaml:4: displays[0].sise: unknown key, did you mean `size`? "
        "x.yaml:5: displays[0].topic.depth: expected a whole number, got `x`."
    )
    assert group == (
        "x.yaml:6: displays[1].enable: unknown key, did you mean `enabled`? "
        "x.yaml:6: displays[1].name: expected text, got 5."
    )
    assert grid.count("unknown key") == 10
    assert grid.endswith(" 2 more errors.")


def test_names_in_a_file_do_nothing_to_the_terminal() -> None:
    bad = parse('displays: [{type: Grid, color: "a\\e[2Jb\\nc"}]', "x.yaml").displays[0]
    assert isinstance(bad, Unreadable)
    assert bad.reason.isprintable()


def test_aliases_that_unfold_without_end_are_refused() -> None:
    bomb = "a: &a [x, x, x, x, x, x, x, x, x, x]\n"
    for name, before in zip("bcdefg", "abcdef", strict=True):
        bomb += f"{name}: &{name} [{', '.join([f'*{before}'] * 10)}]\n"
    with pytest.raises(ConfigError, match="contains more than 50000 values, including aliases"):
        parse(bomb, "x.yaml")


@pytest.mark.parametrize(
    "text",
    [
        "root:$6$hunter2:19000:0:99999:7:::\n",
        "root:*:hunter2:::\ndaemon:*:19000:0:99999:7:::\n",
        "user: hunter2\npassword: hunter2\n",
        "hunter2: {fixed_frame: hunter2}\n",
        "[default]\nkey = hunter2\n",
        "version: hunter2\nservices: {hunter2: 1}\n",
        "a: hunter2\na: hunter2\n",
        'a: "1"\n"hunter2": 1\n"hunter2": "hun\'ter2"\n',
        "a: *hunter2\n",
        "a: !hunter2 {}\n",
        "a: !hunter2!x {}\n",
        "a: hunter2: b\n",
        "a: 'hunter2\n",
        "%hunter2 'x'\n",
        "a: 0o8hunter2\nb: 2001-13-45\n",
        "- hunter2\n- hunter2: hunter2\n",
    ],
)
@pytest.mark.parametrize("name", ["x.yaml", "x.rviz"])
def test_a_file_that_is_not_a_config_is_not_quoted(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ConfigError) as excinfo:
        load(tmp_path / name)
    assert "hunter2" not in str(excinfo.value)


@pytest.mark.parametrize(
    "text",
    [
        "a: " + "[" * 200_000,
        "- " * 200_000,
        "displays: [" + "&a {type: Grid}," * 40_000,  # an anchor may be used again
    ],
)
def test_a_config_that_is_too_large_is_refused_before_all_of_it_is_read(text: str) -> None:
    # What comes later in the text is not even YAML.
    with pytest.raises(ConfigError, match=r"nested deeper than|contains more than 50000 values"):
        parse(text + "\n}", "x.yaml")


@pytest.mark.parametrize("number", ["0x" + "f" * 4000, "1" * 4000, "!!int '" + "1" * 4000 + "'"])
def test_numbers_that_cannot_be_written_are_refused(number: str) -> None:
    with pytest.raises(ConfigError, match=r"x\.yaml:2: a number has more than 1000 digits\.$"):
        parse(f"version: 1\ndisplays: [{{type: Nothing, x: {number}}}]\n", "x.yaml")


@pytest.mark.parametrize("key", ["? [a]", "2001-01-01", "!!binary aGk=", "~", "? {a: 1}"])
@pytest.mark.parametrize("place", ["fixed_frame", "watch", "displays", "view", "rviz"])
def test_keys_that_are_not_strings_are_refused_in_one_sentence(key: str, place: str) -> None:
    with pytest.raises(ConfigError) as error:
        parse(f"{place}: {{{key} : b}}", "x.yaml")
    assert str(error.value).startswith("x.yaml:1")


def test_words_that_aliases_repeat_count_each_time() -> None:
    words = ", ".join(["*a"] * 500)
    with pytest.raises(ConfigError, match="is larger than 4 MB, including aliases"):
        parse(f"a: &a {'word ' * 2000}\nb: [{words}]\n", "x.yaml")


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("x.yaml", "displays:\n- type: Group\n  displays:\n" + "  - {type: Grid}\n" * 500),
        (
            "x.rviz",
            "Visualization Manager:\n  Displays:\n  - Class: rviz_common/Group\n    Displays:\n"
            + "    - {Class: rviz_default_plugins/Grid}\n" * 500,
        ),
    ],
)
def test_five_hundred_displays_are_the_limit(tmp_path: Path, name: str, text: str) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(ConfigError, match="has 501 displays; the limit is 500"):
        load(tmp_path / name)


def test_hundreds_of_displays_open_within_a_second() -> None:
    lines = ["displays:"]
    for i in range(250):
        lines += [f"- type: LaserScan\n  name: Scan {i}\n  topic: /scan{i}\n  size: 0.0{i + 1}"]
    began = time.process_time()
    config = parse("\n".join([*lines, "- {type: Grid, cell_size: -1}"]), "x.yaml")
    assert time.process_time() - began < 1.0
    assert len(config.displays) == 251
    assert "x.yaml:1002: displays[250].cell_size" in getattr(config.displays[-1], "reason", "")


def test_a_display_that_is_not_installed_keeps_every_value() -> None:
    text = "version: 1\ndisplays:\n- type: Sonar\n  beams: [1, 2.5, null]\n"
    assert dump(parse(text, "x.yaml")) == text


@settings(deadline=None)
@given(st.text())
def test_any_text_is_a_config_or_one_sentence(text: str) -> None:
    with contextlib.suppress(ConfigError):
        parse(text, "x.yaml")


@settings(deadline=None)
@given(
    st.dictionaries(
        st.sampled_from(["fixed_frame", "version", "background", "view", "displays", "frame_rate"]),
        st.recursive(
            st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
            lambda inner: st.lists(inner) | st.dictionaries(st.text(), inner),
        ),
    )
)
def test_any_values_are_a_config_or_one_sentence(values: dict) -> None:
    stream = io.StringIO()
    YAML(typ="safe", pure=True).dump(values, stream)
    with contextlib.suppress(ConfigError):
        config = parse(stream.getvalue(), "x.yaml")
        assert dump(parse(dump(config), "x.yaml")) == dump(config)
