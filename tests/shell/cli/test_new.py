"""`webviz new`: packages that install, pass their tests and can be shown at once."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from webviz.api.errors import Error
from webviz.shell.cli.commands import run
from webviz.shell.cli.new import KINDS, write_package

SCRIPT = """
import sys
from webviz.files import opening
for path in sys.argv[1:]:
    config = opening.load(path)
    assert not config.report, config.report
"""


def called(*command: str | Path, cwd: Path | None = None, **variables: str) -> str:
    """The output of a Python program that succeeds."""
    result = subprocess.run(
        [sys.executable, *command],
        capture_output=True,
        text=True,
        check=False,
        env=os.environ | variables,
        timeout=300,
        cwd=cwd,
    )
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def test_each_package_installs_and_passes_its_tests(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    for kind in KINDS:
        assert run(["new", kind, f"my_{kind}", "-o", str(tmp_path)]) == 0
    assert f"webviz demo -d {tmp_path / 'my_check' / 'demo.yaml'}" in capsys.readouterr().out
    packages = [tmp_path / f"my_{kind}" for kind in KINDS]
    for package in packages:  # as `pip install -e` does, which needs an index
        called("setup.py", "-q", "egg_info", cwd=package)
    path = os.pathsep.join(map(str, packages))
    called("-c", SCRIPT, *(each / "demo.yaml" for each in packages), PYTHONPATH=path)
    tests = [each / "test" for each in packages]
    outcome = called("-m", "pytest", "-q", "-p", "no:cacheprovider", *tests, PYTHONPATH=path)
    assert "failed" not in outcome
    assert "passed" in outcome
    called(
        "-m", "ruff", "check", "--isolated", "--line-length=100", "--select=E,F,W,B,UP", *packages
    )


@pytest.mark.parametrize("name", ["My-Tool", "a__b", "", "1st", "class", "../x", "é", "a" * 99])
def test_a_name_that_no_package_can_have_is_refused(tmp_path: Path, name: str) -> None:
    with pytest.raises(Error, match="is not the name of a ROS package"):
        write_package("tool", name, tmp_path)
    assert not list(tmp_path.parent.glob("x"))


@pytest.mark.parametrize("name", ["webviz", "os", "test", "numpy", "webviz_displays", "viser"])
def test_a_package_hides_no_module(tmp_path: Path, name: str) -> None:
    with pytest.raises(Error, match=f"already has a module `{name}`"):
        write_package("display", name, tmp_path)
    assert not list(tmp_path.iterdir())


def test_nothing_is_overwritten(tmp_path: Path) -> None:
    write_package("tool", "mine", tmp_path)
    with pytest.raises(Error, match="mine already exists"):
        write_package("panel", "mine", tmp_path)
