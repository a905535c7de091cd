"""What panels are built of, made of viser's widgets."""

from __future__ import annotations

import functools
from collections.abc import Iterable, Sequence
from typing import Any

import viser

from webviz.api.panel import Act, Edit, Modifier
from webviz.api.status import Level
from webviz.edges.gui.answers import tell
from webviz.edges.gui.control import TYPING_S, Choice, Control
from webviz.edges.gui.style import WHOLE, failure_html, row_style
from webviz.edges.gui.text import block_html, escape, note_html, plain
from webviz.engine.pipeline.guard import Guard


class Area:
    """A place for text; see `webviz.api.panel.Area`."""

    def __init__(self, gui: viser.GuiApi) -> None:
        self._html = gui.add_html("")

    def text(self, text: str) -> None:
        """Show a paragraph."""
        self.html(note_html(text))

    def lines(self, text: str) -> None:
        """Show lines in letters of one width."""
        self.html(block_html(text))

    def table(self, rows: Iterable[Sequence[str]]) -> None:
        """Show texts in rows and columns."""
        lines = ("".join(f"<td>{escape(cell)}</td>" for cell in row) for row in rows)
        cells = "".join(f"<tr>{line}</tr>" for line in lines)
        self.html(f'<table class="webviz-table">{cells}</table>')

    def html(self, markup: str) -> None:
        """Show HTML; what is shown already is not sent again."""
        self._html.content = markup


class TabUi:
    """The inside of one tab; see `webviz.api.panel.Ui`.

    Widgets go into the tab that is open.

    Args:
        server: where the tab is.
        title: of the tab.
    """

    def __init__(self, server: viser.ViserServer, title: str) -> None:
        self.viser = server
        self._gui = server.gui
        self._acts = Guard(f"The panel {title}", strict=False)  # viser's threads are its own
        self._spans: list[int] = []
        self._commands: list[viser.CommandHandle] = []
        self._failure: viser.GuiHtmlHandle | None = None

    def area(self) -> Area:
        """Add a place for text."""
        self._spans.append(WHOLE)
        return Area(self._gui)

    def button(
        self, label: str, act: Act, hint: str = "", width: float = 1.0
    ) -> viser.GuiButtonHandle:
        """Add a button."""
        self._spans.append(round(WHOLE * width))
        button = self._gui.add_button(plain(label), color="gray", hint=hint or None)
        button.on_click(lambda event: self._do(label, act, browser_of(event)))
        return button

    def checkbox(self, label: str, value: bool, edit: Edit, hint: str = "") -> Control:
        """Add a check box."""
        self._spans.append(WHOLE)
        widget = self._gui.add_checkbox(plain(label), value, hint=hint or None)
        return Control(widget, self._edited(label, edit))

    def field(self, label: str, value: str, edit: Edit, hint: str = "") -> Control:
        """Add a line of text."""
        self._spans.append(WHOLE)
        widget = self._gui.add_text(plain(label), plain(value), hint=hint or None)
        return Control(widget, self._edited(label, edit), plain, wait=TYPING_S)

    def choice(self, label: str, value: str, edit: Edit, hint: str = "") -> Choice:
        """Add a list to choose from."""
        self._spans.append(WHOLE)
        return Choice(self._gui, plain(label), value, self._edited(label, edit), hint or None)

    def command(
        self, label: str, act: Act, key: str = "", modifier: Modifier | None = None, icon: str = ""
    ) -> None:
        """Add a command to the palette, for every browser; not called while somebody types."""
        names: dict[str, Any] = {"hotkey": key or None, "icon": icon or None}
        command = self._gui.add_command(label, modifier=modifier, **names)
        command.on_trigger(lambda event: self._do(label, act, browser_of(event)))
        self._commands.append(command)

    def arrange(self) -> None:
        """Put widgets that are narrower than the tab beside each other; after the last one."""
        if any(span != WHOLE for span in self._spans):
            self._gui.add_html(row_style(f"panel-{id(self)}", self._spans), order=-1)

    def fail(self, sentence: str) -> None:
        """Tell on top of the tab why it does not work, "" once it does; in the open tab."""
        if self._failure is None:
            if not sentence:
                return
            self._failure = self._gui.add_html("", order=float(10**9))
        self._failure.visible = bool(sentence)
        self._failure.content = failure_html(sentence)

    def close(self) -> None:
        """Take back what stands outside of the tab."""
        for command in self._commands:
            command.remove()

    def _edited(self, label: str, edit: Edit) -> Edit:
        return lambda value, browser: self._do(label, functools.partial(edit, value), browser)

    def _do(self, label: str, act: Act, browser: int | None) -> None:
        """Do what a browser asks, and tell it if that fails."""
        try:
            act(browser)
        except (Exception, SystemExit) as error:  # somebody else's code may raise anything
            text = self._acts.note(label, error)
            if client := self.viser.get_clients().get(-1 if browser is None else browser):
                tell(client, Level.ERROR, text)


def browser_of(event: viser.GuiEvent[Any] | viser.CommandEvent) -> int | None:
    """The id of the browser in which somebody did something."""
    return event.client.client_id if event.client else None
