"""Loading robots and meshes in a process that can be ended if it hangs or takes too much memory."""

from __future__ import annotations

import atexit
import contextlib
import multiprocessing
import signal
import subprocess
import sys
import threading
from dataclasses import dataclass
from typing import Any

from webviz_urdf.glb import MeshContent
from webviz_urdf.resolve import Resolver
from webviz_urdf.robot import Robot, RobotDescriptionError

DEADLINE_S = 30.0
"""Per shape. The slowest of public robots takes 1 s on a desktop."""

START_S = 60.0
"""For a process to start and to read the description."""

IDLE_S = 60.0
"""Idle time before a process for robots ends; its imports take as long as a robot does."""

MAX_MEMORY = 3 << 30
"""Bytes of address space of a process; half a gigabyte of it is taken by its imports."""

MAX_FAILURES = 3
"""Shapes that may end the process before loading gives up."""


@dataclass(frozen=True)
class LoadRequest:
    """A robot, mesh or picture to load; equal requests give equal results.

    Args:
        text: URDF, if it came as a message.
        path: of the file, if it did not.
        changed_ns: when the file was last written, 0 if unknown.
        package_paths: folders that hold ROS packages.
        collisions: whether to read collision shapes.
        mesh: URI of a mesh to load instead of a robot.
        picture: URI of a picture to load instead.
        data: the content of the mesh or picture, if it came in a message; its URI is just a name.
    """

    text: str = ""
    path: str = ""
    changed_ns: int = 0
    package_paths: tuple[str, ...] = ()
    collisions: bool = False
    mesh: str = ""
    picture: str = ""
    data: bytes = b""


Loaded = Robot | MeshContent | bytes
"""A robot, a mesh, or a picture as PNG or JPEG."""


class LoadingStopped(Exception):
    """`Loading.stop` was called."""


class Loading:
    """Loads one robot or file; `run` blocks, the rest may be called from any thread."""

    def __init__(self, request: LoadRequest) -> None:
        self.at = (0, 0, "")
        """Shapes done, their total, and the current link."""
        self._request = request
        self._resolver = Resolver(package_paths=request.package_paths)
        self._stopped = threading.Event()
        self._process: _Process | None = None

    def run(self) -> Any:
        """Load what the request names, one of `Loaded`.

        Shapes of a robot at which the process hangs or ends are listed as missing.

        Raises:
            RobotDescriptionError: it cannot be drawn; one sentence says why.
            LoadingStopped: `stop` was called.
        """
        what = self._request.mesh or self._request.picture
        skip: dict[int, str] = {}
        while True:
            self._process = process = _take()
            try:
                robot = self._converse(process, skip)
            except _Ended as ended:
                process.end()
                if what:
                    raise RobotDescriptionError(f"Loading {what} failed. {ended}") from None
                done, total, link = self.at
                if done in skip or len(skip) == MAX_FAILURES or done == total:
                    where = f" It stopped at link '{link}'." if link else ""
                    raise RobotDescriptionError(
                        f"Loading the robot failed. {ended}{where}"
                    ) from None
                skip[done] = str(ended)
            except RobotDescriptionError:
                _keep(process)
                raise
            except BaseException:
                process.end()
                raise
            else:
                _keep(process)
                return robot

    def stop(self) -> None:
        """Stop loading: `run` raises `LoadingStopped`."""
        self._stopped.set()
        if process := self._process:
            process.kill()

    def _converse(self, process: _Process, skip: dict[int, str]) -> Loaded:
        try:
            process.connection.send((self._request, self._resolver, skip))
            patience = START_S
            while not self._stopped.is_set():
                if not process.connection.poll(patience):
                    raise _Ended(f"It took longer than {patience:g} s.")
                patience = DEADLINE_S
                answer = process.connection.recv()
                if isinstance(answer, Loaded):
                    return answer
                if isinstance(answer, Exception):
                    raise answer
                self.at = answer
        except (EOFError, OSError):
            if not self._stopped.is_set():
                raise _Ended("It ended the process that loads robots.") from None
        raise LoadingStopped


_PROGRAM = """
import sys
sys.modules["scipy"] = sys.modules["networkx"] = None
from webviz_urdf.loader import main
main()
"""
"""trimesh reads meshes without these two, whose import takes longer than loading most robots."""


class _Ended(Exception):
    """The process hangs or has ended."""


class _Process:
    """A process that loads one robot after another, until the connection is closed."""

    def __init__(self) -> None:
        self.connection, theirs = multiprocessing.Pipe()
        with theirs:
            number = theirs.fileno()
            self._process = subprocess.Popen(
                [sys.executable, "-P", "-c", _PROGRAM, str(number)],
                pass_fds=(number,),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
                process_group=0,  # Ctrl-C is for the parent; closing the connection ends it
            )

    def is_alive(self) -> bool:
        return self._process.poll() is None

    def kill(self) -> None:
        self._process.send_signal(signal.SIGKILL)

    def end(self) -> None:
        self.kill()
        self.connection.close()
        with contextlib.suppress(subprocess.TimeoutExpired):  # it may wait for a dead disk
            self._process.wait(1.0)


_spare: list[_Process] = []
_lock = threading.Lock()


def _take() -> _Process:
    """An idle process, or a new one."""
    with _lock:
        while _spare:
            process = _spare.pop()
            if process.is_alive():
                return process
            process.end()
    return _Process()


def _keep(process: _Process) -> None:
    """Keep one process for the next robot."""
    with _lock:
        if not _spare:
            _spare.append(process)
            return
    process.end()


@atexit.register
def _end_spare() -> None:
    with _lock:
        while _spare:
            _spare.pop().end()
