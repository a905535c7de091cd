"""Loading robots and meshes in a process that can be ended if it hangs or takes too much memory."""

from __future__ import annotations

import atexit
import contextlib
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
from dataclasses import dataclass
from typing import Any

from webviz.data.memory import DECODING, OverBudgetError
from webviz_urdf.glb import MeshContent, PictureFile
from webviz_urdf.remote import with_remote_files
from webviz_urdf.resolve import Resolver
from webviz_urdf.robot import Robot, RobotDescriptionError

DEADLINE_S = 30.0
"""Time in seconds for a shape. The slowest of public robots takes 1 s on a desktop."""

START_S = 60.0
"""Time in seconds for a process to start and to read the description."""

IDLE_S = 60.0
"""Idle time before a process for robots ends; its imports take as long as a robot does."""

USUAL_MEMORY, MAX_MEMORY = 250_000_000, 750_000_000
"""Bytes of address space that a process may take beyond its imports: at first, then at most. Of 69
public robots three need more than the first."""
RESULT_SHARE = 6
"""One part in so many of that memory may be the result, of which this process has two copies while
it receives it."""

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


Loaded = Robot | MeshContent | PictureFile


class LoadingStopped(Exception):
    """`Loading.stop` was called."""


class Loading:
    """Loads one robot or file; `run` blocks, the rest may be called from any thread.

    Loading waits until there is memory for it, and so does a second attempt with more; the result
    counts as loaded until it is garbage (`webviz.data.memory`).
    """

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
        request = self._request
        if not request.data:
            named = request.text or request.mesh or request.picture
            self._resolver = with_remote_files(named, self._resolver)
        memory = USUAL_MEMORY
        skip: dict[int, str] = {}
        while True:
            try:
                return self._attempt(memory, skip)
            except MemoryError:
                if memory < (most := self._most()):
                    memory = most
                    continue
                reason = f"It exceeds the memory limit of {memory // 1_000_000} MB. Simplify it."
            except _Ended as ended:
                # A library may end the process where Python would raise a MemoryError.
                if ended.is_crash and memory < (most := self._most()):
                    memory = most
                    continue
                reason = str(ended)
            except OverBudgetError as error:
                name = self._name or "The robot"
                raise RobotDescriptionError(
                    f"{name} {error}. Simplify its meshes, or remove other displays with meshes."
                ) from None
            self._skip(reason, skip)

    def stop(self) -> None:
        """Stop loading: `run` raises `LoadingStopped`."""
        self._stopped.set()
        DECODING.wake()
        if process := self._process:
            process.kill()

    @property
    def _name(self) -> str:
        """The file that is requested, "" for a robot."""
        return self._request.mesh or self._request.picture

    def _most(self) -> int:
        """Return the bytes that a second attempt may take."""
        return min(MAX_MEMORY, _memory_within(DECODING.room, self._request))

    def _skip(self, reason: str, skip: dict[int, str]) -> None:
        """Add the shape at which loading failed to those that are skipped.

        Raises:
            RobotDescriptionError: there is none, or were too many.
        """
        if self._name:
            raise RobotDescriptionError(f"Loading {self._name} failed. {reason}")
        finished, total, link = self.at
        if finished in skip or len(skip) == MAX_FAILURES or finished == total:
            where = f" It stopped at link '{link}'." if link else ""
            raise RobotDescriptionError(f"Loading the robot failed. {reason}{where}")
        skip[finished] = reason

    def _attempt(self, memory: int, skip: dict[int, str]) -> Loaded:
        """Load in a process that may take so much memory.

        Raises:
            MemoryError: it needs more.
            _Ended: the process hangs or has ended.
            OverBudgetError: too much else is loaded.
        """
        with DECODING.take(_needed(memory, self._request), self._stopped):
            self._process = process = _take()
            is_usable = False
            try:
                result, size = self._converse(process, skip, memory)
                is_usable = memory <= USUAL_MEMORY  # else it keeps what it has taken
            except RobotDescriptionError:
                is_usable = True
                raise
            finally:
                _keep(process) if is_usable else process.end()
        DECODING.hold(result, 2 * size)  # as it is loaded, and as it is drawn
        return result

    def _converse(self, process: _Process, skip: dict[int, str], memory: int) -> tuple[Loaded, int]:
        """Return the answer of a process, and its size in bytes."""
        try:
            process.connection.send((self._request, self._resolver, skip, memory))
            patience = START_S
            while not self._stopped.is_set():
                if not process.connection.poll(patience):
                    raise _Ended(f"It took longer than {patience:g} s.")
                patience = DEADLINE_S
                data = process.connection.recv_bytes()
                answer = pickle.loads(data)
                if isinstance(answer, Loaded):
                    return answer, len(data)
                if isinstance(answer, Exception):
                    raise answer
                self.at = answer
        except (EOFError, OSError):
            if not self._stopped.is_set():
                reason = "It ended the process that loads robots."
                raise _Ended(reason, is_crash=not process.was_killed()) from None
        raise LoadingStopped


def _needed(memory: int, request: LoadRequest) -> int:
    """Bytes to take from the budget for a process that may take so many."""
    return memory + 2 * memory // RESULT_SHARE + 2 * len(request.data)


def _memory_within(room: int, request: LoadRequest) -> int:
    """Bytes that a process may take for `_needed` to be what there is room for."""
    return (room - 2 * len(request.data)) * RESULT_SHARE // (RESULT_SHARE + 2)


_PROGRAM = """
import sys
sys.modules["scipy"] = sys.modules["networkx"] = None
from webviz_urdf.loader import main
main()
"""
"""trimesh reads meshes without these two, whose import takes longer than loading most robots."""


class _Ended(Exception):
    """The process hangs or has ended.

    Args:
        reason: a sentence.
        is_crash: whether the process has crashed.
    """

    def __init__(self, reason: str, is_crash: bool = False) -> None:
        super().__init__(reason)
        self.is_crash = is_crash


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
                # Its threads would take address space on machines with many cores.
                env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
            )

    def is_alive(self) -> bool:
        return self._process.poll() is None

    def kill(self) -> None:
        self._process.send_signal(signal.SIGKILL)

    def was_killed(self) -> bool:
        """Return whether it was ended from outside, as by a system without memory."""
        with contextlib.suppress(subprocess.TimeoutExpired):
            return self._process.wait(1.0) == -signal.SIGKILL
        return True

    def end(self) -> None:
        self.kill()
        self.connection.close()
        with contextlib.suppress(subprocess.TimeoutExpired):  # it may wait for a dead disk
            self._process.wait(1.0)


_spare: list[_Process] = []
_lock = threading.Lock()


def _take() -> _Process:
    """Return an idle process, or a new one."""
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
def end_spare() -> None:
    """End the process that is kept for the next robot."""
    with _lock:
        while _spare:
            _spare.pop().end()
