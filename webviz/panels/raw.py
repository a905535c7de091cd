"""The panel Raw: any topic or field as a tree."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from webviz.api.offer import Offer
from webviz.api.panel import Send, Ui
from webviz.data.messages import to_tree
from webviz.data.messages.value_names import named
from webviz.engine.state import PanelTab
from webviz.panels.one_path import PathPanel


class RawMessage(PathPanel):
    """Any message, or a part of it, as a tree."""

    title = "Raw message"
    opens = "side"
    icon = "file"
    module = "raw.js"

    def build(self, ui: Ui, send: Send) -> None:
        """Show the path and the tree."""
        self.build_path(ui, send)
        self.tree = ui.widget("raw", {}, lambda value, browser: None)
        self.drawn_revision = -1
        self.content: Any = None

    def show(self, offers: Mapping[str, Offer], panels: Sequence[PanelTab]) -> None:
        """Show the newest values."""
        problem = self.follow(offers, panels)
        if self.drawn_revision != self.revision:
            self.drawn_revision, self.content = self.revision, self._tree()
        self.tree.show({"path": self.path, "tree": self.content, "problem": problem})

    def _tree(self) -> Any:
        """Return the values as a tree: the fields of a single one, else their number and all."""
        if not self.values:
            return None
        several = self.reading.path is not None and self.reading.path.finds_many
        if not several and (text := named(self.values[0], self.names)):
            return {"fields": {"value": text}}
        tree = to_tree(self.values if several else self.values[0], max_items=100)
        is_message = isinstance(tree, dict) and "fields" in tree
        return tree if is_message else {"fields": {"value": tree}}
