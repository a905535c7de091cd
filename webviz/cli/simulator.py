"""The simulated robot of `webviz demo`, in a process of its own."""

from __future__ import annotations

import contextlib
import importlib.util
import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence

from webviz.app.running import NO_ROS
from webviz.errors import Error


@contextlib.contextmanager
def simulator(ros: Sequence[str]) -> Iterator[None]:
    """Run the simulator in a process of its own; if it ends by itself, so do we."""
    _ros_is_there()
    # The demo stays on this machine unless the environment says otherwise.
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    simulator = subprocess.Popen([sys.executable, "-m", "webviz_sim", *ros])
    ended = False

    def watch() -> None:
        if simulator.wait() and not ended:
            os.kill(os.getpid(), signal.SIGTERM)

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
        status = simulator.poll()
        if status:
            raise Error(f"the simulator ended by itself with status {status}.")
    finally:
        ended = True
        simulator.terminate()
        try:
            simulator.wait(timeout=5.0)
        except subprocess.TimeoutExpired:
            simulator.kill()
        watcher.join()


def _ros_is_there() -> None:
    if importlib.util.find_spec("rclpy") is None:
        raise Error(NO_ROS.format(version=sys.version.split()[0]))
