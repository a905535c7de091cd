"""The config file: what it says comes back, and every mistake has its answer."""

from __future__ import annotations

import contextlib
import io
import stat
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from ruamel.yaml import YAML

from webviz import config as config_file
from webviz.config import Config, ConfigError, Unreadable, dump, load, parse, save
from webviz.display import to_values
from webviz.registry import display_types
from webviz.views import View
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


def test_what_a_file_says_is_what_the_config_holds() -> None:
    config = parse(WHOLE, "x.yaml")
    assert config.settings.fixed_frame == "odom"
    assert config.settings.background == (10, 20, 30)
    assert config.settings.view == View(distance=4.0, yaw=0.5, focal_point=(1.0, 2.0, 0.0))
    floor, front, rear = config.displays
    assert isinstance(floor, Grid)
    assert isinstance(front, LaserScan)
    assert isinstance(rear, LaserScan)
    assert to_values(floor) == {"name": "Floor", "plane_cell_count": 20}
    assert (front.topic.name, front.topic.reliability, front.size) == ("/front", "reliable", 0.05)
    assert (rear.topic.name, rear.enabled) == ("/rear", False)


def test_a_config_comes_back_from_its_file_exactly(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    save(parse(WHOLE, "x.yaml"), path)
    first = path.read_text()
    save(load(path), path)
    assert path.read_text() == first
    assert "size: 0.05" in first


def test_defaults_are_left_out() -> None:
    assert dump(Config()) == "version: 1\ndisplays: []\n"


def test_the_standard_config_shows_the_usual_topics() -> None:
    displays = config_file.standard().displays
    assert [type(d).__name__ for d in displays] == list(config_file.STANDARD)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "x.yaml holds no settings such as `fixed_frame: map`."),
        ("just words", "x.yaml holds no settings such as `fixed_frame: map`."),
        ("a: [", "x.yaml:1 is not valid YAML"),
        ("fixed_frame: map\nfixed_frame: odom", "x.yaml:2 is not valid YAML: found duplicate key"),
        ("fixed_fram: map", "x.yaml: unknown key `fixed_fram`, did you mean `fixed_frame`?"),
        ("version: 99", "x.yaml has version 99, this webviz reads up to 1: update webviz."),
        ("background: [0, 0, 256]", "x.yaml: background[2]: expected `int` <= 255."),
        ("frame_rate: fast", "x.yaml: frame_rate: expected `float`, got `str`."),
        ("view: {pitch: 3}", "x.yaml: view.pitch: expected `float` <= 1.5698."),
        ("displays: 5", "x.yaml: displays: expected a list"),
        ("a: !!python/object:os.system {}", "x.yaml:1 is not valid YAML"),
    ],
)
def test_a_mistake_is_one_sentence_with_its_place(text: str, sentence: str) -> None:
    with pytest.raises(ConfigError) as caught:
        parse(text, "x.yaml")
    assert str(caught.value).startswith(sentence)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("entry", "reason"),
    [
        ("{type: Lidar}", "displays[1]: no display type `Lidar` here"),
        ("{type: LaserScann}", "did you mean `LaserScan`?"),
        ("{size: 1}", "displays[1]: a display needs a `type`"),
        ("just text", "displays[1]: a display needs a `type`"),
        ("{type: LaserScan, size: -1}", "displays[1].size: expected `float`"),
        ("{type: LaserScan, size: .inf}", "displays[1].size: expected a finite number"),
        ("{type: LaserScan, sise: 1}", "unknown key `sise`, did you mean `size`?"),
        ("{type: LaserScan, topic: {depth: x}}", "displays[1].topic.depth: expected `int`"),
    ],
)
def test_a_bad_display_keeps_its_text_and_harms_no_other(entry: str, reason: str) -> None:
    text = f"displays:\n- type: Grid\n- {entry}\n- type: TF\n"
    config = parse(text, "x.yaml")
    grid, bad, tf = config.displays
    assert (type(grid).__name__, type(tf).__name__) == ("Grid", "TF")
    assert isinstance(bad, Unreadable)
    assert reason in bad.reason
    again = parse(dump(config), "x.yaml").displays[1]
    assert isinstance(again, Unreadable)
    assert again.values == bad.values


def test_a_missing_file_is_an_error_that_names_it(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"Cannot read .*none\.yaml: No such file"):
        load(tmp_path / "none.yaml")


def test_bytes_that_are_no_text_are_an_error(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match="is not UTF-8 text"):
        load(path)


def test_a_failed_save_leaves_the_old_file(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="Cannot write"):
        save(Config(), tmp_path / "no such folder" / "x.yaml")
    path = tmp_path / "x.yaml"
    path.mkdir()
    with pytest.raises(ConfigError, match="Cannot write"):
        save(Config(), path)
    assert stat.S_ISDIR(path.stat().st_mode)
    assert list(tmp_path.iterdir()) == [path]


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
    with contextlib.suppress(ConfigError):
        config = parse(_yaml(values), "x.yaml")
        assert dump(parse(dump(config), "x.yaml")) == dump(config)


def _yaml(values: dict) -> str:
    stream = io.StringIO()
    YAML(typ="safe", pure=True).dump(values, stream)
    return stream.getvalue()


def test_every_type_can_be_made_from_nothing_and_saved() -> None:
    for name in display_types():
        config = parse(f"displays: [{{type: {name}}}]", "x.yaml")
        assert dump(config) == f"version: 1\ndisplays:\n- {{type: {name}}}\n"
