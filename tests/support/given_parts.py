"""Parts without a viewer, which show the state that a test gives them."""

from __future__ import annotations

from collections.abc import Sequence
from types import SimpleNamespace
from typing import Any

from tests.support.stand_in import stand_in
from webviz.engine.parts.config import ConfigPart
from webviz.engine.parts.display_rows import TreeRows
from webviz.engine.parts.displays import DisplaysPart
from webviz.engine.parts.panels import PanelsPart
from webviz.engine.parts.part import Part
from webviz.engine.parts.settings import SettingsPart
from webviz.engine.parts.time import TimePart
from webviz.engine.parts.topics import TopicsPart
from webviz.engine.parts.transforms import TransformsPart
from webviz.engine.parts.views import ViewsPart
from webviz.engine.state import State
from webviz.features.doctor import DoctorFeature
from webviz.features.files import FilesFeature
from webviz.features.panels import PluginPanels
from webviz.features.people import People
from webviz.features.playback import PlaybackFeature
from webviz.features.undo import HistoryStep, UndoFeature, UndoHistory
from webviz.features.views import ViewsFeature

KINDS = (
    *(ConfigPart, DisplaysPart, DoctorFeature, FilesFeature, PlaybackFeature, SettingsPart),
    *(PanelsPart, TimePart, TopicsPart, TransformsPart, ViewsPart),
)


class GivenParts:
    """The parts with stores."""

    def __init__(self) -> None:
        self._state = State()
        self._context: Any = SimpleNamespace(
            player=SimpleNamespace(is_seeking=False),
            get=lambda kind: self._by_kind[kind],
            fact=lambda name, other: getattr(self._state, name, other),
            state=lambda: self._state,
        )
        self._by_kind: dict[type[Part], Any] = {
            k: stand_in(k, context=self._context) for k in KINDS
        }
        self._give(PanelsPart, tabs=lambda: self._state.panels)
        self._undo: Any = stand_in(UndoFeature, context=self._context)
        others = PluginPanels(self._context), ViewsFeature(self._context)
        self.features = (People(self._context), *others, self._undo)
        """Features that show what the parts have, too."""
        displays, settings = self._by_kind[DisplaysPart], self._by_kind[SettingsPart]
        self._give(DisplaysPart, tree=TreeRows())
        self._give(DoctorFeature, _displays=displays)
        self._give(PlaybackFeature, _settings=settings, _time=self._by_kind[TimePart], _leader=None)
        self._give(ViewsPart, _settings=settings)
        self.show(State())

    @property
    def parts(self) -> Sequence[Part]:
        """All of them."""
        return [*self._by_kind.values(), *self.features]

    def show(self, state: State) -> None:
        """Let them have the values of a state."""
        self._state = state
        self._context.offers, self._context.statuses = state.offers, state.statuses
        self._context.buffer = SimpleNamespace(frames=lambda: state.frames)
        self._give(DisplaysPart, rows=state.rows)
        self._give(SettingsPart, settings=state.settings)
        self._give(
            TimePart,
            times=state.clock,
            playback=state.playback,
            recorded=state.recorded,
            logged=state.logged,
        )
        self._give(TopicsPart, traffic=state.traffic)
        self._give(ViewsPart, _cameras=SimpleNamespace(views=lambda: state.views))
        self._give(
            DoctorFeature,
            findings=state.more.get("findings", ()),
            examined_ns=state.more.get("examined_ns", 0),
            events=state.more.get("found", ()),
        )
        warned = state.more.get("warned", ())
        self._give(PlaybackFeature, _display_events=SimpleNamespace(events=warned))
        file = state.file
        history = state.more.get("history", UndoHistory())
        self._give(
            FilesFeature,
            _config=SimpleNamespace(path=file.path or None, is_changed=file.is_changed),
            _listing=None,
            _folder=file.folder,
            _others=file.others,
        )
        vars(self._undo).update(_undo=_steps(history.undo), _redo=_steps(history.redo))

    def _give(self, kind: type[Part], **values: Any) -> None:
        vars(self._by_kind[kind]).update(values)


def _steps(steps: Sequence[HistoryStep]) -> list[SimpleNamespace]:
    return [SimpleNamespace(step=step) for step in reversed(steps)]
