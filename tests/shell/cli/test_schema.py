"""The JSON Schema that is shipped says the same of config files as webviz itself."""

from __future__ import annotations

import io
import json
from pathlib import Path
from typing import Any

import msgspec
import pytest
from jsonschema import Draft7Validator
from ruamel.yaml import YAML
from rviz_files import FILES

from webviz.api import registry
from webviz.api.declared import make
from webviz.api.panel import Panel
from webviz.api.registry import display_types, plugin_types
from webviz.api.tool import Tool
from webviz.files import rviz
from webviz.files.config import Config, ConfigError, Unreadable, dump, standard
from webviz.files.config.schema import schema
from webviz.files.opening import parse
from webviz.shell.cli import main as cli
from webviz.shell.cli.demo import DEMO
from webviz.shell.cli.schema import COMMAND, SHIPPED, text

INSTALLED = display_types()
SCHEMA = schema(INSTALLED, plugin_types(Tool), plugin_types(Panel))
CHECK = Draft7Validator(SCHEMA)


def faults(config_text: str) -> list[str]:
    """Return the errors the schema reports for the text of a config."""
    values = json.loads(json.dumps(YAML(typ="safe", pure=True).load(io.StringIO(config_text))))
    return [f"{error.json_path}: {error.message}" for error in CHECK.iter_errors(values)]


def accepts(config_text: str) -> bool:
    """Return whether webviz has nothing against the text of a config."""
    try:
        config = parse(config_text, "x.yaml")
    except ConfigError:
        return False
    return not any(isinstance(item, Unreadable) for item in [*config.displays, *config.tools])


def test_the_shipped_schema_is_that_of_the_declarations() -> None:
    assert SHIPPED.read_text(encoding="utf-8") == text(), f"run {COMMAND}"


def test_it_is_a_schema() -> None:
    Draft7Validator.check_schema(SCHEMA)


def test_the_configs_that_come_with_webviz_are_valid() -> None:
    assert faults(dump(standard())) == []
    assert faults(DEMO.read_text()) == []
    assert faults("version: 1\ndisplays:\n") == []


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.stem)
def test_conversions_of_real_rviz_files_are_valid(path: Path) -> None:
    assert faults(dump(rviz.read(path.read_text(), path.name)[0])) == []


@pytest.mark.parametrize("name", INSTALLED)
def test_every_display_is_valid_with_its_defaults_written_out(name: str) -> None:
    display = make(INSTALLED[name], {})
    values = {"type": name, **msgspec.to_builtins(display)}
    assert faults(json.dumps({"displays": [values]})) == []
    assert faults(dump(Config(displays=[display]))) == []


@pytest.mark.parametrize(
    "config_text",
    [
        "tools:",
        "tools: [{type: GoalPose}]",
        "tools: [{type: GoalPose, name: Go, topic: {name: /goal, reliability: best_effort}}]",
    ],
)
def test_tools_that_webviz_accepts_are_valid(config_text: str) -> None:
    assert accepts(config_text)
    assert faults(config_text) == []


@pytest.mark.parametrize(
    "entry",
    [
        "{type: LaserScan, topic: /scan}",
        "{type: LaserScan, topic: {name: /scan, depth: 3}}",
        "{type: LaserScan, size: 1}",
        "{type: LaserScan, style: Boxes, color: [1, 2, 3]}",
        "{type: Group, displays: [{type: Grid}, {type: Group, displays: }]}",
        "{type: TF, frames: {a b: true}}",
        "{type: RobotModel, links: {base: {alpha: 0.5}}}",
    ],
)
def test_accepted_displays_are_valid(entry: str) -> None:
    config_text = f"displays: [{entry}]"
    assert accepts(config_text)
    assert faults(config_text) == []


@pytest.mark.parametrize(
    "config_text",
    [
        "colour: red",
        "version: 2",
        "frame_rate: 0",
        "background: [0, 0]",
        "background: [0, 0, 256]",
        "view: {distance: 0}",
        "displays: 5",
        "displays: [Grid]",
        "displays: [{size: 1}]",
        "displays: [{type: LaserScan, sise: 1}]",
        "displays: [{type: LaserScan, size: 0}]",
        "displays: [{type: LaserScan, size: small}]",
        "displays: [{type: LaserScan, alpha: 1.5}]",
        "displays: [{type: LaserScan, style: Sqares}]",
        "displays: [{type: LaserScan, topic: {depth: -1}}]",
        "displays: [{type: LaserScan, topic: {dept: 1}}]",
        "displays: [{type: LaserScan, enabled: 1}]",
        "displays: [{type: Grid, plane_cell_count: 2.5}]",
        "displays: [{type: Group, colour: 1}]",
        "displays: [{type: RobotModel, links: {base: {alpha: 2}}}]",
        "tools: 5",
        "tools: [GoalPose]",
        "tools: [{type: GoalPose, enabled: true}]",
    ],
)
def test_refused_displays_are_invalid(config_text: str) -> None:
    assert not accepts(config_text)
    assert len(faults(config_text)) == 1


def test_a_mistake_in_a_group_is_found() -> None:
    result = faults("displays: [{type: Group, displays: [{type: Grid}, {type: Grid, alpha: 2}]}]")
    assert result == ["$.displays[0].displays[1].alpha: 2 is greater than the maximum of 1"]


def test_displays_of_plug_ins_are_valid() -> None:
    assert faults("displays: [{type: Sonar, beams: [1, 2]}]") == []
    assert faults("displays: [{type: Grid, name: Mine, rviz: {Class: Grid, Odd: 1}}]") == []


def test_properties_are_described_with_unit_and_default() -> None:
    properties: Any = SCHEMA["definitions"]["LaserScan"]["properties"]
    assert properties["size"]["description"].endswith("In m.")
    assert properties["size"]["default"] == 0.01
    assert properties["size_pixels"]["description"].endswith('Where style is "Points".')
    assert properties["topic"]["default"] == "/scan"


def test_the_command_writes_it_with_displays_of_a_plugin(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    plugin, config_text = tmp_path / "beacon.py", tmp_path / "out.json"
    plugin.write_text(
        "from webviz import Display\n\n\n"
        'class Beacon(Display):\n    """A light."""\n\n    height: float = 2.0\n'
    )
    try:
        assert cli(["schema", "--plugin", str(plugin), "-o", str(config_text)]) == 0
        assert capsys.readouterr().out == f"webviz: wrote {config_text}\n"
        schema = json.loads(config_text.read_text())
        assert schema["definitions"]["Beacon"]["properties"]["height"]["default"] == 2.0
    finally:
        registry.register(str(plugin), {})
    assert cli(["schema"]) == 0
    assert capsys.readouterr().out == text()
    assert cli(["schema", "-o", str(tmp_path / "no folder" / "x")]) == 1
    assert "Cannot write" in capsys.readouterr().err
