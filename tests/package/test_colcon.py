"""The ROS package, built by colcon as in a workspace; skipped without colcon."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from xml.etree import ElementTree

import pytest
from ruamel.yaml import YAML

from webviz.ros.control import PARAMETERS
from webviz_sim.options import OPTIONS

ROOT = Path(__file__).parents[2]
SHARE = [
    "config/demo.yaml",
    "launch/demo.launch.py",
    "launch/view.launch.py",
    "package.xml",
    "params/demo.yaml",
    "worlds/building.pgm",
    "worlds/building.yaml",
]


@pytest.mark.skipif(find_spec("colcon_ros") is None, reason="colcon-ros is not installed")
@pytest.mark.parametrize("options", [[], ["--symlink-install"]], ids=["copied", "linked"])
def test_colcon_builds_a_package_that_runs(tmp_path: Path, options: list[str]) -> None:
    folders = [f"--{name}-base={tmp_path / name}" for name in ("build", "install")]
    build = [sys.executable, "-m", "colcon", f"--log-base={tmp_path / 'log'}", "build"]
    outcome = run([*build, "--paths", str(ROOT), *folders, *options])
    assert "Finished <<< webviz" in outcome, outcome

    prefix = tmp_path / "install" / "webviz"
    share = prefix / "share" / "webviz"
    assert all((share / name).is_file() for name in SHARE)
    # Where RViz looks for the demo robot's meshes.
    assert (prefix / "share/ament_index/resource_index/packages/webviz_urdf").is_file()
    assert (prefix / "share/webviz_urdf/demo/meshes/body.stl").is_file()
    assert (prefix / "share/webviz_urdf/package.xml").is_file()

    source = f". {tmp_path}/install/local_setup.sh && "
    where = """python -c 'from importlib.util import find_spec as f; print(f("webviz").origin)'"""
    result = Path(run(["sh", "-c", source + where]).strip())
    assert result.is_relative_to(tmp_path)
    assert result.resolve().is_relative_to(ROOT) == bool(options)
    programs = "cd $COLCON_PREFIX_PATH/webviz/lib/webviz && ./webviz --version && ./sim --help"
    output = run(["sh", "-c", source + programs])
    assert "usage: webviz-sim" in output

    test = [*build[:-1], "test", "--return-code-on-test-failure"]
    one = ["--pytest-args", "tests/data/test_rotations.py"]
    outcome = run([*test, "--paths", str(ROOT), *folders, *one])
    assert "Finished <<< webviz" in outcome, outcome
    assert 'failures="0"' in (tmp_path / "build/webviz/pytest.xml").read_text()


def test_both_packages_have_one_version() -> None:
    files = (ROOT / "package.xml", ROOT / "ros/webviz_urdf/package.xml")
    assert len({ElementTree.parse(file).findtext("version") for file in files}) == 1


def test_the_parameters_of_the_launch_file_exist() -> None:
    entries = YAML(typ="safe").load(ROOT / "ros/params/demo.yaml")
    for node, names in (("sim", OPTIONS), ("webviz", PARAMETERS)):
        assert entries[f"/**/{node}"]["ros__parameters"].keys() <= names.keys()


def run(command: list[str]) -> str:
    """The standard output of a command that succeeds, with this Python before others."""
    env = dict(os.environ, PATH=f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}")
    env.pop("PYTHONPATH", None)
    env["PYTHONDONTWRITEBYTECODE"] = "1"  # to compile takes longer than all else
    result = subprocess.run(command, capture_output=True, text=True, timeout=300, env=env, cwd="/")
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout
