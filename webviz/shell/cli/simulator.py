"""The simulated robot of `webviz demo`, in its own process."""

import contextlib
import importlib.util
import os
import subprocess
import sys
import threading
from collections.abc import Iterator, Sequence

from webviz.api.errors import Error
from webviz.shell.cli.ending import Stop, kill
from webviz.shell.ros_source import NO_ROS

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
ONLY_LOCAL = (
    "webviz: only ROS nodes of this machine with the same DDS see the demo; "
    f"{RANGE}=SUBNET shows it to all others"
)
SPARE_S = 0.5
"""Time that the program keeps for itself when the simulator has to be killed."""


@contextlib.contextmanager
def simulator(ros: Sequence[str], stop: Stop) -> Iterator[str]:
    """Run the simulator during the block, and stop the program if it fails.

    The simulator stops when its standard input closes, so it never outlives this program. Ctrl-C in
    a terminal does not reach it.

    Yields:
        A sentence on who sees it, or "".

    Raises:
        Error: ROS is missing, or the simulator failed.
    """
    if importlib.util.find_spec("rclpy") is None:
        raise Error(NO_ROS.format(version=sys.version.split()[0]))
    # Keep the demo on this machine unless the environment says otherwise.
    is_local = os.environ.setdefault(RANGE, "LOCALHOST") == "LOCALHOST"
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
        yield ONLY_LOCAL if is_local else ""
        if failed:
            raise Error(f"The simulator failed with exit status {failed[0]}.")
    finally:
        simulator.terminate()
        try:
            simulator.wait(max(0.0, stop.left_s - SPARE_S))
        except subprocess.TimeoutExpired:
            import psutil  # here, as it is seldom needed

            with contextlib.suppress(psutil.NoSuchProcess):  # it has ended meanwhile
                kill([psutil.Process(simulator.pid)])  # such as one that is still starting
        watcher.join()
