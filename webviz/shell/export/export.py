"""Export of a part of a bag, as a config shows it, as one HTML file."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Sequence
from pathlib import Path

import msgspec

from webviz.api.errors import UsageError
from webviz.shell.export.about import about
from webviz.shell.export.file import RunFile
from webviz.shell.export.limit import SizeLimit
from webviz.shell.export.order import ExportOrder
from webviz.shell.export.recorder import RunRecorder
from webviz.shell.export.tape import Tape
from webviz.shell.pictures.files import writing


class ExportedFile(msgspec.Struct, frozen=True):
    """A file that was made.

    Args:
        seconds, frames: of the run in it.
        bytes, client_bytes: its size, and that of the page without the run.
        notes: sentences on what was left out.
    """

    seconds: float
    frames: int
    bytes: int
    client_bytes: int
    notes: Sequence[str]


def export(
    order: ExportOrder, path: Path, tell: Callable[[float], object] = lambda share: None
) -> ExportedFile:
    """Write a file, or none if something fails.

    Args:
        order: what to write.
        path: of the file.
        tell: called with the share that is done.

    Raises:
        Error: the file cannot be written, the bag cannot be read, or the limit is too small.
    """
    span = order.span()
    order.begin_s(span)  # an error before the work
    with writing(path) as file:
        made = RunFile(file)
        if order.max_bytes < made.client_bytes:
            raise UsageError(
                f"--max-size is less than the {made.client_bytes / 1e6:.1f} MB of the page itself. "
                "Choose a larger one."
            )
        limit = SizeLimit(order.max_bytes, (span.last_ns - span.first_ns) / 1e9)
        tape = Tape(made.write_chunk, limit, made.bytes)
        with contextlib.closing(RunRecorder(order.config, order.source)) as recorder:
            for frame in recorder.frames(span, tell):
                tape.add(frame)
            tape.finish()
            facts = about(order, span, recorder, tape.index, limit.notes())
            made.finish(facts)
    seconds = (span.last_ns - span.first_ns) / 1e9
    frames = sum(len(chunk.times) for chunk in tape.index)
    return ExportedFile(seconds, frames, made.bytes, made.client_bytes, limit.notes())
