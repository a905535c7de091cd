"""The channel to a page that will open a file: keeps what it would be sent."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import msgspec

from webviz.server.channel.channel import Channel
from webviz.server.channel.messages import ToPage
from webviz.server.channel.stores import Stores

SHARED = (
    *("bookmarks", "commands", "density", "displays", "events", "findings", "frames", "goals"),
    *(
        "graph",
        "layout",
        "legend",
        "modules",
        "panels",
        "panes",
        "picking",
        "recorded",
        "routes",
        "settings",
    ),
    *("views", "watchers"),
)
"""Stores that pages watch all the time."""
SLOW = ("frame_tree", "topics", "traffic", "transforms")
"""Stores whose values change faster than anyone reads them."""
VALUES = "values:"
"""Prefix of the id of a display: details of what it draws. Viewers send those of a selection."""
OF_EACH_DISPLAY = ("properties", "rate", "statuses")
OF_EACH_PANEL = ("panel", "panel_properties")
OF_EACH_TOOL = ("tool",)

Changes = Mapping[tuple[str, str], msgspec.Raw | None]
"""New values by store and key, None for those that are gone."""


class RecordingChannel(Channel):
    """A channel whose page watches everything that a file contains."""

    def __init__(self) -> None:
        super().__init__()
        self.last_messages: dict[type[ToPage], ToPage] = {}
        """The newest message of each kind."""
        self._names: set[str] = set(SHARED)
        self._contents = Stores()
        self._changes: dict[tuple[str, str], msgspec.Raw | None] = {}
        self._waiting: dict[str, Mapping[str, Any]] = {}
        """Newest values of those that change all the time."""

    def follow(self, fact: Callable[[str, Any], Any]) -> None:
        """Watch the stores of all displays, tools and panels of a viewer.

        Args:
            fact: see `FrameLoop.fact`.
        """
        displays = {f"{name}:{row.id}" for name in OF_EACH_DISPLAY for row in fact("rows", ())}
        panels = {f"{name}:{tab.tab}" for name in OF_EACH_PANEL for tab in fact("panels", ())}
        tools = {f"{name}:{tool.id}" for name in OF_EACH_TOOL for tool in fact("tools", ())}
        for removed in self._names - (names := {*SHARED, *displays, *panels, *tools}) - {*SLOW}:
            self.show(removed, {})
        self._names = names

    def watched(self) -> set[str]:
        """Return the names of the stores to make."""
        return {*self._names, *SLOW}

    def send(self, message: ToPage, browser: int | None = None) -> None:
        """Keep a message to all pages."""
        if browser is None:
            self.last_messages[type(message)] = message

    def show(self, store: str, values: Mapping[str, Any]) -> None:
        """Note which values of a store have changed."""
        if store in SLOW:
            self._waiting[store] = values
        else:
            self._note(store, values)

    def _note(self, store: str, values: Mapping[str, Any]) -> None:
        for key in self._contents.replace(store, values):
            content = self._contents.get(store) or {}
            self._changes[store, key] = content.get(key)

    def content(self, store: str) -> Mapping[str, Any]:
        """Return the values of a store now."""
        content = self._contents.get(store) or {}
        return {key: msgspec.json.decode(value) for key, value in content.items()}

    def take(self, is_slow_due: bool) -> Changes:
        """Return the changes since the last call.

        Args:
            is_slow_due: whether stores that change all the time are wanted, too.
        """
        if is_slow_due:
            waiting, self._waiting = self._waiting, {}
            for store, values in waiting.items():
                self._note(store, values)
        changes, self._changes = self._changes, {}
        return changes
