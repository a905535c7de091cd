"""The tab "TF tree": all frames as text, while somebody wants to see them."""

from __future__ import annotations

import time
from collections.abc import Callable

import viser

from webviz.edges.gui.control import Control
from webviz.edges.gui.text import block_html, note_html
from webviz.engine.commands import Command, InspectTransforms
from webviz.engine.state import State

EVERY_S = 1.0
OFF = "Switch on Live to see every frame, who publishes it, how often and how old it is."
NOTHING = "No transforms yet on /tf or /tf_static."


class TransformsTab:
    """The tree of transforms.

    Args:
        gui: viser's GUI; the widgets go into the tab that is open.
        enqueue: takes commands, from any thread.
    """

    def __init__(self, gui: viser.GuiApi, enqueue: Callable[[Command], None]) -> None:
        self._live = gui.add_checkbox("Live", False, hint="Follow the tree of transforms.")
        Control(self._live, lambda live: enqueue(InspectTransforms(live)))
        self._text = gui.add_html(note_html(OFF))
        self._shown = ""
        self._next = 0.0

    def update(self, state: State) -> None:
        """Show the tree, at most once a second while it is on."""
        if not self._live.value:
            self._shown = ""
            self._text.content = note_html(OFF)
        elif state.transforms != self._shown or not self._shown:
            now = time.monotonic()
            if self._shown and now < self._next:
                return
            self._next = now + EVERY_S
            self._shown = state.transforms
            self._text.content = block_html(self._shown) if self._shown else note_html(NOTHING)
