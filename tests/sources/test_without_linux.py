"""Imports of parts that run without ROS: none is of a module that only Linux has."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest
from bags import Bag
from bridges import foxglove_server

ONLY_UNIX = (
    "fcntl",
    "grp",
    "pwd",
    "resource",
    "syslog",
    "termios",
    "tty",
    "pty",
    "rclpy",
)
ONLY_LINUX = (
    *("epoll", "eventfd", "fork", "memfd_create", "pidfd_open", "sched_getaffinity"),
    *("posix_fadvise", "copy_file_range", "splice", "getrandom", "O_PATH", "O_TMPFILE"),
    *("SO_BINDTODEVICE", "SO_PEERCRED", "SO_MARK", "SO_REUSEPORT", "AF_NETLINK", "AF_PACKET"),
    *("TCP_INFO", "TCP_QUICKACK", "TCP_CONGESTION", "TCP_USER_TIMEOUT", "TCP_MAXSEG"),
)
"""Names in os, select and socket."""
PROGRAM = """
import sys
from pathlib import Path
import webviz
import webviz.shell.cli.commands
import webviz.shell.cli.serving
from webviz.shell.app.bag_config import config_of
from webviz.sources.bag.history import BagHistory
from webviz.sources.player import Player
from webviz.engine.loop import FrameLoop
from webviz.shell.doctor.scene import NoScene

bag = BagHistory(Path(sys.argv[1]))
loop = FrameLoop(config_of(bag), Player(bag), NoScene())
loop.turn()
print(*sorted(bag.offers({})))
loop.close()

from webviz_urdf.loading import Loading, LoadRequest

# The process that loads robots is one of its own, which imports the same.
box = "<link name='l'><visual><geometry><box size='1 1 1'/></geometry></visual></link>"
robot = Loading(LoadRequest(text=f"<robot name='r'>{box}</robot>")).run()
print(*robot.links)
"""
VIEWING = """
import os
import select
import socket
import sys
import time

import psutil  # which asks for names of its system

for module in (os, select, socket):
    for name in ONLY_LINUX:
        vars(module).pop(name, None)

import webviz
from webviz.api.status import Level

def is_drawn():
    viewer.attend(60)
    return len(viewer) == 2 and all(each.status.level is Level.OK for each in viewer)

with webviz.Viewer(sys.argv[1], connect=sys.argv[2], port=0) as viewer:
    until = time.monotonic() + 60
    while not is_drawn() and time.monotonic() < until:
        time.sleep(0.05)
    print(*(each.status.level.name for each in viewer), viewer.statuses)
"""
VIEW = """\
version: 1
fixed_frame: odom
robots:
- {{namespace: r1, connection: "{0}", shared: [odom]}}
displays:
- {{type: LaserScan, topic: /scan}}
- {{type: LaserScan, topic: /r1/scan}}
"""

SITE = """
import builtins
import pathlib
import sys

usual, exists = builtins.__import__, pathlib.Path.exists
write_text = pathlib.Path.write_text

def importing(name, globals=None, *rest, **more):
    if name in BLOCKED and (globals or {}).get("__name__", "").startswith("webviz"):
        raise ImportError(f"{name} is blocked")
    return usual(name, globals, *rest, **more)

def writing(path, *rest, **more):
    if str(path).startswith("/proc/"):
        raise FileNotFoundError(str(path))
    return write_text(path, *rest, **more)

builtins.__import__ = importing
pathlib.Path.exists = lambda path, **more: (
    not str(path).startswith("/proc/") and exists(path, **more)
)
pathlib.Path.write_text = writing

def absent(event, found):
    if event != "open" or not str(found[0]).startswith(("/proc/", "/dev/shm")):
        return
    frame = sys._getframe(1)
    while frame:
        if frame.f_globals["__name__"].startswith("psutil"):
            return
        frame = frame.f_back
    raise FileNotFoundError(str(found[0]))

sys.addaudithook(absent)
"""


@pytest.fixture
def environment(tmp_path: Path) -> dict[str, str]:
    """The environment of a program without modules and files of Linux, and of all its processes."""
    site = tmp_path / "sitecustomize.py"
    site.write_text(f"BLOCKED = {ONLY_UNIX!r}\n{SITE}")
    return {**os.environ, "PYTHONPATH": str(tmp_path)}


def run(environment: dict[str, str], *words: str) -> str:
    completed = subprocess.run(
        [sys.executable, *words],
        env=environment,
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert completed.returncode == 0, completed.stderr
    return completed.stdout


def test_a_bag_is_opened_and_a_robot_loaded_without_modules_and_files_of_linux(
    environment: dict[str, str], tmp_path: Path
) -> None:
    bag = Bag()
    bag.add("/words", "std_msgs/msg/String")
    bag.put(0.1, "/words", {"data": "hello"})
    path = bag.write(tmp_path / "run.mcap")
    assert run(environment, "-c", PROGRAM, str(path)).split() == ["/words", "l"]


def test_bridges_are_shown_without_modules_files_and_calls_of_linux(
    environment: dict[str, str], tmp_path: Path
) -> None:
    config = tmp_path / "robots.yaml"
    program = f"ONLY_LINUX = {ONLY_LINUX!r}\n{VIEWING}"
    with foxglove_server() as server:
        config.write_text(VIEW.format(server.url))
        text = run(environment, "-c", program, str(config), server.url)
    assert text.startswith("OK OK"), text
