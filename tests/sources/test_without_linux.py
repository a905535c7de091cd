"""Imports of parts that run without ROS: none is of a module that only Linux has."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

from bags import Bag

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
PROGRAM = """
import builtins
import sys

blocked, usual = set(sys.argv[2].split(",")), builtins.__import__

def importing(name, variables=None, *rest):
    # Libraries of others know their systems themselves.
    if name in blocked and (variables or {}).get("__name__", "").startswith("webviz"):
        raise ImportError(f"{name} is blocked")
    return usual(name, variables, *rest)

builtins.__import__ = importing

from pathlib import Path
import webviz
import webviz.shell.cli.commands
import webviz.shell.cli.serving
import webviz.sources.bridge.source
from webviz.sources.bridge.address import address
from webviz.shell.app.bag_config import config_of
from webviz.shell.bag_source import bag_source
from webviz.engine.loop import FrameLoop
from webviz.shell.doctor.scene import NoScene

bag = bag_source(Path(sys.argv[1]))
loop = FrameLoop(config_of(bag), bag, NoScene())
loop.turn()
print(*sorted(bag.offers()))
loop.close()
bridge = webviz.sources.bridge.source.BridgeSource(address("ws://127.0.0.1:9"))
bridge.close()
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
"""
LOADING = """
from webviz_urdf.loading import Loading, LoadRequest

box = "<link name='l'><visual><geometry><box size='1 1 1'/></geometry></visual></link>"
robot = Loading(LoadRequest(text=f"<robot name='r'>{box}</robot>")).run()
print(*robot.links)
"""


def test_a_robot_is_loaded_without_modules_and_files_of_linux(tmp_path: Path) -> None:
    # The process that loads robots is one of its own, which imports this, too.
    site = tmp_path / "sitecustomize.py"
    site.write_text(f"BLOCKED = {ONLY_UNIX!r}\n{SITE}")
    done = subprocess.run(
        [sys.executable, "-c", LOADING],
        env={**os.environ, "PYTHONPATH": str(tmp_path)},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["l"]


def test_a_bag_is_opened_without_modules_of_linux(tmp_path: Path) -> None:
    bag = Bag()
    bag.add("/words", "std_msgs/msg/String")
    bag.put(0.1, "/words", {"data": "hello"})
    path = bag.write(tmp_path / "run.mcap")
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, str(path), ",".join(ONLY_UNIX)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["/words"]
