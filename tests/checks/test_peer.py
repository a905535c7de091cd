"""Two machines: network namespaces joined by a bridge, and the faults between them."""

from __future__ import annotations

import functools
import json
import os
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import msgspec
import pytest

from webviz.checks.peer.distributions import _list_each_other
from webviz.shell.cli import main
from webviz.shell.doctor import peer_program
from webviz.shell.doctor.report import DoctorReport, ReportedFinding

NETWORK = """
ip link set lo up
ip link add br0 type bridge mcast_snooping 0
ip link set br0 up
join() {  # name, number
  unshare -nmu sh -c "mount -t tmpfs none /dev/shm; hostname $1; ip link set lo up
    exec sleep 600" &
  pid=$!
  until [ "$(nsenter -t $pid -u hostname 2>/dev/null)" = $1 ]; do sleep 0.01; done
  ip link add $1 type veth peer name eth0 netns $pid
  ip link set $1 master br0 up
  nsenter -t $pid -n ip address add 192.0.2.$2/24 dev eth0
  nsenter -t $pid -n ip link set eth0 up
  nsenter -t $pid -n ip route add default dev eth0
  until nsenter -t $pid -n ip -br link show eth0 | grep -q UP; do sleep 0.01; done
}
join viewer 1; VIEWER=$pid
join robot 2; export ROBOT=$pid
here() { nsenter -t $VIEWER -n -m -u "$@"; }
there() { nsenter -t $ROBOT -n -m -u "$@"; }
"""
SSH = """#!/bin/sh
# Runs a command line on the robot, as ssh does: -- HOST COMMAND_LINE
exec nsenter -t $ROBOT -n -m -u sh -c "$3"
"""
SHIFTED = """
import time
real = time.time
time.time = lambda: real() + 3.0
"""
TALKER = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import String
rclpy.init()
node = Node("talker")
publisher = node.create_publisher(String, "/chatter", 10)
rclpy.spin(node)
"""
LISTENER = """
import time, rclpy
from rclpy.node import Node
rclpy.init()
node = Node("listener")
while not node.count_publishers("/chatter"):
    time.sleep(0.05)
"""
PATIENCE_S = 180.0


@functools.cache
def unavailable() -> str:
    """The reason why there are no such namespaces on this machine, "" if there are."""
    if missing := [each for each in ("unshare", "nsenter", "ip") if not shutil.which(each)]:
        return f"{missing[0]} is missing"
    completed = subprocess.run(
        ["unshare", "-rnmpf", "--mount-proc", "sh", "-ec", "ip link add br0 type bridge"],
        capture_output=True,
        text=True,
        check=False,
    )
    return f"no network namespaces: {completed.stderr.strip()}" if completed.returncode else ""


needs_namespaces = pytest.mark.skipif(bool(unavailable()), reason=unavailable() or "available")


def in_network(tmp_path: Path, commands: str) -> str:
    """The output of a shell that can reach both machines."""
    ssh = tmp_path / "ssh"
    ssh.write_text(SSH)
    ssh.chmod(0o755)
    script = f"{NETWORK}\nPYTHON={sys.executable}\nSSH={ssh}\n{commands}"
    # All processes end with the first one of their namespace.
    program = ["unshare", "-rnmpf", "--mount-proc", "--kill-child", "sh", "-ec", script]
    # Other tests of this process, and its parent, set variables of ROS.
    bare = {k: v for k, v in os.environ.items() if not k.startswith(peer_program.PREFIXES)}
    completed = subprocess.run(
        program, capture_output=True, text=True, check=False, timeout=PATIENCE_S, env=bare
    )
    assert completed.returncode == 0, completed.stderr
    return completed.stdout


def compared(
    tmp_path: Path, commands: str = "", here: str = ""
) -> Mapping[str, Sequence[ReportedFinding]]:
    """The findings between the machines, by id.

    Args:
        tmp_path: a folder.
        commands: of a shell, run before.
        here: assignments of variables for this machine.
    """
    examine = (
        f"here env {here} $PYTHON -m webviz doctor --peer robot --ssh $SSH --json || [ $? = 3 ]"
    )
    report = msgspec.json.decode(in_network(tmp_path, f"{commands}\n{examine}"), type=DoctorReport)
    result: dict[str, list[ReportedFinding]] = {}
    for each in report.findings:
        if each.id[-3:] >= "020" or each.level == "time":
            result.setdefault(each.id, []).append(each)
    return result


def there_with(variables: str) -> str:
    """A command after which the robot has these variables."""
    return f"sed -i 's|nsenter -t|env {variables} nsenter -t|' $SSH"


@needs_namespaces
def test_all_is_well_between_two_machines(tmp_path: Path) -> None:
    # Each has another interface, which takes larger packets and leads elsewhere.
    others = "\n".join(
        f"{who} ip link add jumbo type veth; {who} ip link set jumbo mtu 9000 up; "
        f"{who} ip address add 198.51.100.{number}/32 dev jumbo"
        for who, number in (("here", 1), ("there", 2))
    )
    same = "RMW_IMPLEMENTATION=rmw_fastrtps_cpp ROS_DISTRO=jazzy"
    findings = compared(tmp_path, f"{others}\n{there_with(same)}", same)
    assert {*findings} <= {"NET023"}, "the kernel decides on the buffers"


@needs_namespaces
def test_a_bridge_that_drops_multicast(tmp_path: Path) -> None:
    (finding,) = compared(tmp_path, "ip link set robot type bridge_slave mcast_flood off")["NET021"]
    assert finding.cause == "Multicast does not arrive: viewer to robot."
    assert finding.command == "export ROS_STATIC_PEERS=192.0.2.2"
    assert finding.severity == "error"


@needs_namespaces
def test_a_path_that_drops_large_packets(tmp_path: Path) -> None:
    findings = compared(tmp_path, "ip link set robot mtu 1400; ip link set br0 mtu 1500")["NET022"]
    (finding,) = [each for each in findings if each.subject == "viewer to robot"]
    assert finding.evidence["arrives"] == 1400
    assert finding.evidence["allowed"] == 1500
    assert finding.command == "sudo ip link set eth0 mtu 1400"


@needs_namespaces
def test_an_interface_of_the_robot_that_takes_smaller_packets(tmp_path: Path) -> None:
    findings = compared(tmp_path, "there ip link set eth0 mtu 1300")["NET022"]
    (finding,) = [each for each in findings if each.subject == "viewer to robot"]
    assert finding.evidence["arrives"] == 1300
    assert finding.evidence["allowed"] == 1500


@needs_namespaces
def test_a_firewall_that_drops_udp_of_the_robot(tmp_path: Path) -> None:
    findings = compared(tmp_path, "there ip rule add ipproto udp prohibit pref 1")
    (finding,) = findings["NET020"]
    assert finding.subject == "robot to viewer"
    assert finding.command == "sudo ufw allow proto udp from 192.0.2.2"
    assert "NET021" not in findings, "it follows"


@needs_namespaces
def test_a_clock_that_is_three_seconds_ahead(tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text(SHIFTED)
    (finding,) = compared(tmp_path, there_with(f"PYTHONPATH={tmp_path}"))["TIME020"]
    assert isinstance(offset := finding.evidence["offset_s"], float)
    assert isinstance(uncertainty := finding.evidence["uncertainty_s"], float)
    assert abs(offset - 3.0) <= uncertainty + 0.01
    assert "s ahead of that of this machine" in finding.cause


@needs_namespaces
def test_software_that_differs(tmp_path: Path) -> None:
    there = there_with("RMW_IMPLEMENTATION=rmw_cyclonedds_cpp ROS_DISTRO=humble")
    findings = compared(tmp_path, there, "RMW_IMPLEMENTATION=rmw_fastrtps_cpp ROS_DISTRO=jazzy")
    assert [each.cause for id in ("ENV021", "ENV023") for each in findings[id]] == [
        "This machine uses rmw_fastrtps_cpp, robot uses rmw_cyclonedds_cpp.",
        "This machine runs jazzy, robot runs humble.",
    ]
    (finding,) = findings["ENV023"]
    assert finding.remedy.startswith("Nodes are not listed across them; topics arrive.")
    assert str(finding.evidence["nodes and parameters"]).startswith("not listed")


@pytest.mark.parametrize(
    ("ours", "theirs", "are_listed"),
    [("jazzy", "kilted", True), ("humble", "galactic", True), ("iron", "humble", False)],
)
def test_nodes_of_humble_and_older_are_not_listed_by_others(
    ours: str, theirs: str, are_listed: bool
) -> None:
    assert _list_each_other([ours], [theirs]) == are_listed


@needs_namespaces
def test_settings_of_running_nodes_count(tmp_path: Path) -> None:
    pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")
    (tmp_path / "talker.py").write_text(TALKER)
    (tmp_path / "listener.py").write_text(LISTENER)
    talk = f"""
there env ROS_DOMAIN_ID=5 RMW_IMPLEMENTATION=rmw_fastrtps_cpp $PYTHON {tmp_path}/talker.py &
here env ROS_DOMAIN_ID=5 $PYTHON {tmp_path}/listener.py
"""
    findings = compared(tmp_path, talk, here="ROS_DOMAIN_ID=7 ROS_LOCALHOST_ONLY=1")
    (finding,) = findings["ENV020"]
    assert finding.cause == "This machine uses domain 7, robot uses domain 5."
    assert "talker.py" in str(finding.evidence["there_from"])
    (finding,) = findings["ENV022"]
    assert finding.subject == "viewer"
    assert "ENV020" not in compared(tmp_path, talk, here="ROS_DOMAIN_ID=5")


@needs_namespaces
def test_the_remedy_for_lost_multicast_works(tmp_path: Path) -> None:
    pytest.importorskip("rclpy", reason="needs rclpy: source a ROS 2 or install ros-webviz[ros]")
    (tmp_path / "talker.py").write_text(TALKER)
    (tmp_path / "listener.py").write_text(LISTENER)
    drop_multicast = "; ".join(
        f"ip link set {each} type bridge_slave mcast_flood off" for each in ("viewer", "robot")
    )
    (finding,) = compared(tmp_path, drop_multicast)["NET021"]
    in_network(
        tmp_path,
        f"""{drop_multicast}
there env ROS_DOMAIN_ID=5 ROS_STATIC_PEERS=192.0.2.1 $PYTHON {tmp_path}/talker.py &
{finding.command}
here env ROS_DOMAIN_ID=5 $PYTHON {tmp_path}/listener.py
""",
    )


def test_a_peer_that_cannot_be_reached_is_one_sentence(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["doctor", "--peer", "robot", "--ssh", "false"]) == 1
    assert capsys.readouterr().err == (
        "webviz: robot cannot be examined. Check that `ssh robot python3` works.\n"
    )
    assert main(["doctor", "--peer", "robot", "--ssh", str(tmp_path / "no ssh")]) == 1
    assert "does not start" in capsys.readouterr().err
    looked = json.dumps({"value": peer_program.Agent().look()})
    says = tmp_path / "says"
    for answers in (
        ("{",),
        ('{"value": 3}',),
        ('{"value": {"host": "a\\u001b[31m"}}',),
        ('{"error": "No \\u001b"}',),
        (looked, '{"value": "soon"}'),
        (looked, *21 * ['{"value": 1.0}'], "{}", "{}", '{"value": {"a": 1}}'),
    ):
        (tmp_path / "answers").write_text("".join(f"@webviz {answer}\n" for answer in answers))
        says.write_text(f"#!/bin/sh\necho Welcome\ncat {tmp_path}/answers\ncat >/dev/null\n")
        says.chmod(0o755)
        assert main(["doctor", "--peer", "robot", "--ssh", str(says)]) == 1
        output = capsys.readouterr().err
        assert output.count("\n") == 1
        assert "\x1b" not in output


def test_nothing_passes_through_a_shell_unquoted(tmp_path: Path) -> None:
    ssh = tmp_path / "ssh"
    ssh.write_text(f'#!/bin/sh\nprintf "%s\\n" "$@" > {tmp_path}/said\n')
    ssh.chmod(0o755)
    assert main(["doctor", "--peer", "$(touch a); `b` -v", "--ssh", f"{ssh} -p '2 2'"]) == 1
    text = (tmp_path / "said").read_text().splitlines()
    assert text[:4] == ["-p", "2 2", "--", "$(touch a); `b` -v"]
    assert len(text) == 5
    assert sorted(path.name for path in tmp_path.iterdir()) == ["said", "ssh"]


@pytest.mark.parametrize("version", ["3.8", "3.9", "3.10", "3"])
def test_the_program_runs_on_old_pythons(version: str) -> None:
    python = shutil.which(f"python{version}")
    path = Path(peer_program.__file__)
    works = [python, "-c", "pass"] if python else ["false"]
    if subprocess.run(works, capture_output=True, check=False).returncode:
        pytest.skip(f"Python {version} is not installed")
    program = path.read_text()
    boot = "import sys; i = sys.stdin; exec(i.read(int(i.readline()))); serve()"
    requests = [{"do": "look", "with": []}, {"do": "time", "with": []}]
    completed = subprocess.run(
        [str(python), "-I", "-c", boot],
        input="\n".join([f"{len(program)}", program, *map(json.dumps, requests), ""]).replace(
            f"{program}\n", program, 1
        ),
        capture_output=True,
        text=True,
        check=True,
    )
    lines: list[Any] = [
        json.loads(line.partition(" ")[2]) for line in completed.stdout.splitlines()
    ]
    assert lines[0]["value"]["python"].startswith(version)
    assert lines[1]["value"] > 1e9
    assert completed.stderr == ""
