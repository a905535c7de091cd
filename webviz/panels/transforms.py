"""The panel "TF tree": all frames as text, while somebody wants to see them."""

from __future__ import annotations

import time

from webviz.api.panel import Panel, Send, Ui
from webviz.engine.commands import InspectTransforms
from webviz.engine.state import State

EVERY_S = 1.0
OFF = "Switch on Live to see every frame, who publishes it, how often and how old it is."
NOTHING = "No transforms yet on /tf or /tf_static."


class TFTree(Panel):
    """The tree of transforms: who publishes each frame, how often, and how old it is."""

    title = "TF tree"
    place = 40

    def build(self, ui: Ui, send: Send) -> None:
        """A switch above the tree."""

        def follow(live: bool, browser: int | None) -> None:
            send(InspectTransforms(live), browser)

        self._live = ui.checkbox("Live", False, follow, "Keep the transform tree up to date.")
        self._tree = ui.area()
        self._tree.text(OFF)
        self._shown = ""
        self._next = 0.0

    def show(self, state: State) -> None:
        """Show the tree, at most once a second while it is on."""
        if not self._live.value:
            self._shown = ""
            self._tree.text(OFF)
        elif state.transforms != self._shown or not self._shown:
            now = time.monotonic()
            if self._shown and now < self._next:
                return
            self._next = now + EVERY_S
            self._shown = state.transforms
            if self._shown:
                self._tree.lines(self._shown)
            else:
                self._tree.text(NOTHING)
