"""Facts about a recorded run as a whole, which the page needs before its first frame."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import msgspec

from webviz.api.views import VIEW_TYPES, target_group
from webviz.engine.forms import form
from webviz.scene.cameras import placed
from webviz.scene.names import node_path
from webviz.server.channel.links import SlowLink
from webviz.server.channel.messages import Shell, StartView, Tools
from webviz.shell.export.order import ExportOrder
from webviz.shell.export.recorder import ExportSpan, RunRecorder
from webviz.shell.export.stores import RecordingChannel
from webviz.shell.export.tape import ChunkIndex


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
    greeting = [channel.kept.get(kind) for kind in (Shell, Tools)]
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
    found: dict[str, Any] = {}
    for topic, counts in channel.content("recorded").items():
        begin, end = _buckets(len(counts), low, high, first_s, last_s)
        found[topic] = counts[begin:end]
    return found


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
