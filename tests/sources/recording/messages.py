"""Messages of any content that arrived at a time, and those of a recording."""

from __future__ import annotations

from pathlib import Path

from webviz.data.recordings import open_recording
from webviz.sources import Raw


def raw(at_s: float, size: int = 10) -> Raw:
    return Raw(bytes(size), round(at_s * 1e9), at_s)


def contents(path: Path) -> list[tuple[str, int]]:
    """Return topics and stamps of a recording."""
    recording = open_recording(path)
    assert recording.span_ns is not None
    results = list(recording.messages(recording.channels, *recording.span_ns))
    recording.close()
    return [(message.channel.topic, message.stamp_ns) for message in results]
