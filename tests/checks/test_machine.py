"""Faults of this machine, its network and its shared memory, provoked for real."""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path

import msgspec
import pytest

from webviz.engine.machine.environment import look_around
from webviz.shell.doctor.examination import examine_machine
from webviz.shell.doctor.report import DoctorReport

EXAMINER = """
import ctypes, json, subprocess, sys
from multiprocessing import get_context
from webviz.engine.machine.environment import look_around
from webviz.shell.doctor.examination import examine_machine

NEW_MOUNTS, NEW_PROCESSES, NEW_NETWORK = 0x00020000, 0x20000000, 0x40000000
patience_s = float(sys.argv[1])
Process = get_context("fork").Process


def examine(commands):
    for each in (["mount", "-t", "proc", "none", "/proc"], ["sh", "-ec", commands]):
        subprocess.run(each, stdin=subprocess.DEVNULL, check=True, timeout=patience_s)
    found = examine_machine(look_around()).findings
    print(json.dumps({each.id: each.severity for each in found}), flush=True)


def enter(commands):
    assert ctypes.CDLL(None).unshare(NEW_MOUNTS | NEW_PROCESSES | NEW_NETWORK) == 0
    # All processes end with the first one of their namespace.
    first = Process(target=examine, args=(commands,))
    first.start()
    first.join()
    sys.exit(first.exitcode)


for line in sys.stdin:
    each = Process(target=enter, args=(json.loads(line),))
    each.start()
    each.join()
    if each.exitcode:
        print("the commands or the examination failed", flush=True)
"""
"""Examines the machine in namespaces of their own, each after the commands of a line."""
PATIENCE_S = 120.0
OWN = ("ROS", "RMW", "FASTRTPS", "FASTDDS", "CYCLONEDDS", "AMENT", "ZENOH")


@pytest.fixture(scope="module")
def examiner() -> Iterator[subprocess.Popen[str]]:
    assert can_unshare(), "This machine has no network namespaces for users."
    # Other tests of this process set variables of ROS.
    bare = {name: value for name, value in os.environ.items() if not name.startswith(OWN)}
    program = ["unshare", "-rm", sys.executable, "-c", EXAMINER, str(PATIENCE_S)]
    pipe = subprocess.PIPE
    with subprocess.Popen(program, stdin=pipe, stdout=pipe, text=True, env=bare) as process:
        yield process


def in_namespaces(examiner: subprocess.Popen[str], commands: str) -> Mapping[str, str]:
    """The findings in namespaces of their own, by id, with their severity.

    Args:
        examiner: imports what it needs only once.
        commands: of a shell, which are run there before.
    """
    assert examiner.stdin is not None
    assert examiner.stdout is not None
    examiner.stdin.write(f"{json.dumps(commands)}\n")
    examiner.stdin.flush()
    return json.loads(examiner.stdout.readline())


def examined() -> Mapping[str, str]:
    """The findings of this machine, by id, with their severity."""
    return {each.id: each.severity for each in examine_machine(look_around()).findings}


@pytest.fixture
def well(monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """Findings of this machine without the variables of ROS."""
    for name in os.environ:
        if name.startswith(OWN):
            monkeypatch.delenv(name)
    return {*examined()}


OTHER_PYTHON = "/opt/ros/humble/lib/python3.8"
RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"


@pytest.mark.parametrize(
    ("id", "severity", "variables", "cured"),
    [
        ("ENV001", "error", {"ROS_DOMAIN_ID": "233"}, {"ROS_DOMAIN_ID": "232"}),
        ("ENV001", "error", {"ROS_DOMAIN_ID": "robot"}, {"ROS_DOMAIN_ID": "0"}),
        ("ENV002", "note", {"ROS_DOMAIN_ID": "102"}, {"ROS_DOMAIN_ID": "101"}),
        ("ENV003", "error", {RANGE: "OFF"}, {RANGE: "OFF", "ROS_STATIC_PEERS": "10.0.0.1"}),
        ("ENV004", "warning", {RANGE: "LAN"}, {RANGE: "LOCALHOST"}),
        ("ENV005", "warning", {RANGE: "SUBNET", "ROS_LOCALHOST_ONLY": "1"}, {RANGE: "SUBNET"}),
        ("ENV006", "error", {"RMW_IMPLEMENTATION": "rmw_none_cpp"}, {}),
        (
            "ENV007",
            "warning",
            {"CYCLONEDDS_URI": "<CycloneDDS>"},
            {"CYCLONEDDS_URI": "<A b='1,2'/>"},
        ),
        (
            "ENV007",
            "warning",
            {"CYCLONEDDS_URI": "<A>"},
            {"CYCLONEDDS_URI": '<General><Peers><Peer Address="a,b"/></></>'},
        ),
        ("ENV007", "warning", {"FASTRTPS_DEFAULT_PROFILES_FILE": "/missing.xml"}, {}),
        ("ENV014", "warning", {"ROS_SECURITY_ENABLE": "true"}, {"ROS_SECURITY_ENABLE": "false"}),
        ("ENV015", "warning", {"PYTHONPATH": f"{OTHER_PYTHON}/site-packages"}, {}),
        (
            "ENV009",
            "warning",
            {"AMENT_PREFIX_PATH": "/opt/ros/humble:/opt/ros/jazzy"},
            {"AMENT_PREFIX_PATH": "/opt/ros/jazzy"},
        ),
    ],
)
def test_variables(
    monkeypatch: pytest.MonkeyPatch,
    well: set[str],
    id: str,
    severity: str,
    variables: Mapping[str, str],
    cured: Mapping[str, str],
) -> None:
    for name, value in variables.items():
        monkeypatch.setenv(name, value)
    findings = examined()
    assert findings.get(id) == severity
    assert {*findings} - well == {id}
    for name in variables:
        monkeypatch.delenv(name)
    for name, value in cured.items():
        monkeypatch.setenv(name, value)
    assert {*examined()} <= well


def test_faults_that_stop_ros_come_first(monkeypatch: pytest.MonkeyPatch, well: set[str]) -> None:
    monkeypatch.setenv("CYCLONEDDS_URI", "<CycloneDDS>")
    monkeypatch.setenv("ROS_SECURITY_ENABLE", "true")
    assert [id for id in examined() if id not in well] == ["ENV007", "ENV014"]
    monkeypatch.setenv("ROS_SECURITY_STRATEGY", "Enforce")
    assert [id for id in examined() if id not in well] == ["ENV014", "ENV007"]


def test_discovery_servers(monkeypatch: pytest.MonkeyPatch, well: set[str]) -> None:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as server:
        server.bind(("127.0.0.1", 0))
        port = server.getsockname()[1]
        monkeypatch.setenv("ROS_DISCOVERY_SERVER", f"127.0.0.1:{port}")
        findings = examined()
        assert {*findings} - well == {"ENV008"}
        assert findings["ENV008"] == "warning"
        monkeypatch.setenv("ROS_SUPER_CLIENT", "TRUE")
        assert {*examined()} <= well
    assert examined().get("ENV012") == "error"
    monkeypatch.delenv("ROS_SUPER_CLIENT")
    assert "ENV008" not in examined(), "the server is to be repaired first"
    monkeypatch.setenv("ROS_DISCOVERY_SERVER", "127.0.0.1:robot")
    assert examined().get("ENV012") == "error"


def test_zenoh_routers(monkeypatch: pytest.MonkeyPatch, well: set[str]) -> None:
    monkeypatch.setenv("RMW_IMPLEMENTATION", "rmw_zenoh_cpp")
    with socket.create_server(("127.0.0.1", 0)) as router:
        port = router.getsockname()[1]
        override = f'connect/endpoints=["tcp/127.0.0.1:{port}"];mode="client"'
        monkeypatch.setenv("ZENOH_CONFIG_OVERRIDE", override)
        assert "ENV011" not in examined()
    assert examined().get("ENV011") == "error"
    monkeypatch.delenv("RMW_IMPLEMENTATION")
    assert "ENV011" not in examined()


def test_a_daemon_with_other_settings(monkeypatch: pytest.MonkeyPatch, well: set[str]) -> None:
    monkeypatch.setenv("ROS_DOMAIN_ID", "97")
    named = ("--name", "ros2-daemon", "--ros-domain-id", "97")
    wait = "import sys; print(flush=True); sys.stdin.read()"
    daemon = [sys.executable, "-c", wait, *named]
    other = os.environ | {"ROS_LOCALHOST_ONLY": "1"}
    pipe = subprocess.PIPE
    for variables, expected in ((os.environ, set[str]()), (other, {"ENV013"})):
        with subprocess.Popen(daemon, env=variables, stdin=pipe, stdout=pipe) as process:
            assert process.stdout is not None
            process.stdout.readline()
            assert {*examined()} - well == expected
            process.communicate()


def test_ros_that_does_not_start_is_a_finding() -> None:
    report = examine_machine(look_around(ros_error="ROS did not start: no RMW. Source it."))
    findings = {each.id: each for each in report.findings}
    assert findings["ENV010"].cause == "ROS did not start: no RMW."
    assert findings["ENV010"].remedy == "Source it."
    assert {id.rstrip("0123456789") for id in findings} <= {"ENV", "NET", "SHM"}, (
        "it has seen no topic"
    )


LO = "ip link set lo up"
ETH = (
    f"{LO}; ip link add eth0 type veth peer name eth1; ip address add 192.0.2.9/24 dev eth0; "
    "ip link set eth0 up; ip link set eth1 up; ip route add default dev eth0"
)
OTHER = "ip link set eth1 down; ip link set eth1 name docker0; ip link set docker0 up"
NO_MULTICAST = "ip link set eth0 multicast off; ip link set eth1 multicast off"
FLOOD = """
import socket
full = socket.socket(type=socket.SOCK_DGRAM)
full.bind(("127.0.0.1", 0))
for _ in range(1000):
    full.sendto(bytes(1000), full.getsockname())
"""
FRAGMENT = """
import socket, struct, time
with open("/proc/sys/net/ipv4/ipfrag_time", "w") as kept:
    kept.write("1")
raw = socket.socket(socket.AF_INET, socket.SOCK_RAW, socket.IPPROTO_RAW)
us = socket.inet_aton("127.0.0.1")
more = 0x2000
head = struct.pack("!BBHHHBBH4s4s", 0x45, 0, 0, 7, more, 64, socket.IPPROTO_UDP, 0, us, us)
raw.sendto(head + bytes(64), ("127.0.0.1", 0))
time.sleep(2.5)
"""
VPN = (
    "ip link add tun0 type veth peer name far; ip address add 198.51.100.9/24 dev tun0; "
    "ip link set tun0 up; ip link set far up; ip route add 224.0.0.0/4 dev tun0"
)
SHM = "mount -t tmpfs none /dev/shm -o"
NODE = f"{sys.executable} -c 'import rclpy; rclpy.init(); rclpy.spin(rclpy.create_node(\"n\"))'"
QUIET = ">/dev/null 2>&1 & node=$!"
GROUP = "0100FFEF" if sys.byteorder == "little" else "EFFF0001"
HEARD = f"until grep -q {GROUP} /proc/net/igmp; do sleep 0.05; done"
LOADED = "until grep -q librmw_fast /proc/$node/maps; do sleep 0.05; done"


@pytest.mark.parametrize(
    ("id", "faulty", "cured"),
    [
        ("NET001", f"{ETH}; {NO_MULTICAST}", ETH),
        ("NET002", f"{ETH}; ip route del default", ETH),
        ("NET003", LO, ETH),
        ("NET004", f"{ETH}; {OTHER}", ETH),
        ("NET005", f"{ETH}; ip link set eth0 mtu 1400", ETH),
        ("NET009", f"{LO}; {sys.executable} -c '{FRAGMENT}'", LO),
        ("NET010", f"{ETH}; {VPN}", ETH),
        ("NET006", f"{LO}; {sys.executable} -c '{FLOOD}'", LO),
        ("SHM004", f"{SHM} size=1g; touch /dev/shm/fastrtps_port7_el", f"{SHM} size=1g"),
        ("SHM004", f"{SHM} size=1g; touch /dev/shm/fastdds_port7_el", f"{SHM} size=1g"),
        ("NET011", f"{LO}; {NODE} {QUIET}; {HEARD}; {ETH}", f"{ETH}; {NODE} {QUIET}; {HEARD}"),
        (
            "SHM005",
            f'{LO}; unshare -m sh -c \'{SHM} size=1g; exec "$0" "$@"\' {NODE} {QUIET}; {LOADED}',
            f"{LO}; {NODE} {QUIET}; {LOADED}",
        ),
        ("SHM002", f"{SHM} size=64m", f"{SHM} size=1g"),
        ("SHM006", f"{SHM} size=1g,ro", f"{SHM} size=1g"),
        (
            "SHM003",
            f"{SHM} size=100m; head -c 99m /dev/zero > /dev/shm/full",
            f"{SHM} size=100m",
        ),
    ],
)
def test_namespaces(examiner: subprocess.Popen[str], id: str, faulty: str, cured: str) -> None:
    assert id in in_namespaces(examiner, faulty)
    assert id not in in_namespaces(examiner, cured)


def test_a_machine_without_a_network_has_no_finding_of_multicast(
    examiner: subprocess.Popen[str],
) -> None:
    findings = in_namespaces(examiner, LO)
    assert "NET003" in findings
    assert "NET002" not in findings


def test_programs_of_other_domains_are_not_accused(examiner: subprocess.Popen[str]) -> None:
    apart = f'unshare -m sh -c \'{SHM} size=1g; exec "$0" "$@"\' {NODE} {QUIET}; {LOADED}'
    assert "SHM005" in in_namespaces(examiner, f"{LO}; {apart}")
    assert "SHM005" not in in_namespaces(examiner, f"{LO}; export ROS_DOMAIN_ID=5; {apart}")


def can_unshare() -> bool:
    """Return whether namespaces can be made."""
    completed = subprocess.run(["unshare", "-rnm", "true"], capture_output=True, check=False)
    return completed.returncode == 0


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can give files to another user")
def test_segments_of_another_user() -> None:
    path = Path("/dev/shm") / f"fastrtps_{os.getpid()}_webviz_test"
    gone = path.with_name(f"{path.name}_gone")  # after it was listed, as that of a node that ends
    path.touch()
    gone.symlink_to("nowhere")
    try:
        assert "SHM001" not in examined()
        os.chown(path, 65534, -1)
        assert "SHM001" in examined()
    finally:
        path.unlink()
        gone.unlink()


SATURATE = """
import array, fcntl, os, socket, struct, subprocess, sys, threading, time
import webviz.engine.machine.interfaces as interfaces
from webviz.engine.machine.environment import look_around
from webviz.shell.doctor.examination import examine_machine
from webviz.shell.doctor.report import to_json

TUNSETIFF, IFF_TAP, IFF_NO_PI = 0x400454CA, 2, 0x1000
SIOCETHTOOL, GET, SET, SPEED_AT = 0x8946, 1, 2, 12
mbits, is_read, packets = map(int, sys.argv[1:])
tap = os.open("/dev/net/tun", os.O_RDWR)
fcntl.ioctl(tap, TUNSETIFF, struct.pack("16sH", b"eth9", IFF_TAP | IFF_NO_PI))
for command in (
    "address add 192.0.2.9/24 dev eth9",
    "link set eth9 up txqueuelen 50",
    "neighbour add 192.0.2.10 lladdr 02:00:00:00:00:01 dev eth9",
):
    subprocess.run(["ip", *command.split()], check=True)
sender = socket.socket(type=socket.SOCK_DGRAM)
settings = array.array("B", bytes(44))
request = struct.pack("16sQ", b"eth9", settings.buffer_info()[0])
struct.pack_into("I", settings, 0, GET)
fcntl.ioctl(sender, SIOCETHTOOL, request)
struct.pack_into("I", settings, 0, SET)
struct.pack_into("H", settings, SPEED_AT, mbits)
fcntl.ioctl(sender, SIOCETHTOOL, request)


def read():
    while is_read:
        os.read(tap, 2000)


threading.Thread(target=read, daemon=True).start()
interfaces.LEAST_S = 0.0
before = look_around()
until = time.monotonic() + 0.3
for sent in range(packets):
    sender.sendto(bytes(1000), ("192.0.2.10", 9))
while time.monotonic() < until:
    time.sleep(0.01)
print(to_json(examine_machine(look_around(before=before))))
"""


@pytest.mark.skipif(not os.access("/dev/net/tun", os.W_OK), reason="there is no /dev/net/tun")
@pytest.mark.parametrize(
    ("mbits", "is_read", "packets", "is_found"),
    [
        pytest.param(1, 1, 3000, True, id="full"),
        pytest.param(10_000, 0, 3000, True, id="drops"),
        pytest.param(10_000, 1, 40, False, id="quiet"),
    ],
)
def test_a_saturated_link(mbits: int, is_read: int, packets: int, is_found: bool) -> None:
    assert can_unshare(), "This machine has no network namespaces for users."
    numbers = map(str, (mbits, is_read, packets))
    program = ["unshare", "-rn", sys.executable, "-c", SATURATE, *numbers]
    completed = subprocess.run(program, capture_output=True, text=True, check=True)
    report = msgspec.json.decode(completed.stdout, type=DoctorReport)
    assert ("NET012" in {each.id for each in report.findings}) == is_found
