"""`webviz convert`, and how the viewer tells what an import left out."""

from __future__ import annotations

from pathlib import Path

import pytest
from bench import HandFedSource
from rviz_trees import differences, texts

from webviz.engine.loop import FrameLoop
from webviz.files import config as config_file
from webviz.files import opening
from webviz.shell.cli import main as cli
from webviz.shell.testing.recording import RecordingScene

SMALL = """\
Visualization Manager:
  Displays:
    - Class: rviz_default_plugins/Grid
      Name: Floor
      Value: true
      Cell Size: 0.5
    - Class: my_plugins/Laser
      Name: Mine
  Tools:
    - Class: rviz_default_plugins/Select
    - Class: my_plugins/Brush
"""


@pytest.fixture
def small(tmp_path: Path) -> Path:
    path = tmp_path / "small.rviz"
    path.write_text(SMALL)
    return path


def convert(*arguments: object) -> int:
    return cli(["convert", *map(str, arguments)])


def test_a_file_goes_to_yaml_and_back(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    yaml, back = tmp_path / "a.yaml", tmp_path / "b.rviz"
    assert convert(small, yaml) == 0
    printed = capsys.readouterr()
    assert "Mine: my_plugins/Laser: unsupported display class" in printed.err
    assert printed.out == f"webviz: wrote {yaml}\n"
    assert "- {type: Grid, cell_size: 0.5, name: Floor}" in yaml.read_text()
    assert convert(yaml, back) == 0
    assert list(differences(texts(SMALL), texts(back.read_text()))) == []


def test_a_report_counts_converted_parts(small: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert convert("--report", small) == 0
    lines = [line.split() for line in capsys.readouterr().out.splitlines()]
    assert ["displays", "1", "of", "2", "50", "%"] in lines
    assert ["tools", "1", "of", "2", "50", "%"] in lines


def test_several_files_are_checked_at_once(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    whole, bad = tmp_path / "whole.rviz", tmp_path / "bad.rviz"
    whole.write_text("Visualization Manager:\n  Displays: []\n")
    bad.write_text("a: 1")
    assert convert("--check", small, whole) == 0
    printed = capsys.readouterr().out
    assert f"{small}: 1 of 2 displays, 1 of 2 tools\n  Mine: my_plugins/Laser" in printed
    assert f"{whole}: complete\n" in printed
    assert "Complete: 1 of 2 files, 50 %\n" in printed
    assert convert("--check", bad, small) == 1
    printed = capsys.readouterr()
    assert f"{bad}: {bad} is not an RViz config" in printed.out
    assert f"{small}: 1 of 2 displays" in printed.out
    assert "1 of 2 files cannot be read." in printed.err
    assert convert("--check", tmp_path / "a.yaml") == 2
    assert "--check needs .rviz files" in capsys.readouterr().err
    assert convert(small, whole, bad) == 2
    assert "--check for several files" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("panels", "manager", "missing"),
    [
        ("rviz_common/Displays", "Displays: []", ""),
        ("my_plugins/Lamp", "Displays: []", "0 of 1 panels"),
        ("rviz_common/Help", "Displays: [{Class: a/B}]", "0 of 1 displays"),
        ("rviz_common/Time", "Tools: [{Class: a/B}]", "0 of 1 tools"),
        ("rviz_common/Views", "Views: {Current: {Class: a/B}}", "0 of 1 views"),
        ("rviz/Help", "Transformation: {Current: {Class: a/B}}", "0 of 1 properties"),
    ],
)
def test_a_file_is_complete_if_all_of_it_is_supported(
    panels: str, manager: str, missing: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.rviz"
    path.write_text(f"Panels: [{{Class: {panels}}}]\nVisualization Manager: {{{manager}}}\n")
    assert convert("--check", path) == 0
    assert capsys.readouterr().out.splitlines()[0] == f"{path}: {missing or 'complete'}"


def test_mistakes_are_one_sentence(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert convert(small, small) == 1
    assert "SOURCE and TARGET are both" in capsys.readouterr().err
    assert convert(tmp_path / "none.rviz", tmp_path / "a.yaml") == 1
    assert "No such file or directory." in capsys.readouterr().err
    (tmp_path / "bad.rviz").write_text("a: 1")
    assert convert(tmp_path / "bad.rviz", tmp_path / "a.yaml") == 1
    assert "is not an RViz config: it has no `Visualization Manager`." in capsys.readouterr().err
    assert convert(small, tmp_path / "no folder" / "a.yaml") == 1
    assert "Cannot write" in capsys.readouterr().err


def test_a_command_without_a_target_names_the_missing_argument(
    small: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert convert(small) == 2
    assert "Missing TARGET. Give the file to write, or --report." in capsys.readouterr().err
    assert convert("--report", tmp_path / "a.yaml") == 2
    assert "--report needs a .rviz file" in capsys.readouterr().err


def test_the_viewer_shows_the_unsupported_parts_of_an_import(small: Path) -> None:
    viewer = FrameLoop(opening.load(small), HandFedSource(), RecordingScene())
    viewer.turn()
    status = viewer.statuses["Import"]
    assert (status.level.name, "my_plugins/Laser" in status.text) == ("WARN", True)
    assert [(row.name, row.level.name) for row in viewer.state().rows][1] == ("Mine", "ERROR")
    # Saving keeps what the import could not use.
    assert "my_plugins/Laser" in config_file.dump(viewer.config())
    assert "my_plugins/Brush" in config_file.dump(viewer.config())
    viewer.close()
