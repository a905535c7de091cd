"""The memory of live topics, and their recording."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.state import State
from webviz.page.content.forms import sendable


def recording(state: State, _: str) -> Mapping[str, Any]:
    """The memory and the recording, empty for a bag; in whole seconds and megabytes."""
    memory, recording = state.memory, state.recording
    if memory is None:
        return {}
    told: dict[str, Any] = {
        "remembered": [int(memory.seconds), memory.size // 1_000_000],
        "is_remembering": state.settings.memory.seconds > 0,
        "recording": None,
    }
    if recording is not None:
        told["recording"] = {
            "name": sendable(recording.path.name),
            "seconds": int(recording.seconds),
            "megabytes": round(recording.size / 1e6, 1),
            "dropped": recording.dropped,
        }
    return told
