"""What runs without ROS imports nothing that only Linux has."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from bags import Bag, ns

ONLY_UNIX = (
    "fcntl",
    "grp",
    "pwd",
    "resource",
    "syslog",
    "termios",
    "tty",
    "pty",
)
PROGRAM = """
import sys
for name in sys.argv[2].split(","):
    sys.modules[name] = None  # importing it raises ImportError
import socket
for name in ("AF_UNIX", "AF_NETLINK", "AF_PACKET"):
    if hasattr(socket, name):
        delattr(socket, name)
sys.modules["rclpy"] = None

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
    bag.message("/words", ns(0.1), {"data": "hello"})
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
