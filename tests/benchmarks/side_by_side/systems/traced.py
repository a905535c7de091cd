"""webviz with a trace of its slow steps, for `side_by_side.tail`.

    python -m side_by_side.systems.traced STEPS ARGUMENT...

It writes a line to STEPS for each step of `SLOW_S` or more: its end in nanoseconds since 1970, the
milliseconds it took, its thread, and what it was. Steps are calls behind the error boundary, its
turns, callbacks of the server's event loop, imports, collections of garbage, and those of a thread
that sleeps for 1 ms again and again: it waits when the others hold the interpreter, or the machine
is busy.
"""

from __future__ import annotations

import builtins
import functools
import gc
import sys
import threading
import time
from asyncio import events
from collections.abc import Callable
from pathlib import Path
from typing import Any, TextIO

SLOW_S = 0.008
BEAT_S = 0.001


class Trace:
    """Notes slow steps.

    Args:
        file: where to.
    """

    def __init__(self, file: TextIO) -> None:
        self._file = file
        self._collecting = 0.0

    def note(self, what: str, began: float) -> None:
        """Note a step that began at a monotonic time in seconds, if it was slow."""
        took = time.perf_counter() - began
        if took >= SLOW_S:
            thread = threading.current_thread().name
            self._file.write(f"{time.time_ns()}\t{1e3 * took:.1f}\t{thread}\t{what}\n")
            self._file.flush()

    def follow(self, owner: Any, name: str, what: Callable[..., str]) -> None:
        """Note the slow calls of a function; `what` names one by its arguments."""
        call = getattr(owner, name)

        @functools.wraps(call)
        def timed(*args: Any, **named: Any) -> Any:
            began = time.perf_counter()
            try:
                return call(*args, **named)
            finally:
                self.note(what(*args), began)

        setattr(owner, name, timed)

    def collect(self, phase: str, info: dict[str, int]) -> None:
        """Note a collection of garbage."""
        if phase == "start":
            self._collecting = time.perf_counter()
        else:
            self.note(f"garbage of generation {info['generation']}", self._collecting)

    def beat(self) -> None:
        """Note when a sleep takes too long."""
        while True:
            began = time.perf_counter()
            time.sleep(BEAT_S)
            self.note("a sleep of 1 ms", began)


def _hook(boundary: object, scope: str, call: Callable[..., Any], *_: Any) -> str:
    return f"{scope}: {getattr(call, '__qualname__', call)}"


def main(steps: str, *arguments: str) -> None:
    """Run webviz until it is ended."""
    with Path(steps).open("w") as file:
        follow(Trace(file))
        from webviz.shell.cli import program

        sys.argv = ["webviz", *arguments]
        program()


def follow(trace: Trace) -> None:
    """Note the slow steps of webviz."""
    from webviz.engine.error_boundary import ErrorBoundary
    from webviz.engine.loop.loop import FrameLoop

    trace.follow(ErrorBoundary, "__call__", _hook)
    trace.follow(FrameLoop, "_advance", lambda loop: "a turn")
    trace.follow(events.Handle, "_run", lambda handle: f"a callback: {handle!r:.150}")
    trace.follow(builtins, "__import__", lambda name, *_: f"import {name}")
    gc.callbacks.append(trace.collect)
    threading.Thread(target=trace.beat, daemon=True, name="heartbeat").start()


if __name__ == "__main__":
    main(*sys.argv[1:])
