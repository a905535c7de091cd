"""A viewer and a robot in networks that only a router and a discovery server connect."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import sysconfig
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from program import Program

pytest.importorskip("rclpy", reason="rclpy is not installed", exc_type=ImportError)

SCRIPTS = Path(sysconfig.get_path("scripts"))
PORT = "11811"
VIEWER = """\
import time, webviz
print("ready", flush=True)
with webviz.Viewer(port=0) as viewer:
    while True:
        print(viewer["LaserScan"].statuses["Topic"].text, flush=True)
        time.sleep(0.1)
"""
NOTHING = "No publisher on /scan"
ARRIVES = r"\d+ messages at [\d.]+ Hz, .* from /sim"


def ip(command: str) -> None:
    subprocess.run(["ip", *command.split()], check=True, capture_output=True, timeout=20)


class Networks:
    """Namespaces of the kernel: "viewer" and "robot", each with a cable to "router"."""

    def __init__(self) -> None:
        tag = f"{os.getpid():x}"
        self._names = {who: f"webviz-{who}-{tag}" for who in ("router", "viewer", "robot")}
        self.routers = {"viewer": "10.77.1.1", "robot": "10.77.2.1"}
        """The address of the router in each network."""
        for name in self._names.values():
            ip(f"netns add {name}")
            ip(f"-n {name} link set lo up")
        router = self._names["router"]
        for number, (who, address) in enumerate(self.routers.items()):
            name, near, far = self._names[who], f"wv{number}{tag}", f"wr{number}{tag}"
            ip(f"link add {near} netns {name} type veth peer name {far} netns {router}")
            ip(f"-n {name} addr add {address[:-1]}2/24 dev {near}")
            ip(f"-n {router} addr add {address}/24 dev {far}")
            ip(f"-n {name} link set {near} up")
            ip(f"-n {router} link set {far} up")
            ip(f"-n {name} route add default via {address}")
        self.run("router", "sysctl", "-qw", "net.ipv4.ip_forward=1")

    def within(self, who: str, *command: str) -> list[str]:
        """A command that runs in a network."""
        return ["ip", "netns", "exec", self._names[who], *command]

    def run(self, who: str, *command: str) -> None:
        subprocess.run(self.within(who, *command), check=True, capture_output=True, timeout=20)

    def close(self) -> None:
        for name in self._names.values():
            subprocess.run(["ip", "netns", "del", name], check=False, capture_output=True)


@pytest.fixture
def networks() -> Iterator[Networks]:
    if os.name != "posix" or os.geteuid() != 0 or not shutil.which("ip"):
        pytest.skip("networks of its own need root and iproute2")
    try:
        networks = Networks()
    except subprocess.CalledProcessError as error:
        pytest.skip(f"no networks can be made here: {error.stderr.decode().strip()}")
    yield networks
    networks.close()


@pytest.fixture
def discovery_server() -> tuple[list[str], dict[str, str]]:
    """The command that starts Fast DDS's server, and its environment."""
    path = f"{SCRIPTS}{os.pathsep}{os.environ['PATH']}"
    if (tool := shutil.which("fast-discovery-server", path=path)) is None:
        pytest.skip("fast-discovery-server is not installed")
    # `fastdds discovery` starts it, but does not pass on signals; 42 is its "server" in Fast DDS 3.
    packages = Path(sysconfig.get_path("purelib"))
    libraries = [SCRIPTS.parent / "lib", *packages.glob("ros_fast*.libs")]
    server = ["42"] if (packages / "ros_fastdds.libs").is_dir() else []
    before = os.environ.get("LD_LIBRARY_PATH", "")
    return [tool, *server, "-i", "0", "-p", PORT], {
        "LD_LIBRARY_PATH": os.pathsep.join([*map(str, libraries), *filter(None, [before])])
    }


@pytest.fixture
def start(networks: Networks, tmp_path: Path) -> Iterator[Callable[..., Program]]:
    """Start a command in a network; whatever runs at the end is ended."""
    programs: list[Program] = []

    def start(who: str, *command: str, **env: str) -> Program:
        own = {"PYTHONUNBUFFERED": "1", "ROS_DOMAIN_ID": "0", **env}
        log = tmp_path / f"{len(programs)}.txt"
        programs.append(Program(networks.within(who, *command), {**os.environ, **own}, log))
        return programs[-1]

    yield start
    for program in reversed(programs):
        program.end()


def test_a_discovery_server_connects_networks_without_multicast(
    networks: Networks,
    start: Callable[..., Program],
    discovery_server: tuple[list[str], dict[str, str]],
) -> None:
    at = {who: f"{address}:{PORT}" for who, address in networks.routers.items()}
    start("robot", sys.executable, "-m", "webviz_sim", ROS_DISCOVERY_SERVER=at["robot"])
    viewer = start(
        "viewer",
        *(sys.executable, "-c", VIEWER),
        ROS_DISCOVERY_SERVER=at["viewer"],
        ROS_SUPER_CLIENT="TRUE",
    )
    viewer.wait_for(NOTHING)
    command, env = discovery_server
    start("router", *command, **env)
    viewer.wait_for(ARRIVES)
