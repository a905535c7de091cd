"""Texts that are typed into dropdowns (see `typing.js`)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from webviz.edges.page.messages import Typed
from webviz.edges.scene.adapter import Adapter, gui_input


def on_typed(link: Adapter, listener: Callable[[Any, str], None]) -> None:
    """Call `listener` with an input widget and the text that a browser typed into it.

    It runs on viser's event loop; nobody vouches for either.
    """

    def hear(_: int, typed: Typed) -> None:
        handle = gui_input(link.server, typed.uuid)
        if handle is not None:
            listener(handle, typed.text)

    link.channel.on(Typed, hear)
