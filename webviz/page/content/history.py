"""Undo and redo history."""

from __future__ import annotations

from collections.abc import Sequence

import msgspec

from webviz.engine.state import State, Step
from webviz.engine.store import PageStore


class HistoryStep(msgspec.Struct, frozen=True):
    """A change, see `webviz.engine.state.Step`."""

    number: int
    label: str
    browser: int | None
    removed: str
    restored: str


class HistoryStore(PageStore, frozen=True):
    """The steps that can be undone, and those that can be redone, each with the newest first."""

    undo: Sequence[HistoryStep]
    redo: Sequence[HistoryStep]


def history(state: State, _: str) -> HistoryStore:
    """Return the steps that can be undone and redone."""
    known = state.history
    return HistoryStore([_step(step) for step in known.undo], [_step(step) for step in known.redo])


def _step(step: Step) -> HistoryStep:
    return msgspec.convert(step, HistoryStep, from_attributes=True)
