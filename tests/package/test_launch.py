"""The launch files, started if `launch` is there, which is not on PyPI; a sourced ROS 2 has it."""

from __future__ import annotations

import ast
import os
import re
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path

import pytest
from program import Program

from webviz.shell.testing.domain import isolated_domain

ROOT = Path(__file__).parents[2]
LAUNCH = ROOT / "ros" / "launch"
needs_launch = pytest.mark.skipif(
    find_spec("launch_ros") is None, reason="launch_ros is not on PyPI: source a ROS 2"
)
LAUNCHER = """
import sys
from launch import LaunchService
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource

path, *words = sys.argv[1:]
service = LaunchService()
given = [word.split(":=") for word in words]
source = PythonLaunchDescriptionSource(path)
service.include_launch_description(IncludeLaunchDescription(source, launch_arguments=given))
sys.exit(service.run())
"""
SHOW_ARGUMENTS = """
import sys
from launch import LaunchContext
from launch.launch_description_sources import PythonLaunchDescriptionSource

description = PythonLaunchDescriptionSource(sys.argv[1]).get_launch_description(LaunchContext())
for argument in description.get_launch_arguments():
    assert argument.description
    print(argument.name)
"""


def declared(path: Path) -> list[str]:
    """The names of the arguments of a launch file, without running it."""
    for statement in ast.parse(path.read_text()).body:
        if isinstance(statement, ast.Assign) and ast.unparse(statement.targets[0]) == "ARGUMENTS":
            assert isinstance(statement.value, ast.Dict)
            return [ast.literal_eval(key) for key in statement.value.keys if key]
    raise AssertionError(f"{path} has no ARGUMENTS")


def test_the_docs_explain_each_argument() -> None:
    page = (ROOT / "displays/docs/ros/README.md").read_text()
    table = page.partition("| argument |")[2].partition("\n\n")[0]
    assert re.findall(r"^\| `(\w+)` \|", table, re.M) == declared(LAUNCH / "demo.launch.py")


@pytest.mark.parametrize("path", sorted(LAUNCH.glob("*.py")), ids=lambda path: path.name)
def test_launch_files_declare_all_arguments_they_read(path: Path) -> None:
    calls = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
    read = {
        ast.literal_eval(call.args[0])
        for call in calls
        if ast.unparse(call.func) == "value" and isinstance(call.args[0], ast.Constant)
    }
    assert read <= {*declared(path)}
    nodes = [call for call in calls if ast.unparse(call.func) == "Node"]
    words = [{word.arg: word.value for word in node.keywords} for node in nodes]
    programs = {ast.literal_eval(each["executable"]) for each in words}
    assert programs <= {"webviz", "sim"}


@pytest.fixture
def env(tmp_path: Path) -> dict[str, str]:
    """An environment in which ROS finds the package of this folder, as after colcon build."""
    share, programs = tmp_path / "share", tmp_path / "lib" / "webviz"
    index = share / "ament_index/resource_index/packages"
    for folder in (index, share / "webviz", programs):
        folder.mkdir(parents=True)
    (index / "webviz").touch()
    links = {
        share / "webviz/launch": LAUNCH,
        share / "webviz/params": ROOT / "ros/params",
        share / "webviz/config": ROOT / "webviz/shell/cli",
        programs / "sim": ROOT / "ros/sim",
        programs / "webviz": Path(sys.executable).with_name("webviz"),
    }
    for link, target in links.items():
        link.symlink_to(target)
    prefixes = [str(tmp_path), *filter(None, [os.environ.get("AMENT_PREFIX_PATH")])]
    path = [str(Path(sys.executable).parent), os.environ["PATH"]]
    return os.environ | {
        "AMENT_PREFIX_PATH": os.pathsep.join(prefixes),
        "PATH": os.pathsep.join(path),
        "ROS_LOG_DIR": str(tmp_path / "log"),
        "PYTHONUNBUFFERED": "1",
    }


@needs_launch
@pytest.mark.parametrize("path", sorted(LAUNCH.glob("*.py")), ids=lambda path: path.name)
def test_show_args_lists_the_arguments(path: Path, env: dict[str, str]) -> None:
    command = [sys.executable, "-c", SHOW_ARGUMENTS, str(path)]
    result = subprocess.run(command, env=env, capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stderr
    assert set(result.stdout.split()) >= {*declared(path)}


@pytest.mark.parametrize("path", sorted(LAUNCH.glob("*.py")), ids=lambda path: path.name)
def test_no_installed_file_is_overwritten_by_save(path: Path) -> None:
    text = path.read_text()
    assert '"config": ("",' in text
    assert "SHARE" not in text or '"template": (str(SHARE / "config" / "demo.yaml"),' in text


@needs_launch
def test_the_demo_starts_and_stops_cleanly(tmp_path: Path, env: dict[str, str]) -> None:
    arguments = ["port:=0", "use_sim_time:=true", "respawn:=true"]
    demo = [sys.executable, "-c", LAUNCHER, str(LAUNCH / "demo.launch.py"), *arguments]
    with isolated_domain() as domain:
        program = Program(demo, env | {"ROS_DOMAIN_ID": str(domain)}, tmp_path / "output.txt")
        try:
            program.url()
        finally:
            status = program.end()
    output = program.output()
    assert status == 0, output
    assert output.count("process has finished cleanly") == 2, output
    assert "Traceback" not in output
