"""One property and the widget that shows it."""

from __future__ import annotations

import asyncio
import time
from collections.abc import Callable, Sequence
from typing import Any
from weakref import WeakValueDictionary

import viser

from webviz.api.panel import Edit
from webviz.edges.gui.text import plain

SETTLE_S = 0.5
"""How long a widget keeps what somebody gave it before it shows what the display has."""

REASON_S = 10.0
"""How long somebody is told why what was entered means nothing."""

TYPING_S = 0.6
"""A text is taken over when nobody has typed for so long."""


class Control:
    """Keeps a widget and a value of the viewer the same.

    The widget shows what the viewer has. What a browser enters becomes a command; if that is
    refused, or somebody else changes the value, the widget is set back. While somebody drags or
    types, the viewer lags behind: the widget is left alone until that has settled.

    Args:
        widget: an input of viser.
        edit: called with what a browser entered, and its id, in viser's event loop.
        encode: from the value to what the widget holds.
        decode: the inverse; ValueError with a sentence if the text means nothing.
        wait: seconds without a further edit after which an edit counts.
    """

    def __init__(
        self,
        widget: viser.GuiInputHandle[Any],
        edit: Edit,
        encode: Callable[[Any], Any] = lambda value: value,
        decode: Callable[[Any], Any] = lambda value: value,
        wait: float = 0.0,
    ) -> None:
        self.widget = widget
        self._edit = edit
        self.encode = encode
        self.decode = decode
        self._wait = wait
        self._touched = -float("inf")
        self._timer: asyncio.TimerHandle | None = None
        self._visible = True

        # A coroutine runs at once in viser's event loop, a function somewhat later in a thread:
        # by then the frame loop could have set the widget back.
        @widget.on_update
        async def _(event: viser.GuiEvent[Any]) -> None:
            if event.client is not None:
                self._entered(event.client)

    @property
    def value(self) -> Any:
        """What the widget holds now."""
        return self.decode(self.widget.value)

    def show(self, value: Any) -> None:
        """Show the value the viewer has."""
        shown = self.encode(value)
        if self.widget.value != shown and not self.settling():
            self.widget.value = shown

    def settling(self) -> bool:
        """Whether somebody edits the widget just now, or did a moment ago."""
        return time.monotonic() - self._touched <= SETTLE_S + self._wait

    def show_when(self, visible: bool) -> None:
        """Hide the widget, or show it again."""
        if visible != self._visible:
            self._visible = visible
            self.widget.visible = visible

    def _entered(self, client: viser.ClientHandle) -> None:
        self._touched = time.monotonic()
        if self._timer is not None:
            self._timer.cancel()
        self._timer = asyncio.get_running_loop().call_later(
            self._wait, self._commit, self.widget.value, client
        )

    def _commit(self, entered: Any, client: viser.ClientHandle) -> None:
        try:
            value = self.decode(entered)
        except ValueError as error:
            # The widget is set back, since the viewer never hears of it.
            client.add_notification(
                "Not changed", plain(str(error)), auto_close_seconds=REASON_S, color="red"
            )
            return
        self._edit(value, client.client_id)


MAX_TYPED = 1000
"""Characters of a text that is typed into a dropdown."""

_FREE: WeakValueDictionary[int, Choice] = WeakValueDictionary()
"""The dropdowns that take any text, by the `id` of their widget, which lives as long."""


def take_typed(widget: viser.GuiInputHandle[Any], text: str, browser: int) -> None:
    """Let a dropdown take what a browser typed, if it takes any text; in viser's event loop."""
    if (choice := _FREE.get(id(widget))) and len(text) <= MAX_TYPED:
        choice.take_typed(text, browser)


class Choice(Control):
    """A dropdown whose options come and go, such as the known frames.

    Args:
        gui: viser's GUI.
        label: of the widget.
        value: what is chosen at first.
        edit: called with the value that a browser chose, and its id.
        hint: tooltip.
        free: it takes any text, as RViz's fields for frames do.
    """

    def __init__(
        self,
        gui: viser.GuiApi,
        label: str,
        value: str,
        edit: Edit,
        hint: str | None = None,
        free: bool = False,
    ) -> None:
        self._offered: tuple[Sequence[str], str, bool] | None = None
        self._values = {_option(value): value}
        self.dropdown = gui.add_dropdown(label, tuple(self._values), hint=hint)
        super().__init__(self.dropdown, edit, _option, self._chosen)
        if free:
            _FREE[id(self.dropdown)] = self

    def take_typed(self, text: str, browser: int) -> None:
        """Take a text that a browser typed; one that was offered means its value."""
        self._edit(self._values.get(text, text), browser)

    def offer(self, values: Sequence[str], current: str) -> None:
        """Offer these values, and the current one even if it is not among them."""
        settling = self.settling()
        if self._offered == (values, current, settling):
            return
        self._offered = (values, current, settling)
        # What was chosen a moment ago stays on offer until the viewer has answered.
        chosen = self._values.get(self.dropdown.value, current) if settling else current
        self._values = {_option(value): value for value in (*values, current, chosen)}
        self.show(current)
        if self.dropdown.options != tuple(self._values):
            self.dropdown.options = tuple(self._values)

    def _chosen(self, option: str) -> str:
        if option not in self._values:
            raise ValueError(f"{option} is no longer available.")
        return self._values[option]


def _option(value: str) -> str:
    return plain(value) or "(none)"
