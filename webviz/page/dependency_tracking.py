"""Dependency tracking of stores: a store is made anew only if what it reads has changed."""

from __future__ import annotations

from typing import Any, cast

from webviz.engine.state import State


class DependencyTracker:
    """Notes which fields of a state are read.

    Args:
        state: to read from.
    """

    def __init__(self, state: State) -> None:
        self._read: dict[str, Any] = {}
        self.state = cast(State, _Noting(state, self._read))
        """The state, to be read once."""

    def is_as_in(self, state: State) -> bool:
        """Return whether these fields are the same objects in another state."""
        return all(getattr(state, name) is value for name, value in self._read.items())


class _Noting:
    def __init__(self, state: State, read: dict[str, Any]) -> None:
        self._state = state
        self._noted = read

    def __getattr__(self, name: str) -> Any:
        value = self._noted[name] = getattr(self._state, name)
        return value
