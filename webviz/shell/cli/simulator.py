"""The simulated robot of `webviz demo`, in a process of its own."""

import contextlib
import importlib.util
import os
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence

from webviz.api.errors import Error
from webviz.shell.cli.ending import Stop
from webviz.shell.ros_source import NO_ROS

PATIENCE_S = 2.0


@contextlib.contextmanager
def simulator(ros: Sequence[str], stop: Stop) -> Iterator[None]:
    """Run the simulator as long as the block; if it fails, the program is to end.

    It also ends when this program does, however that happens: its input is a pipe from here. Ctrl-C
    in a terminal does not reach it.

    Raises:
        Error: there is no ROS, or the simulator failed.
    """
    if importlib.util.find_spec("rclpy") is None:
        raise Error(NO_ROS.format(version=sys.version.split()[0]))
    # The demo stays on this machine unless the environment says otherwise.
    os.environ.setdefault("ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST")
    command = [sys.executable, "-m", "webviz_sim", "--until-stdin-closes", *ros]
    simulator = subprocess.Popen(command, stdin=subprocess.PIPE, process_group=0)
    stop.then(simulator.terminate)

    failed: list[int] = []

    def watch() -> None:
        status = simulator.wait()
        if status and not stop.is_asked:
            failed.append(status)
            stop.ask()

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield
        if failed:
            raise Error(f"the simulator ended by itself with status {failed[0]}.")
    finally:
        simulator.terminate()
        try:
            simulator.wait(PATIENCE_S)
        except subprocess.TimeoutExpired:
            simulator.kill()
        watcher.join()
