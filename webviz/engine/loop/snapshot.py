"""The state of a viewer, read from its parts: for programs and plug-ins."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from webviz.engine.doctor import Doctor
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.files import FilesPart
from webviz.engine.parts.history import HistoryPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.part import Core, Part
from webviz.engine.parts.playback import PlaybackPart
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.topics import TopicsPart
from webviz.engine.parts.transforms import TransformsPart
from webviz.engine.parts.views import ViewsPart
from webviz.engine.state import State


def _of_displays(part: DisplaysPart) -> Mapping[str, Any]:
    return {"rows": part.rows, "statuses": part.core.statuses}


def _of_settings(part: SettingsPart) -> Mapping[str, Any]:
    return {"settings": part.settings, "fixed_frame": part.settings.fixed_frame}


def _of_topics(part: TopicsPart) -> Mapping[str, Any]:
    core = part.core
    services = core.gate.services()
    known = {"topics": part.types, "offers": core.offers, "services": services}
    return {**known, "traffic": part.traffic}


def _of_playback(part: PlaybackPart) -> Mapping[str, Any]:
    known = {"playback": part.playback, "recorded": part.recorded}
    return {**known, "logged": part.logged, "warned": part.warned}


def _of_doctor(part: Doctor) -> Mapping[str, Any]:
    known = {"findings": part.findings, "examined_ns": part.examined_ns}
    return {**known, "found": part.events}


READERS: Mapping[type[Part], Callable[[Any], Mapping[str, Any]]] = {
    DisplaysPart: _of_displays,
    SettingsPart: _of_settings,
    TopicsPart: _of_topics,
    PlaybackPart: _of_playback,
    Doctor: _of_doctor,
    TransformsPart: lambda part: {"frames": part.frames().frames},
    FilesPart: lambda part: {"file": part.file()},
    TimePart: lambda part: {"clock": part.times},
    ViewsPart: lambda part: {"views": part.current()},
    PanelsPart: lambda part: {"panels": part.tabs()},
    HistoryPart: lambda part: {"history": part.history()},
}
"""The readers of the fields of each part."""


def snapshot(core: Core, more: Mapping[str, Any]) -> State:
    """Return the state; the fields of a part that fails have their defaults.

    Args:
        core: has the parts.
        more: the fields of features.
    """
    found: dict[str, Any] = {}
    for kind, read in READERS.items():
        own: Mapping[str, Any] = {}
        found |= core.guard.attempt(kind.name, own, read, core.get(kind))
    return State(**found, more=more)
