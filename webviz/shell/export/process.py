"""Exports in a process of its own, so that a viewer neither stutters nor grows meanwhile."""

from __future__ import annotations

import contextlib
import os
import sys
import threading
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import IO

import msgspec

from webviz.api.errors import Error

NICE = 10
"""The viewer goes first."""


class ExportRequest(msgspec.Struct, frozen=True):
    """A file to make of a bag and a config, and the files with plug-ins."""

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
    def tell(progress: ExportProgress) -> None:
        out.write(msgspec.json.encode(progress) + b"\n")
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
        exported = export(run, Path(order.path), tell)
    return " ".join([f"{exported.seconds:.1f} s, {exported.bytes / 1e6:.1f} MB.", *exported.notes])


if __name__ == "__main__":
    main()
