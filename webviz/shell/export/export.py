"""Exports a part of a bag, as a config shows it, as one HTML file."""

from __future__ import annotations

import contextlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from webviz.api.errors import Error
from webviz.files.config import Config
from webviz.shell.export.about import about
from webviz.shell.export.file import RunFile
from webviz.shell.export.recorder import ExportSpan, RunRecorder
from webviz.shell.export.tape import Tape
from webviz.shell.pictures.files import writing
from webviz.shell.pictures.times import At, position_ns, seconds_from_start
from webviz.sources.bag.source import BagSource

RATE_HZ = 10.0


@dataclass(frozen=True)
class ExportOrder:
    """A file to make.

    Args:
        config: what to show.
        source: the bag.
        bag: its name, for errors.
        name: of the config, "" for none.
        first, last: of the span to record.
        rate_hz: frames per second of the bag.
    """

    config: Config
    source: BagSource
    bag: str
    name: str = ""
    first: At = "start"
    last: At = "end"
    rate_hz: float = RATE_HZ

    def span(self) -> ExportSpan:
        """The part of the bag to record.

        Raises:
            Error: it is outside of the bag, or empty.
        """
        first_ns, last_ns = (
            position_ns(at, self.source, self.bag) for at in (self.first, self.last)
        )
        if first_ns > last_ns:
            first_s, last_s = (seconds_from_start(at, self.source) for at in (first_ns, last_ns))
            raise Error(f"--from {first_s:g} s is later than --to {last_s:g} s. Swap them.")
        return ExportSpan(first_ns, last_ns, self.rate_hz)


@dataclass(frozen=True)
class ExportedFile:
    """A file that was made.

    Args:
        seconds, frames: of the run in it.
        bytes, client_bytes: its size, and that of the page without the run.
    """

    seconds: float
    frames: int
    bytes: int
    client_bytes: int


def export(
    order: ExportOrder, path: Path, tell: Callable[[float], object] = lambda share: None
) -> ExportedFile:
    """Write a file, or none if something fails.

    Args:
        order: what to write.
        path: of the file.
        tell: called with the share that is done.

    Raises:
        Error: the file cannot be written, or the bag cannot be read.
    """
    span = order.span()
    with writing(path) as file:
        made = RunFile(file)
        tape = Tape(made.write_chunk)
        with contextlib.closing(RunRecorder(order.config, order.source)) as recorder:
            for frame in recorder.frames(span, tell):
                tape.add(frame)
            tape.finish()
            settings, channel = recorder.viewer.loop.settings, recorder.channel
            facts = about(order.name, order.source, span, settings, channel, tape.index, ())
            made.finish(facts)
    seconds = (span.last_ns - span.first_ns) / 1e9
    return ExportedFile(seconds, len(span.times_ns()), made.bytes, made.client_bytes)
