"""The panel "Topics": what is published, and the last message of one topic."""

from __future__ import annotations

import time

from webviz.api.panel import Panel, Send, Ui
from webviz.edges.gui.text import block_html, note_html
from webviz.edges.gui.topics_table import topics_html
from webviz.engine.commands import InspectTopic
from webviz.engine.state import Inspected, State

EVERY_S = 1.0
"""How often the last message is shown anew."""
ROWS_PER_S = 50
"""A longer table is shown anew less often, since nobody may be looking at it."""
HINT = "Choose a topic to read its last message; it need not be shown."


class Topics(Panel):
    """All topics: who publishes them and how, how much of them arrives, and the last message."""

    place = 50

    def build(self, ui: Ui, send: Send) -> None:
        """A topic to choose, its message, and all topics."""
        self._choice = ui.choice(
            "Inspect", "", lambda topic, browser: send(InspectTopic(topic), browser), HINT
        )
        self._message = ui.area()
        self._message.text(HINT)
        self._filter = ui.field("Filter", "", lambda *_: None, "Part of the name or type.")
        self._table = ui.area()
        self._filtered = ""
        self._offers: object = None
        self._topics: tuple[str, ...] = ()
        self._inspected = ""
        self._next_message = self._next_table = 0.0

    def show(self, state: State) -> None:
        """Show the topics as they are, now and then."""
        current = state.inspected.topic if state.inspected else ""
        if state.offers is not self._offers:
            self._topics = ("", *sorted(state.offers))
        self._choice.offer(self._topics, current)
        self._choice.show(current)
        self._show_message(state.inspected, current)
        self._show_table(state)
        self._offers = state.offers

    def _show_message(self, inspected: Inspected | None, topic: str) -> None:
        now = time.monotonic()
        if topic == self._inspected and now < self._next_message:
            return
        self._inspected, self._next_message = topic, now + EVERY_S
        if inspected is None:
            self._message.text(HINT)
        else:
            self._message.html(inspected_html(inspected))

    def _show_table(self, state: State) -> None:
        now, wanted = time.monotonic(), self._filter.value
        if state.offers is self._offers and wanted == self._filtered and now < self._next_table:
            return
        self._filtered = wanted
        self._next_table = now + max(1.0, len(state.offers) / ROWS_PER_S)
        self._table.html(topics_html(state.offers, state.traffic, wanted))


def inspected_html(inspected: Inspected) -> str:
    """The last message of a topic, and how long ago it came."""
    if inspected.age_s is None:
        return note_html(inspected.text)
    return note_html(f"{inspected.age_s:.0f} s ago") + block_html(inspected.text)
