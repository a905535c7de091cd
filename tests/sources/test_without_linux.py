"""Imports of parts that run without ROS: none is of a module that only Linux has."""

from __future__ import annotations

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
