"""Commands, configs and programs in the documentation are valid.

`tests/e2e/test_docs.py` runs the commands and programs.
"""

from __future__ import annotations

import ast
import importlib.util
import os
import re
import subprocess
import tomllib
from pathlib import Path

import pytest
from doc_blocks import CONFIG, ROOT, Block, blocks
from PIL import Image

from webviz.files import opening
from webviz.shell.cli.commands import app, split_ros_arguments, with_openers
from webviz.shell.cli.options import ConfigOptions
from webviz_sim.world import load_world

NEEDS = {
    "With an apt ROS 2": r"\bros2 |/opt/ros/",
    "With the network": r"\b(pip|pipx|uvx) ",
    "With another machine": r"\bssh|ROS_(AUTOMATIC|STATIC|DISCOVERY)|fastdds discovery",
    "With Podman": r"\bpodman ",
    "With a public bag": r"--bag macfirst",
    "Takes minutes": r"\bmake |/python ",
}
"""Titles of blocks of commands that tests do not run, and what such a block contains."""


def commands(program: str) -> list[tuple[str, tuple[str, ...]]]:
    """Place and arguments of each command of a program."""
    return [
        (str(block), words[1:])
        for block in blocks("sh")
        for words in block.commands()
        if Path(words[0]).name == program
    ]


@pytest.mark.parametrize("block", [b for b in blocks("sh") if b.title], ids=str)
def test_a_block_that_is_not_run_states_its_requirements(block: Block) -> None:
    assert re.search(NEEDS[block.title], block.text)


@pytest.mark.parametrize("block", [b for b in blocks("sh") if not b.title], ids=str)
def test_a_block_without_a_title_has_only_commands_that_tests_run(block: Block) -> None:
    assert {Path(words[0]).name for words in block.commands()} <= {"webviz", "make", "export"}


@pytest.mark.parametrize(("place", "arguments"), commands("webviz"))
def test_every_option_of_a_command_exists_and_fits_the_config(
    place: str, arguments: tuple[str, ...], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("lab.yaml").write_text(CONFIG.text)
    own, _ = split_ros_arguments(arguments)
    _, binding, _ = app.parse_args(with_openers(own), exit_on_error=False, print_error=False)
    for options in binding.arguments.values():
        if isinstance(options, ConfigOptions) and options.display_config == Path("lab.yaml"):
            options.read(options.display_config)


def test_every_target_of_make_exists() -> None:
    named = {word for _, words in commands("make") for word in words}
    assert named
    # A make that runs the tests has handed on its flags, with a server of jobs to wait for.
    environment = {name: value for name, value in os.environ.items() if "MAKE" not in name}
    planned = subprocess.run(
        ["make", "--dry-run", *sorted(named)],
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert planned.returncode == 0, planned.stderr


@pytest.mark.parametrize(
    "block",
    [b for b in blocks("yaml") if b.page.parent.name != "examples" and not b.title],
    ids=str,
)
def test_every_config_is_read_without_a_complaint(block: Block, tmp_path: Path) -> None:
    file = tmp_path / "lab.yaml"
    file.write_text(block.text if "version:" in block.text else f"version: 1\n{block.text}")
    assert opening.load(file).report == []


@pytest.mark.parametrize(("place", "arguments"), commands("python"))
def test_every_script_that_a_command_runs_exists(place: str, arguments: tuple[str, ...]) -> None:
    option, module = arguments[:2] if arguments[0] == "-m" else ("", "")
    assert (option and importlib.util.find_spec(module)) or (ROOT / arguments[0]).is_file()


@pytest.mark.parametrize("block", [b for b in blocks("yaml") if b.title == "world.yaml"], ids=str)
def test_a_map_is_a_world(block: Block, tmp_path: Path) -> None:
    file = tmp_path / block.title
    file.write_text(block.text)
    image = Image.new("L", (4, 3), 255)
    image.putpixel((0, 2), 0)
    image.putpixel((1, 2), 128)
    image.save(tmp_path / "world.png")
    assert load_world(file).cells.tolist() == [[100, -1, 0, 0], [0] * 4, [0] * 4]


@pytest.mark.parametrize("block", blocks("toml"), ids=str)
def test_an_entry_point_names_a_group_and_a_class(block: Block) -> None:
    declared_groups = set(re.findall(r'"(webviz\.\w+)": \[', (ROOT / "setup.py").read_text()))
    (groups,) = (each["entry-points"] for each in tomllib.loads(block.text).values())
    assert groups.keys() <= declared_groups
    for name, target in [pair for group in groups.values() for pair in group.items()]:
        assert target.rpartition(":")[2] == name


@pytest.mark.parametrize("block", blocks("python"), ids=str)
def test_every_name_that_a_program_imports_exists(block: Block) -> None:
    for statement in ast.walk(ast.parse(block.text)):
        if isinstance(statement, ast.ImportFrom):
            module = importlib.import_module(statement.module or "")
            assert [a.name for a in statement.names if not hasattr(module, a.name)] == []
