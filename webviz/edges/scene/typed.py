"""Text that users type into dropdowns (see `typing.js`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from webviz.edges.page.messages import Typed
from webviz.edges.scene.adapter import Adapter
from webviz.edges.scene.adapter.widgets import gui_input


def on_typed(link: Adapter, listener: Callable[[Any, str, int], None]) -> None:
    """Calls `listener` with an input widget, the text typed into it, and the id of the browser.

    It runs on viser's event loop; text and choice of the widget are unchecked.
    """

    def hear(browser: int, typed: Typed) -> None:
        handle = gui_input(link.server, typed.uuid)
        if handle is not None:
            listener(handle, typed.text, browser)

    link.channel.on(Typed, hear)
