"""Undo and redo history."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from webviz.engine.state import State, Step


def history(state: State, _: str) -> Mapping[str, Any]:
    """The steps that can be undone, and those that can be redone, each with the newest first."""
    return {
        "undo": [_step(step) for step in state.history.undo],
        "redo": [_step(step) for step in state.history.redo],
    }


def _step(step: Step) -> Mapping[str, Any]:
    return {"number": step.number, "label": step.label, "browser": step.browser}
