"""Exports in a process of its own, so that a viewer neither stutters nor grows meanwhile."""

from __future__ import annotations

import contextlib
import os
import select
import subprocess
import sys
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import IO

import msgspec

from webviz.api.errors import Error
from webviz.engine.parts.sharing import Exporter, SharedMoment

REST_S = 0.2
"""Between two looks whether the file is still wanted."""
NICE = 10
"""The viewer goes first."""
ENDING_S = 5.0


class ExportRequest(msgspec.Struct, frozen=True):
    """A file to make; the words of `SharedMoment`, and the files with plug-ins."""

    bag: str
    config: str
    path: str
    name: str
    at_s: float
    plugins: Sequence[str] = ()


class ExportProgress(msgspec.Struct, frozen=True, omit_defaults=True):
    """A line of the other process: the share that is done, or how it ended."""

    share: float | None = None
    done: str = ""
    problem: str = ""


def exporter(
    plugins: Sequence[Path], offer: Callable[[str, bytes], object] = lambda name, data: None
) -> Exporter:
    """Return an `Exporter` that starts a process for each file.

    Args:
        plugins: files to load there.
        offer: called with the name and the content of each file that was made.
    """

    def export(
        moment: SharedMoment, tell: Callable[[float], object], stopped: threading.Event
    ) -> str:
        files = [str(path.absolute()) for path in plugins]
        bag, config, path = (str(each) for each in (moment.bag, moment.config, moment.path))
        order = ExportRequest(bag, config, path, moment.name, moment.at_s, files)
        with _process(order) as process:
            for told in _lines(process, stopped):
                if told.problem:
                    raise Error(told.problem)
                if told.done:
                    offer(moment.path.name, moment.path.read_bytes())
                    return told.done
                tell(told.share or 0.0)
            if stopped.is_set():
                raise Error("Stopped.")
            status = process.wait()
        raise Error(
            f"The export ended unexpectedly, with status {status}. Save the moment as a bag, and "
            "try `webviz export` to see why."
        )

    return export


@contextlib.contextmanager
def _process(order: ExportRequest) -> Iterator[subprocess.Popen[bytes]]:
    """Start a process that makes a file; it ends with the block, whatever happens."""
    process = subprocess.Popen(
        [sys.executable, "-m", __name__],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
    )
    assert process.stdin is not None
    try:
        with contextlib.suppress(BrokenPipeError):
            process.stdin.write(msgspec.json.encode(order) + b"\n")
            process.stdin.flush()
        yield process
    finally:
        with contextlib.suppress(BrokenPipeError):
            process.stdin.close()  # which ends it
        try:
            process.wait(ENDING_S)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
        if process.stdout is not None:
            process.stdout.close()


def _lines(process: subprocess.Popen[bytes], stopped: threading.Event) -> Iterator[ExportProgress]:
    """Yield the lines of a process, until it ends or is not wanted any more."""
    assert process.stdout is not None
    rest = b""
    while not stopped.is_set():
        if not select.select([process.stdout], [], [], REST_S)[0]:
            continue
        data = os.read(process.stdout.fileno(), 1 << 16)
        if not data:
            return
        *whole, rest = (rest + data).split(b"\n")
        yield from (msgspec.json.decode(line, type=ExportProgress) for line in whole)


def main() -> None:
    """Make the file that standard input asks for, until that is closed."""
    out = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # nothing else may write between the lines
    os.nice(NICE)
    order = msgspec.json.decode(sys.stdin.buffer.readline(), type=ExportRequest)
    work = threading.Thread(target=_work, args=(order, out), daemon=True)
    work.start()
    threading.Thread(target=_end_with_input, daemon=True).start()
    work.join()


def _end_with_input() -> None:
    sys.stdin.buffer.read()
    os._exit(1)


def _work(order: ExportRequest, out: IO[bytes]) -> None:
    def tell(told: ExportProgress) -> None:
        out.write(msgspec.json.encode(told) + b"\n")
        out.flush()

    try:
        tell(ExportProgress(done=_make(order, lambda share: tell(ExportProgress(share)))))
    except Error as error:
        tell(ExportProgress(problem=str(error)))


def _make(order: ExportRequest, tell: Callable[[float], object]) -> str:
    from webviz.engine.pipeline import plugins
    from webviz.files.opening import parse
    from webviz.shell.bag_player import bag_player
    from webviz.shell.export.export import export
    from webviz.shell.export.order import ExportOrder

    for file in order.plugins:
        plugins.load(Path(file))
    text = Path(order.config).read_text(encoding="utf-8")
    with contextlib.closing(bag_player(Path(order.bag))) as source:
        run = ExportOrder(parse(text, "config.yaml"), source, order.bag, order.name, at=order.at_s)
        made = export(run, Path(order.path), tell)
    return " ".join([f"{made.seconds:.1f} s, {made.bytes / 1e6:.1f} MB.", *made.notes])


if __name__ == "__main__":
    main()
