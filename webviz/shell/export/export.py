"""Export of a part of a bag, as a config shows it, as one HTML file."""

from __future__ import annotations

import base64
import contextlib
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import IO, Any

import msgspec

from webviz.api.errors import UsageError
from webviz.api.views import VIEW_TYPES, target_group
from webviz.engine.forms import form
from webviz.scene.cameras import placed
from webviz.scene.constants import CONSTANTS
from webviz.scene.names import node_path
from webviz.server.channel.links import SlowLink
from webviz.server.channel.messages import Shell, StartView, Tools
from webviz.server.channel.modules import Modules
from webviz.server.http.viser_page import client_page, with_head
from webviz.shell.export.limit import SizeLimit
from webviz.shell.export.order import ExportOrder
from webviz.shell.export.recorder import ExportSpan, RunRecorder
from webviz.shell.export.stores import RecordingChannel
from webviz.shell.export.tape import ChunkIndex, ExportWriter
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
"""Policy like the server's (`webviz.server.http.requests.add_policy`), without any server."""
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
        run_file = RunFile(file)
        if order.max_bytes < run_file.client_bytes:
            raise UsageError(
                f"--max-size is less than the {run_file.client_bytes / 1e6:.1f} MB of the page "
                "itself. Choose a larger one."
            )
        limit = SizeLimit(order.max_bytes, (span.last_ns - span.first_ns) / 1e9)
        tape = ExportWriter(run_file.write_chunk, limit, run_file.bytes)
        with contextlib.closing(RunRecorder(order.config, order.source)) as recorder:
            for frame in recorder.frames(span, tell):
                tape.add(frame)
            tape.finish()
            facts = about(order, span, recorder, tape.index, limit.notes())
            run_file.finish(facts)
    seconds = (span.last_ns - span.first_ns) / 1e9
    frames = sum(len(chunk.times) for chunk in tape.index)
    return ExportedFile(seconds, frames, run_file.bytes, run_file.client_bytes, limit.notes())


def about(
    order: ExportOrder,
    span: ExportSpan,
    recorder: RunRecorder,
    index: Sequence[ChunkIndex],
    notes: Sequence[str],
) -> Mapping[str, Any]:
    """Return the facts that a file has about its run.

    Args:
        order: of the file.
        span: of the bag that is recorded.
        recorder: after the last frame.
        index: of the chunks.
        notes: sentences on what was left out.
    """
    history, channel = order.source.history, recorder.channel
    settings, frames = recorder.viewer.loop.settings, recorder.followed
    first_s = (span.first_ns - history.start_ns) / 1e9
    last_s = (span.last_ns - history.start_ns) / 1e9
    greeting = [channel.last_messages.get(kind) for kind in (Shell, Tools)]
    return {
        "names": history.names,
        "start": span.first_ns / 1e9,
        "duration": last_s - first_s,
        "at": order.begin_s(span),
        "index": [msgspec.to_builtins(each) for each in index],
        "greeting": [
            *filter(None, greeting),
            placed(StartView, settings.view, 0),
            *([SlowLink(" ".join(notes))] if notes else []),
        ],
        "views": {name: msgspec.to_builtins(view) for name, view in settings.views.items()},
        "view_forms": {name: form(view) for name, view in VIEW_TYPES.items()},
        "frame_nodes": {frame: node_path(target_group(frame)) for frame in frames},
        "stores": {
            "file": {"path": order.name, "is_changed": False, "folder": "", "others": []},
            "density": _density(channel.content("density"), first_s, last_s),
            "recorded": _recorded(channel, first_s, last_s),
            "bookmarks": _bookmarks(channel.content("bookmarks"), first_s, last_s),
            "events": _events(channel.content("events"), first_s, last_s),
        },
    }


def _density(density: Mapping[str, Any], first_s: float, last_s: float) -> Mapping[str, Any]:
    low, high = density.get("first", 0.0), density.get("last", 0.0)
    counts = density.get("counts", [])
    begin, end = _buckets(len(counts), low, high, first_s, last_s)
    width = (high - low) / max(1, len(counts))
    return {
        "counts": counts[begin:end],
        "first": low + begin * width - first_s,
        "last": low + end * width - first_s,
    }


def _recorded(channel: RecordingChannel, first_s: float, last_s: float) -> Mapping[str, Any]:
    density = channel.content("density")
    low, high = density.get("first", 0.0), density.get("last", 0.0)
    recorded: dict[str, Any] = {}
    for topic, counts in channel.content("recorded").items():
        begin, end = _buckets(len(counts), low, high, first_s, last_s)
        recorded[topic] = counts[begin:end]
    return recorded


def _buckets(count: int, low: float, high: float, first_s: float, last_s: float) -> tuple[int, int]:
    """Return the first part of a span that has seconds of another one, and the one after it."""
    if high <= low:
        return 0, count
    share = count / (high - low)
    return (
        max(0, math.floor((first_s - low) * share)),
        min(count, math.ceil((last_s - low) * share)),
    )


def _bookmarks(bookmarks: Mapping[str, Any], first_s: float, last_s: float) -> Mapping[str, Any]:
    all_ = bookmarks.get("all", [])
    return {"all": [[n, at - first_s] for n, at in all_ if first_s <= at <= last_s]}


def _events(events: Mapping[str, Any], first_s: float, last_s: float) -> Mapping[str, Any]:
    return {
        kind: [[at - first_s, *rest] for at, *rest in all_ if first_s <= at <= last_s]
        for kind, all_ in events.items()
    }
