"""The configs of `webviz demo`, and its simulated robots, which run in a process of their own."""

import contextlib
import importlib.util
import os
import subprocess
import sys
import tempfile
import threading
from collections.abc import Iterator, Sequence
from pathlib import Path

from webviz.api.errors import Error
from webviz.shell.cli.ending import Stop, kill
from webviz.shell.live_source import NO_ROS

DEMO, FLEET = (Path(__file__).with_name(name) for name in ("demo.yaml", "fleet.yaml"))
_NO_ROBOTS = "robots: []"
MAX_WITH_TOOLS = 8
"""Tools of more robots would push the others out of the toolbar."""
RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"
ONLY_LOCAL = (
    "webviz: only ROS nodes of this machine with the same DDS see the demo; "
    f"{RANGE}=SUBNET shows it to all others"
)
SPARE_S = 0.5
"""Time that the program keeps for itself when the simulator has to be killed."""


@contextlib.contextmanager
def standard_config(robots: int) -> Iterator[Path]:
    """Provide the file of a config for so many robots, during the block."""
    if robots == 1:
        yield DEMO
        return
    names = ", ".join(f"robot{number}" for number in range(1, robots + 1))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder, FLEET.name)
        displays_part, _, tools = FLEET.read_text().partition("tools:\n")
        if robots > MAX_WITH_TOOLS:
            some = range(1, MAX_WITH_TOOLS + 1)
            tools = "".join(tools.replace("{robot}", f"robot{number}") for number in some)
        path.write_text(
            displays_part.replace(_NO_ROBOTS, f"robots: [{names}]") + "tools:\n" + tools
        )
        yield path


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
    with _running(command, stop, "simulator"):
        yield ONLY_LOCAL if is_local else ""


@contextlib.contextmanager
def zenoh_simulator(arguments: Sequence[str], stop: Stop) -> Iterator[str]:
    """Run a Zenoh router and a simulator on it during the block; neither needs ROS.

    Args:
        arguments: of the simulator.
        stop: asks the program to stop.

    Yields:
        The endpoint of the router.

    Raises:
        Error: Zenoh is not installed, or one of them failed.
    """
    from webviz.sources.zenoh.engine import engine

    engine()
    module = "webviz_sim.zenoh_router"
    with _running([sys.executable, "-m", module], stop, "Zenoh router", subprocess.PIPE) as router:
        assert router.stdout is not None
        endpoint = router.stdout.readline().decode().strip()
        command = [sys.executable, "-m", "webviz_sim.zenoh_node", "--connect", endpoint]
        with _running([*command, *arguments], stop, "simulator"):
            yield endpoint


@contextlib.contextmanager
def _running(
    command: Sequence[str], stop: Stop, name: str, stdout: int | None = None
) -> Iterator[subprocess.Popen[bytes]]:
    """Run a program during the block, and stop this one if it fails."""
    program = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=stdout, process_group=0)
    stop.then(program.terminate)

    failed: list[int] = []
    is_over = threading.Event()

    def watch() -> None:
        status = program.wait()
        if status and not stop.is_asked and not is_over.is_set():
            failed.append(status)
            stop.ask()

    watcher = threading.Thread(target=watch, daemon=True)
    watcher.start()
    try:
        yield program
        if failed:
            raise Error(f"The {name} failed with exit status {failed[0]}.")
    finally:
        is_over.set()
        program.terminate()
        try:
            program.wait(max(0.0, stop.left_s - SPARE_S))
        except subprocess.TimeoutExpired:
            import psutil  # here, as it is seldom needed

            with contextlib.suppress(psutil.NoSuchProcess):  # it has ended meanwhile
                kill([psutil.Process(program.pid)])  # such as one that is still starting
        watcher.join()
        for pipe in (program.stdin, program.stdout):
            if pipe is not None:
                pipe.close()
