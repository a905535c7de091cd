"""The command `webviz doctor`."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import msgspec
import pytest
from bags import START_NS, Bag, ns
from examining import SCAN, three_ranges

import webviz
import webviz.checks
from webviz.api.check_registry import known_checks, register_checks
from webviz.api.registry import register
from webviz.commands import ReloadPlugin
from webviz.shell.cli import main
from webviz.shell.doctor.report import DoctorReport, schema_text, to_text

LASER = """
from webviz import Check

class Laser(Check):
    \"\"\"Laser.\"\"\"

    id = "{id}"

    def find(self, seen):
        for _, port in seen.inputs():
            if port.topic == "/scan" and port.received:
                yield self.found("There is a laser.", "{remedy}")
"""
ROS2 = {
    "bag play": {"--clock"},
    "daemon stop": set[str](),
    "interface show": set[str](),
    "lifecycle get": set[str](),
    "lifecycle set": set[str](),
    "multicast receive": set[str](),
    "multicast send": set[str](),
    "node info": set[str](),
    "node list": set[str](),
    "param get": set[str](),
    "param set": set[str](),
    "topic bw": set[str](),
    "topic delay": set[str](),
    "topic echo": {"--field", "--once"},
    "topic find": set[str](),
    "topic hz": set[str](),
    "topic info": {"--verbose"},
    "topic list": set[str](),
    "topic type": set[str](),
}
"""Verbs of ros2cli and ros2bag that checks name, each with the options of them that they use."""


@pytest.fixture
def run_bag(tmp_path: Path) -> Path:
    """A bag of a robot whose laser is misspelt."""
    bag = Bag()
    bag.add("/scan", SCAN)
    bag.transform(0.0, "base_link", "laser", static=True)
    for number in range(60):
        at_s = number / 10
        bag.transform(at_s, "odom", "base_link", at_s)
        bag.put(at_s + 0.05, "/scan", three_ranges("lasr", START_NS + ns(at_s)))
    return bag.write(tmp_path / "run")


def test_a_bag_is_examined_for_a_program(run_bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--bag", str(run_bag), "--json"]) == 3
    report = msgspec.json.decode(capsys.readouterr().out, type=DoctorReport)
    (finding,) = report.findings
    assert (finding.id, finding.level, finding.severity) == ("TF016", "frames", "error")
    assert finding.evidence == {"frame": "lasr", "nearest": "laser"}
    assert [(each.display, each.status) for each in finding.explains] == [
        ("LaserScan", "Transform")
    ]
    assert START_NS / 1e9 <= finding.first <= finding.last <= START_NS / 1e9 + 6.0
    assert not [each for each in report.unexplained if each.display == "LaserScan"]
    causes = {(each.display, each.status): each.finding for each in report.statuses}
    assert causes["LaserScan", "Transform"] == "TF016"
    assert {*msgspec.json.decode(schema_text())["$defs"]} >= {"DoctorReport", "ReportedFinding"}


def test_joint_states_of_a_bag_are_examined(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag, axle = Bag(), '<joint name="axle" type="continuous"><parent link="a"/><child link="b"/>'
    urdf = f'<robot name="r"><link name="a"/><link name="b"/>{axle}</joint></robot>'
    bag.add("/robot_description", "std_msgs/msg/String", latched=True)
    bag.add("/joint_states", "sensor_msgs/msg/JointState")
    bag.put(0.0, "/robot_description", {"data": urdf})
    bag.transform(0.0, "map", "a", static=True)
    for number in range(60):
        bag.put(number / 10, "/joint_states", {"name": ["arm"], "position": [0.0]})
    assert main(["doctor", "--bag", str(bag.write(tmp_path / "run")), "--json"]) == 3
    report = msgspec.json.decode(capsys.readouterr().out, type=DoctorReport)
    assert [each.id for each in report.findings] == ["DATA017"]


def test_a_bag_is_examined_for_a_person(run_bag: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--bag", str(run_bag)]) == 3
    output = capsys.readouterr().out
    assert output.startswith('error[TF016]: The frame "lasr" does not exist, but "laser" does.\n')
    assert "help: Set the frame id of the data" in output
    assert "explains: LaserScan, Transform" in output


def test_a_finding_is_explained(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--explain", "tf003"]) == 0
    output = capsys.readouterr().out
    assert output.startswith("TF003: Localisation is missing\n")
    assert "Why:\n\n" in output
    assert "Repair:\n\n" in output
    assert main(["doctor", "--explain", "all"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == len(known_checks())
    assert main(["doctor", "--explain", "TF999"]) == 2
    assert "Unknown finding TF999" in capsys.readouterr().err


def test_checks_of_a_file_are_run_and_reloaded(
    run_bag: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "lasers.py"
    path.write_text(LASER.format(id="DATA901", remedy="Buy one."))
    try:
        assert main(["doctor", "--bag", str(run_bag), "--plugin", str(path)]) == 3
        assert "warning[DATA901]: There is a laser.\n  help: Buy one." in capsys.readouterr().out
        assert main(["doctor", "--explain", "DATA901"]) == 0
        with webviz.Viewer(bag=run_bag, port=0, fixed_frame="odom", plugins=[path]) as viewer:
            viewer.seek(4.0)
            path.write_text(LASER.format(id="DATA902", remedy="Sell it."))
            viewer.do(ReloadPlugin(path))
            assert "Sell it." in {each.remedy for each in viewer.doctor()}
        path.write_text(LASER.format(id="TF003", remedy=""))
        assert main(["doctor", "--plugin", str(path)]) == 1
        assert "an installed package has a check with the id TF003, too" in capsys.readouterr().err
    finally:
        register_checks(str(path), ())


def test_every_check_is_documented() -> None:
    from webviz.api.check import CheckText

    for check in known_checks():
        text = CheckText(check)
        assert text.title, check
        assert text.what, check
        assert text.why, check
        assert text.repair, check


def test_commands_of_remedies_exist() -> None:
    folder = Path(webviz.checks.__file__).parent
    sources = "\n".join(path.read_text() for path in folder.rglob("*.py"))
    used = re.findall(r"ros2 ((?!run|launch)\w+ \w+)([^\"`;\n]*)", sources)
    assert {verb for verb, _ in used} <= ROS2.keys()
    for verb, rest in used:
        assert {*re.findall(r"--\w+", rest)} <= ROS2[verb], verb


def test_a_fault_that_would_end_ros_is_found_before_it_starts(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "233")
    assert main(["doctor", "--json"]) == 3
    report = msgspec.json.decode(capsys.readouterr().out, type=DoctorReport)
    assert report.findings[0].id == "ENV001"


BLOCKED = """
import pathlib, time
from webviz import Check

class Blocked(Check):
    \"\"\"Blocked.\"\"\"

    id = "DATA903"

    def find(self, seen):
        while not pathlib.Path({path!r}).exists():
            time.sleep(0.01)
        return ()
"""


@pytest.mark.usefixtures("webviz_domain")
def test_a_live_examination_ends_in_time(tmp_path: Path) -> None:
    path = tmp_path / "blocked.py"
    path.write_text(BLOCKED.format(path=str(tmp_path / "never")))
    command = ["doctor", "--plugin", str(path), "--seconds", "1", "--json"]
    # It would wait for its check without end. Its standard output has to be a file for ROS.
    completed = subprocess.run(
        [sys.executable, "-m", "webviz", *command], capture_output=True, timeout=60.0, check=False
    )
    assert completed.returncode == 1, completed.stderr
    report = msgspec.json.decode(completed.stdout, type=DoctorReport)
    assert report.unfinished
    text = to_text(report, is_colored=False)
    assert "unfinished: This machine is busy" in text
    assert "All is well" not in text


@pytest.mark.usefixtures("webviz_domain")
def test_a_short_look_claims_no_empty_graph() -> None:
    command = [sys.executable, "-m", "webviz", "doctor", "--seconds", "3.5", "--json"]
    completed = subprocess.run(command, capture_output=True, timeout=120.0, check=False)
    report = msgspec.json.decode(completed.stdout, type=DoctorReport)
    assert "GRAPH001" not in {each.id for each in report.findings}
    assert report.unfinished


def test_a_viewer_is_examined_on_request_and_a_recording_notes_the_moment(run_bag: Path) -> None:
    with webviz.Viewer(bag=run_bag, port=0, fixed_frame="odomm") as viewer:
        viewer.seek(4.0)
        (finding,) = [each for each in viewer.doctor() if each.id == "TF002"]
        assert finding.button == webviz.OtherFixedFrame("odom")
        assert finding in viewer["LaserScan"].findings
        (event,) = [each for each in viewer.state.found if each.name == "TF002"]
        assert event.at_ns == START_NS + ns(4.0)
        viewer.fixed_frame = "odom"
        assert "TF002" not in {each.id for each in viewer.doctor()}


def test_a_warning_without_a_cause_is_not_called_well(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = Bag()
    bag.add("/poses", "geometry_msgs/msg/PoseArray")
    bag.put(0.0, "/poses", {"header": {"frame_id": "map"}, "poses": []})
    assert main(["doctor", "--bag", str(bag.write(tmp_path / "run"))]) == 0
    output = capsys.readouterr().out
    assert "The message has no poses." in output
    assert "All is well" not in output
    assert output.startswith("note[TF001]: The bag has no transforms.")  # and needs none
    assert output.splitlines()[-1].startswith("No finding explains 1 warning above")


BROKEN = """
from typing import Annotated
from webviz import Display, Input, Topic

class Broken(Display):
    topic: Annotated[Topic, Input("geometry_msgs/msg/Twist")] = Topic("/twist")

    def draw(self, samples, ctx):
        raise ValueError("a fault of the display, not of the data")
"""


def test_an_unexplained_error_fails_the_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    bag = Bag()
    bag.add("/twist", "geometry_msgs/msg/Twist")
    for number in range(5):
        bag.put(number / 5, "/twist", {"linear": {"x": 1.0}})
    config, plugin = tmp_path / "broken.yaml", tmp_path / "broken.py"
    config.write_text("displays: [{type: Broken}]")
    plugin.write_text(BROKEN)
    path = str(bag.write(tmp_path / "run"))
    command = ["doctor", "--bag", path, "-d", str(config), "--plugin", str(plugin)]
    try:
        assert main([*command, "--json"]) == 3
        report = msgspec.json.decode(capsys.readouterr().out, type=DoctorReport)
        assert not [each for each in report.findings if each.severity != "note"]
        assert "error" in {each.level for each in report.unexplained}
        assert main(command) == 3
        assert "No finding explains 1 error above" in capsys.readouterr().out
    finally:
        register(str(plugin), {})
