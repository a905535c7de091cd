"""Exports in a process of their own, so that a viewer neither stutters nor grows meanwhile."""

from __future__ import annotations

import contextlib
import select
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.errors import Error
from webviz.engine.parts.part import HostProgram

PROGRAM = "webviz.shell.export.process"
"""Reads a line that says what to make, and writes lines of `_Progress`."""
REST_S = 0.2
"""Pause in seconds between two looks whether the file is still wanted."""
ENDING_S = 5.0


class SharedMoment(msgspec.Struct, frozen=True):
    """A recording to make a file of.

    Args:
        bag: MCAP file.
        config: YAML file.
        path: of the file to make, in a folder that is removed afterwards.
        name: of the config, for the page; "" for none.
        at_s: moment to begin with, in seconds from the start of the bag.
    """

    bag: Path
    config: Path
    path: Path
    name: str
    at_s: float


class _Progress(msgspec.Struct, frozen=True):
    """A line of the other process: the share that is done, or how it ended."""

    share: float = 0.0
    done: str = ""
    problem: str = ""


def export(
    moment: SharedMoment,
    host: HostProgram,
    progress: Callable[[float], object],
    stopped: threading.Event,
) -> str:
    """Make the file in any thread; returns its length and size as the end of a sentence.

    Args:
        moment: to make a file of.
        host: gets the file, and has the plug-ins that are loaded.
        progress: called with the share that is done.
        stopped: set once the file is not wanted any more.

    Raises:
        Error: one sentence.
    """
    assert host.offer is not None
    files = [str(path.absolute()) for path in host.plugins]
    bag, config, path = (str(each) for each in (moment.bag, moment.config, moment.path))
    words = {"bag": bag, "config": config, "path": path}
    order = words | {"name": moment.name, "at_s": moment.at_s, "plugins": files}
    with _process(order) as process:
        for line in _lines(process, stopped):
            if line.problem:
                raise Error(line.problem)
            if line.done:
                host.offer(moment.path.name, moment.path.read_bytes())
                return line.done
            progress(line.share)
        if stopped.is_set():
            raise Error("Stopped.")
        status = process.wait()
    raise Error(
        f"The export ended unexpectedly, with status {status}. Save the moment as a bag, and "
        "try `webviz export` to see why."
    )


@contextlib.contextmanager
def _process(order: Mapping[str, Any]) -> Iterator[subprocess.Popen[bytes]]:
    """Start a process that makes a file; it ends with the block, whatever happens."""
    with subprocess.Popen(
        [sys.executable, "-m", PROGRAM],
        bufsize=0,  # so that `select` sees all that is left to read
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    ) as process:
        assert process.stdin is not None
        try:
            with contextlib.suppress(BrokenPipeError):
                process.stdin.write(msgspec.json.encode(order) + b"\n")
            yield process
        finally:
            process.stdin.close()  # which ends it
            try:
                process.wait(ENDING_S)
            except subprocess.TimeoutExpired:
                process.kill()


def _lines(process: subprocess.Popen[bytes], stopped: threading.Event) -> Iterator[_Progress]:
    """Yield the lines of a process, until it ends or is not wanted any more."""
    assert process.stdout is not None
    while not stopped.is_set():
        if select.select([process.stdout], [], [], REST_S)[0]:
            line = process.stdout.readline()
            if not line.endswith(b"\n"):
                return
            yield msgspec.json.decode(line, type=_Progress)
