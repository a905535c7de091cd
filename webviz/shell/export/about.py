"""Facts about a recorded run as a whole, which the page needs before its first frame."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from typing import Any

import msgspec

from webviz.api.views import View
from webviz.files.config import Settings
from webviz.scene.cameras import placed
from webviz.server.channel.messages import PlaceCamera, Shell, StartView, Tools
from webviz.shell.export.recorder import ExportSpan
from webviz.shell.export.stores import RecordingChannel
from webviz.shell.export.tape import ChunkIndex
from webviz.sources.bag.source import BagSource


def about(
    name: str,
    source: BagSource,
    span: ExportSpan,
    settings: Settings,
    channel: RecordingChannel,
    index: Sequence[ChunkIndex],
    notes: Sequence[str],
) -> Mapping[str, Any]:
    """Return the facts that a file has about its run.

    Args:
        name: of the config, "" for none.
        source: the bag.
        span: of the bag that is recorded.
        settings: of the config.
        channel: with the stores after the last frame.
        index: of the chunks.
        notes: sentences on what was left out.
    """
    first_s = (span.first_ns - source.start_ns) / 1e9
    last_s = (span.last_ns - source.start_ns) / 1e9
    greeting = [channel.kept.get(kind) for kind in (Shell, Tools)]
    return {
        "names": source.names,
        "start": span.first_ns / 1e9,
        "duration": last_s - first_s,
        "index": [msgspec.to_builtins(each) for each in index],
        "greeting": [*filter(None, greeting), placed(StartView, settings.view, 0)],
        "views": {view: _place(each) for view, each in settings.views.items()},
        "stores": {
            "file": {"path": name, "is_changed": False, "folder": "", "others": []},
            "density": _density(channel.content("density"), first_s, last_s),
            "recorded": _recorded(channel, first_s, last_s),
            "bookmarks": _bookmarks(channel.content("bookmarks"), first_s, last_s),
            "events": _events(channel.content("events"), first_s, last_s),
        },
        "notes": notes,
    }


def _place(view: View) -> PlaceCamera:
    return placed(PlaceCamera, view, 0)


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
    """The first of equal parts of a span that has seconds of another one, and after the last."""
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
