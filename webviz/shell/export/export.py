"""Export of a part of a bag, as a config shows it, as one HTML file."""

from __future__ import annotations

import base64
import contextlib
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import IO, Any

import msgspec

from webviz.api.errors import UsageError
from webviz.scene.constants import CONSTANTS
from webviz.server.channel.modules import Modules
from webviz.server.http.viser_page import client_page, with_head
from webviz.shell.export.about import about
from webviz.shell.export.limit import SizeLimit
from webviz.shell.export.order import ExportOrder
from webviz.shell.export.recorder import RunRecorder
from webviz.shell.export.tape import Tape
from webviz.shell.pictures.files import writing

POLICY = "; ".join(
    (
        "default-src 'none'",
        "script-src 'unsafe-inline' 'unsafe-eval' blob: data:",
        "worker-src blob:",
        "style-src 'unsafe-inline'",
        "img-src data: blob:",
        "font-src data:",
        "connect-src data: blob:",
        "base-uri 'none'",
        "form-action 'none'",
    )
)
"""As the server's (`webviz.server.http.requests.add_policy`), without any server."""
HEAD = f'<meta http-equiv="Content-Security-Policy" content="{POLICY}">\n'
END = b"</body>"
LINE = 3 << 18
"""Bytes that are encoded at once; a multiple of three, so that none of the text is padding."""


class RunFile:
    """Writes the file piece by piece; nothing of the recording is in it but as base64.

    Args:
        file: to write to.
    """

    def __init__(self, file: IO[bytes]) -> None:
        self._file = file
        own = (resources.files("webviz.shell.export") / "head.html").read_bytes()
        page = with_head(client_page(), HEAD.encode() + own + Modules(CONSTANTS).head)
        start, end, rest = page.rpartition(END)
        self._rest = end + rest
        file.write(start)
        self.client_bytes = len(page)
        """Size of everything but the recording."""
        self.bytes = len(page)
        """Size so far."""

    def write_chunk(self, packed: bytes) -> int:
        """Add a chunk of the tape; the size of the file with it."""
        self._write("chunk", packed)
        return self.bytes

    def finish(self, about: Mapping[str, Any]) -> None:
        """End the file.

        Args:
            about: the index of the chunks, and what holds for the run as a whole.
        """
        self._write("about", msgspec.json.encode(about))
        self._file.write(self._rest)

    def _write(self, kind: str, data: bytes) -> None:
        for part in (f'<script type="webviz/{kind}">'.encode(), *_text(data), b"</script>\n"):
            self._file.write(part)
            self.bytes += len(part)


def _text(data: bytes) -> Iterator[bytes]:
    for start in range(0, len(data), LINE):
        yield base64.b64encode(data[start : start + LINE])


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
