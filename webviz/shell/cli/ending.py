"""How a program ends on Ctrl-C, SIGTERM and a closed terminal: with one line, leaving nothing.

No handler raises: an exception in the middle of an import may be swallowed, or printed by whatever
it hits. Nothing here imports more than it must, since signals are heard from then on only.
"""

import contextlib
import os
import signal
import sys
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, wait
from types import FrameType
from typing import NoReturn

import psutil

INTERRUPTED = 130
PATIENCE_S = 3.0
"""From the signal to the end by force."""
CHILD_PATIENCE_S = 1.0
WAKE_S = 0.2


def on_signal(action: Callable[[], object]) -> None:
    """Call `action` in the main thread on the first signal; `nohup` stays in force."""

    def handle(_: int, __: FrameType | None) -> None:
        for number in numbers:
            signal.signal(number, signal.SIG_IGN)
        action()

    numbers = [signal.SIGINT, signal.SIGTERM]
    if signal.getsignal(signal.SIGHUP) is not signal.SIG_IGN:
        numbers.append(signal.SIGHUP)
    for number in numbers:
        signal.signal(number, handle)


def say(line: str) -> None:
    """Write a line to standard error, which may be gone with its terminal."""
    with contextlib.suppress(OSError):
        os.write(sys.stderr.fileno(), f"{line}\n".encode())


def leave() -> NoReturn:
    """End the program at once: right as long as it holds nothing but child processes."""
    say("webviz: interrupted.")
    end_children()
    os._exit(INTERRUPTED)


def finish(status: int) -> NoReturn:
    """End the program, which holds nothing any more.

    To take the interpreter apart, with ROS in it, takes seconds on a busy machine, and would wait
    for threads that hang.
    """
    for stream in (sys.stdout, sys.stderr):
        with contextlib.suppress(OSError):  # nobody reads it any more
            stream.flush()
    end_children()
    os._exit(status)


def end_in_time() -> None:
    """End the program by force after `PATIENCE_S`, unless it ends by itself before."""

    def end() -> None:
        time.sleep(PATIENCE_S)
        say(f"webviz: ended by force, still busy after {PATIENCE_S:g} s.")
        end_children()
        os._exit(1)

    threading.Thread(target=end, name="webviz-ending", daemon=True).start()


def end_children() -> None:
    """End all child processes, and theirs: by force if they do not."""
    children = psutil.Process().children(recursive=True)
    for number in (signal.SIGTERM, signal.SIGKILL):
        for child in children:
            with contextlib.suppress(psutil.NoSuchProcess):
                child.send_signal(number)
        _, children = psutil.wait_procs(children, CHILD_PATIENCE_S)


class Stop:
    """Whether the program is to end, and what has to be told of it."""

    def __init__(self) -> None:
        self._asked = threading.Event()
        self._holds = False
        self._actions: list[Callable[[], object]] = []

    @property
    def is_asked(self) -> bool:
        """Whether the program is to end."""
        return self._asked.is_set()

    def hold(self) -> bool:
        """From now on the program holds what has to be closed; false if it is to end instead."""
        self._holds = True
        return not self.is_asked

    def ask(self) -> None:
        """Let the program end, from any thread or a signal handler."""
        if self.is_asked:
            return
        self._asked.set()
        end_in_time()
        for action in self._actions:
            action()
        if not self._holds:
            leave()

    def then(self, action: Callable[[], object]) -> None:
        """Call `action` once the program is to end; it may be called twice."""
        self._actions.append(action)
        if self.is_asked:
            action()


def until_signal(work: Callable[[Stop], int]) -> int:
    """Do `work` in a thread, so that signals are heard whatever it is busy with.

    Returns:
        The exit status.

    Raises:
        Exception: what `work` raised.
    """
    stop, ended = Stop(), Future[int]()
    on_signal(stop.ask)

    def run() -> None:
        try:
            ended.set_result(work(stop))
        except BaseException as error:
            ended.set_exception(error)

    threading.Thread(target=run, name="webviz-command", daemon=True).start()
    # Another thread may be interrupted by a signal, which does not wake this one to handle it.
    while not ended.done():
        wait([ended], WAKE_S)
    return ended.result()
