"""The dialog that adds displays for topics which are published just now."""

from __future__ import annotations

from collections.abc import Callable, Mapping

import viser

from webviz.api.panel import Send
from webviz.api.registry import display_types
from webviz.edges.gui.dialogs import Dialog
from webviz.edges.gui.style import picks_style
from webviz.edges.gui.text import note_html, plain
from webviz.engine.by_topic import Pick, matching, picks
from webviz.engine.state import State

MAX_SHOWN = 40
"""Lines at once; the filter finds the others."""
MANY = 8
"""With more lines than this there is a filter."""
NOTHING = (
    "No topic is published that a display could show. Start the robot, a simulator or a bag; "
    "topics appear here by themselves."
)


class AddByTopic(Dialog):
    """RViz's "By topic": the live topics, each with the displays that fit, several at once.

    Args:
        client: the browser that asked.
        send: takes commands, from any thread.
        expect_new: called before displays are added.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        send: Send,
        expect_new: Callable[[], None],
    ) -> None:
        super().__init__(client.gui, "Add displays by topic")
        self._send = send
        self._browser = client.client_id
        self._expect_new = expect_new
        self._boxes: dict[Pick, viser.GuiCheckboxHandle] = {}
        self._checked: set[Pick] = set()
        self._topics: Mapping[str, tuple[str, ...]] | None = None
        self._picks: list[Pick] = []
        self._shown: list[Pick] | None = None
        gui = self.gui
        with self.modal:
            self._filter = gui.add_text("Filter", "", order=0, visible=False)
            self._folder = gui.add_folder("Topics", order=1)
            with self._folder:
                gui.add_html(picks_style(), order=-1)
            self._note = gui.add_html("", order=2)
            gui.add_button("Add", order=3).on_click(lambda _: self._add())
            gui.add_button("Cancel", color="gray", order=4).on_click(lambda _: self.finish())

    def update(self, state: State) -> None:
        """Show the topics there are now."""
        if state.topics is not self._topics and state.topics != self._topics:
            self._picks = picks(state.topics, display_types())
        self._topics = state.topics
        found = matching(self._picks, self._filter.value)
        if found != self._shown:
            self._shown = found
            self._show(found)

    def _show(self, found: list[Pick]) -> None:
        self._filter.visible = len(self._picks) > MANY
        self._folder.visible = bool(found)
        shown = found[:MAX_SHOWN]
        for gone in self._boxes.keys() - set(shown):
            self._boxes.pop(gone).remove()
        with self._folder:
            for index, pick in enumerate(shown):
                if pick not in self._boxes:
                    self._boxes[pick] = self._add_box(pick)
                self._boxes[pick].order = index
        self._note.content = note_html(self._remark(len(found)))

    def _add_box(self, pick: Pick) -> viser.GuiCheckboxHandle:
        label = f"{plain(pick.topic)}  ·  {pick.display}"
        box = self.gui.add_checkbox(label, pick in self._checked, hint=plain(pick.message))

        @box.on_update
        async def _(_: object) -> None:
            (self._checked.add if box.value else self._checked.discard)(pick)

        return box

    def _remark(self, count: int) -> str:
        if not self._picks:
            return NOTHING
        if not count:
            return "No topic with these words; change the filter."
        if count > MAX_SHOWN:
            return f"… and {count - MAX_SHOWN} more: type a part of the name in the filter."
        return ""

    def _add(self) -> None:
        chosen = sorted(self._checked & set(self._picks))
        if chosen:
            self._expect_new()
        for pick in chosen:
            self._send(pick.command(), self._browser)
        self.finish()
