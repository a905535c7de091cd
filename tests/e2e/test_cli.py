"""The command line as a user meets it: what it prints, how it ends, and every mistake."""

from __future__ import annotations

import os
import re
import subprocess
import sys
import venv
from collections.abc import Callable
from pathlib import Path

import pytest
from processes import command_lines
from program import Program

from webviz.shell.cli import main as cli
from webviz.shell.cli.commands import with_openers

ROOT = Path(__file__).parents[2]
PATIENCE_S = 180.0
"""Time in seconds for what takes two seconds on a machine that does nothing else."""


def run(*arguments: str, env: dict[str, str] | None = None) -> subprocess.CompletedProcess[str]:
    """Run `webviz` to its end."""
    return subprocess.run(
        [sys.executable, "-m", "webviz", *arguments],
        capture_output=True,
        text=True,
        timeout=PATIENCE_S,
        env={**os.environ, **(env or {})},
    )


def refusal(*arguments: str, status: int = 1) -> str:
    """The one sentence with which `webviz` refuses."""
    result = run(*arguments)
    assert result.returncode == status, result.stderr
    assert "Traceback" not in result.stderr
    return result.stderr.strip()


@pytest.mark.parametrize(
    ("arguments", "meant"),
    [
        ("lab.rviz", "--display-config lab.rviz"),
        ("Run.MCAP lab.yaml --port 0", "--bag Run.MCAP --display-config lab.yaml --port 0"),
        ("run", "--bag run"),
        ("demo", "demo"),
        ("doctor lab.yaml run --json", "doctor --display-config lab.yaml --bag run --json"),
        ("frames lab.yaml", "frames lab.yaml"),
        ("test bug.zip", "test bug.zip"),
        ("bug.zip --port 0", "open bug.zip --port 0"),
        ("-d lab.conf", "-d lab.conf"),
        ("", ""),
    ],
)
def test_files_are_opened_without_options(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, arguments: str, meant: str
) -> None:
    monkeypatch.chdir(tmp_path)
    for folder in ("run", "demo"):
        (tmp_path / folder).mkdir()
    assert with_openers(arguments.split()) == meant.split()


def test_help_lists_every_command_and_option() -> None:
    result = run("--help")
    assert result.returncode == 0
    for word in ("convert", "demo", "schema", "screenshot", "--display-config", "--port"):
        assert f" {word} " in result.stdout
    assert "Examples:" in result.stdout
    assert "--ros-args" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (["screenshoot"], "Unknown command `screenshoot`: did you mean `screenshot`?"),
        (
            ["lab.conf"],
            "Unknown command `lab.conf`. To open it as a config, run `webviz -d lab.conf`.",
        ),
        (["--port", "0", "demo"], "The command must come first: `webviz demo ...`."),
        (["demo", "now"], "Unexpected argument for `webviz demo`: `now`."),
        (["--prot", "80"], "Unknown option: --prot. Did you mean --port?"),
        (["schema", "--outptu", "a"], "Unknown option: --outptu. Did you mean --output?"),
        (["--port", "99999"], 'Invalid value "99999" for --port. Must be <= 65535.'),
        (["--colour"], "Unknown option: --colour."),
        (["--port"], "--port needs a value."),
        (["--port", "web"], "Invalid value for --port: `web` is not a whole number."),
        (["screenshot", "-o"], "-o needs FILE."),
        (["convert"], "`webviz convert` needs SOURCE."),
    ],
)
def test_a_mistyped_argument_suggests_the_nearest(
    arguments: list[str], sentence: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli(arguments) == 2
    assert capsys.readouterr().err == f"webviz: {sentence}\n"


def test_a_missing_config_is_an_error() -> None:
    sentence = refusal("-d", "nowhere.yaml")
    assert sentence == "webviz: Cannot read nowhere.yaml: No such file or directory."


def test_a_broken_config_is_an_error_with_its_place(tmp_path: Path) -> None:
    path = tmp_path / "x.yaml"
    path.write_text("fixed_frame: map\nbackground: [1, 2\n")
    assert f"{path}:3 is not valid YAML" in refusal("-d", str(path))


def test_an_address_that_cannot_be_served_is_an_error() -> None:
    sentence = refusal("--host", "192.0.2.1", "--port", "8123")
    assert sentence.startswith("webviz: Cannot listen on port 8123 of 192.0.2.1")
    assert "\n" not in sentence


@pytest.mark.skipif("rclpy" in os.environ.get("PYTHONPATH", ""), reason="a sourced ROS")
def test_a_missing_ros_is_explained_in_one_sentence(tmp_path: Path) -> None:
    folder = tmp_path / "venv"
    venv.create(folder, system_site_packages=False)
    # The packages of this environment, but not its rclpy.
    site = Path(next(p for p in sys.path if p.endswith("site-packages")))
    other = next((folder / "lib").glob("python*")) / "site-packages"
    for item in site.iterdir():
        if not item.name.lower().startswith(("rclpy", "ros_", "ros-", "_ros", "rosidl", "rmw")):
            (other / item.name).symlink_to(item)
    env = {k: v for k, v in os.environ.items() if k != "_ROS_WHEELS_BOOTSTRAP_COMPLETE"}
    for arguments in ([], ["demo"]):
        result = subprocess.run(
            [folder / "bin" / "python", "-m", "webviz", *arguments, "--port", "0"],
            capture_output=True,
            text=True,
            timeout=PATIENCE_S,
            env=env,
        )
        assert result.returncode == 1, result.stderr
        assert result.stderr.startswith("webviz: Python 3")
        assert "pip install 'ros-webviz[ros]'" in result.stderr
        assert result.stderr.count("\n") == 1


def test_bad_ros_arguments_are_one_sentence() -> None:
    pytest.importorskip("rclpy", reason="needs rclpy")
    sentence = refusal("--port", "0", "--ros-args", "-r", "nonsense").splitlines()[-1]
    assert sentence.startswith("webviz: ROS did not start: ")
    assert "/src/" not in sentence


def test_a_simulator_that_dies_ends_the_demo_with_a_reason(start: Callable[..., Program]) -> None:
    pytest.importorskip("rclpy", reason="needs rclpy")
    program = start("webviz", "demo", "--port", "0")
    program.url()
    children = command_lines(program.process.pid)
    (simulator,) = (child for child, line in children.items() if "webviz_sim" in line)
    simulator.kill()
    assert program.process.wait(60) == 1
    assert "webviz: The simulator failed with exit status" in program.output()


def test_a_demo_with_an_unknown_fault_does_not_start(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli(["demo", "--fault", "foo=1"]) == 2
    assert "Unknown fault 'foo'. Choose one of laser_yaw" in capsys.readouterr().err


def test_installation_includes_pictures_and_reports_a_missing_browser() -> None:
    plan = subprocess.run(
        ["make", "--dry-run", "--always-make", "install"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    assert '--editable ".[pictures' in plan.stdout
    (check,) = re.findall(r"python (-m webviz\.shell\.pictures\S+)", plan.stdout)
    result = subprocess.run(
        [sys.executable, *check.split()],
        capture_output=True,
        text=True,
        timeout=60,
        env={**os.environ, "WEBVIZ_BROWSER": "/nowhere/chromium"},
    )
    assert result.stdout.startswith(
        "webviz is ready, but cannot make pictures yet. WEBVIZ_BROWSER is"
    )
    assert result.stderr == ""


def test_a_pipe_that_is_closed_ends_a_command_quietly(tmp_path: Path) -> None:
    files = [tmp_path / f"{number}.rviz" for number in range(2)]
    for file in files:
        file.write_text("Visualization Manager: {Displays: []}")
    command = subprocess.Popen(
        [sys.executable, "-m", "webviz", "convert", "--check", *map(str, files)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
    )
    assert command.stdout is not None
    command.stdout.close()
    _, output = command.communicate()
    assert (command.returncode, output) == (1, b"")


@pytest.mark.parametrize(
    ("closed", "output"), [(">&-", ""), ("2>&-", "complete"), ("<&- >&- 2>&-", "")]
)
def test_streams_that_are_closed_lead_nowhere(tmp_path: Path, closed: str, output: str) -> None:
    (tmp_path / "a.rviz").write_text("Visualization Manager: {Displays: []}")
    line = f'exec "{sys.executable}" -m webviz convert --check a.rviz {closed}'
    result = subprocess.run(["sh", "-c", line], cwd=tmp_path, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    assert output in result.stdout
    assert "Error" not in result.stderr
