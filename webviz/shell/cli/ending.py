"""The end of the program on Ctrl-C, SIGTERM and SIGHUP: one line, and no process left.

No signal handler raises, because an exception in the middle of an import may be swallowed or
printed. Imports are few, because signals are handled only once this module is loaded.
"""

import contextlib
import errno
import faulthandler
import math
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, NoReturn

from webviz.data.names import readable

if TYPE_CHECKING:
    import psutil

INTERRUPTED = 130
PATIENCE_S = 3.0
"""Time from a signal until the program exits by force."""
CHILD_PATIENCE_S = 1.0
HUNG_S = 10.0
"""The same where no thread of Python runs any more."""


def on_signal(action: Callable[[], object]) -> None:
    """Call `action` in the main thread on the first signal. SIGHUP under `nohup` is ignored."""

    def handle(_: int, __: FrameType | None) -> None:
        for number in numbers:
            signal.signal(number, signal.SIG_IGN)
        action()

    numbers = [signal.SIGINT, signal.SIGTERM]
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        numbers.append(signal.SIGHUP)
    for number in numbers:
        signal.signal(number, handle)


def piped(command: Callable[[], int]) -> int:
    """Run a command; one whose output nothing reads any more ends quietly.

    Returns:
        Its exit status: 1 if its pipe was closed, as by `head`, and 0 if its terminal was.
    """
    try:
        status = command()
        sys.stdout.flush()
    except OSError as error:
        is_pipe = isinstance(error, BrokenPipeError)
        if not is_pipe and not _has_lost_terminal():
            raise
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return int(is_pipe)
    return status


def _has_lost_terminal() -> bool:
    try:
        os.get_terminal_size(sys.stdout.fileno())
    except OSError as error:
        return error.errno == errno.EIO  # else it never was one
    return False


def say(line: str) -> None:
    """Write a line to standard error, if that is still open; it may begin with a line break."""
    text = "\n".join(map(readable, line.split("\n")))
    with contextlib.suppress(OSError):
        os.write(sys.stderr.fileno(), f"{text}\n".encode(errors="replace"))


_has_said_end = threading.Lock()
"""Held once the line is written with which the program ends."""


def say_end(line: str) -> None:
    """Write the last line of the program; the first thread that wants to does."""
    if _has_said_end.acquire(blocking=False):
        say(line)


_unfinished = set[Path]()
"""Files that are being written beside those that they replace."""


@contextlib.contextmanager
def unfinished(path: Path) -> Iterator[None]:
    """Remove a file if the program exits by force within the block."""
    _unfinished.add(path)
    try:
        yield
    finally:
        _unfinished.discard(path)


def _exit(status: int) -> NoReturn:
    """Exit without unwinding any thread; child processes and unfinished files go with it."""
    end_children()
    for path in tuple(_unfinished):
        with contextlib.suppress(OSError):
            path.unlink(missing_ok=True)
    os._exit(status)


def leave() -> NoReturn:
    """Exit at once, ending child processes only."""
    say_end("webviz: interrupted.")
    _exit(INTERRUPTED)


def finish(status: int) -> NoReturn:
    """Exit without finalising the interpreter.

    That takes seconds with ROS on a busy machine, and waits for threads that hang.
    """
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):  # a closed pipe or terminal
            stream.flush()
    _exit(status)


def end_in_time() -> None:
    """Exit by force after `PATIENCE_S`, unless the program ends before.

    Fast DDS may wait for itself when a node is destroyed while another one is discovered, and rclpy
    does not let other threads run meanwhile; so there is a limit that needs none of them.
    """

    def end() -> None:
        time.sleep(PATIENCE_S)
        say(f"webviz: still busy after {PATIENCE_S:g} s; exiting by force.")
        _exit(1)

    threading.Thread(target=end, name="webviz-ending", daemon=True).start()
    faulthandler.dump_traceback_later(HUNG_S, exit=True, file=os.open(os.devnull, os.O_WRONLY))


def end_children() -> None:
    """Terminate all child processes and their children; kill those that do not exit."""
    try:
        os.waitid(os.P_ALL, 0, os.WEXITED | os.WNOHANG | os.WNOWAIT)
    except ChildProcessError:
        return
    import psutil  # here, as it takes a tenth of the time of --help

    children = psutil.Process().children(recursive=True)
    for child in children:
        with contextlib.suppress(psutil.NoSuchProcess):
            child.terminate()
    _, busy = psutil.wait_procs(children, CHILD_PATIENCE_S)
    if busy:
        kill(busy)


def kill(processes: "Sequence[psutil.Process]") -> None:
    """Kill processes, and remove the shared memory that those with ROS leave behind."""
    import psutil

    from webviz.ros.shared_memory import remove_unused, segments_of

    segments = {segment for process in processes for segment in segments_of(process.pid)}
    for process in processes:
        with contextlib.suppress(psutil.NoSuchProcess):
            process.kill()
    psutil.wait_procs(processes, CHILD_PATIENCE_S)
    remove_unused(segments)


class Stop:
    """A request to end the program, and what to do then."""

    def __init__(self) -> None:
        self._asked_s = math.inf
        self._holds = False
        self._actions: list[Callable[[], object]] = []

    @property
    def is_asked(self) -> bool:
        """Return whether the program was asked to end."""
        return self._asked_s < math.inf

    @property
    def left_s(self) -> float:
        """Time for what closes now: until the program exits by force, once it was asked to end."""
        passed = time.monotonic() - self._asked_s if self.is_asked else 0.0
        return max(0.0, PATIENCE_S - passed)

    def hold(self) -> bool:
        """Let the program close its resources itself from now on; False if it was asked to end."""
        self._holds = True
        return not self.is_asked

    def ask(self) -> None:
        """Ask the program to end, from any thread or a signal handler."""
        if self.is_asked:
            return
        self._asked_s = time.monotonic()
        end_in_time()
        for action in self._actions:
            action()
        if not self._holds:
            leave()

    def then(self, action: Callable[[], object]) -> None:
        """Call `action` when the program is asked to end; it may be called twice."""
        self._actions.append(action)
        if self.is_asked:
            action()


def until_signal(work: Callable[[Stop], int]) -> int:
    """Do `work` in a thread, so that signals are handled at any time; its exit status."""
    stop, ended = Stop(), Future[int]()
    on_signal(stop.ask)
    # The kernel may deliver a signal to another thread, which does not wake this one; Python then
    # writes to this pipe.
    reader, writer = os.pipe()
    os.set_blocking(writer, False)
    signal.set_wakeup_fd(writer, warn_on_full_buffer=False)

    def run() -> None:
        try:
            ended.set_result(work(stop))
        except BaseException as error:
            ended.set_exception(error)

    ended.add_done_callback(lambda _: os.write(writer, b"\0"))
    threading.Thread(target=run, name="webviz-command", daemon=True).start()
    while not ended.done():
        os.read(reader, 64)
    return ended.result()
