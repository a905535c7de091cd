"""What one browser looks at: the type of its view, the frame it follows, and its numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import viser

from webviz.api.panel import Edit, Send
from webviz.api.properties import Property, properties_of
from webviz.api.views import FIXED_FRAME, VIEW_TYPES, View, type_of
from webviz.edges.gui.control import Choice, Control
from webviz.engine.commands import ChangeView

DIGITS = 3
"""Decimals that are shown; a view that somebody moves has more."""


class ViewEditor:
    """The view of one browser, shown in that browser only.

    Args:
        client: that browser.
        box: where the widgets go.
        view: what it looks at.
        send: takes commands, from any thread.
    """

    def __init__(
        self,
        client: viser.ClientHandle,
        box: viser.GuiFolderHandle,
        view: View,
        send: Send,
    ) -> None:
        self._gui = client.gui
        self._browser = client.client_id
        self._box = box
        self._send = send
        self._type: type[View] | None = None
        self._numbers: dict[str, Control] = {}
        with box:
            hint = "How the camera moves; what is looked at stays."
            self._types = Choice(self._gui, "Type", type_of(view), self._edit("type"), hint)
            hint = "The camera moves with this frame."
            follow = self._edit("target_frame")
            self._frame = Choice(
                self._gui, "Target Frame", view.target_frame, follow, hint, free=True
            )

    def update(self, view: View, frames: Sequence[str]) -> None:
        """Show what the browser looks at now."""
        self._types.offer(tuple(VIEW_TYPES), type_of(view))
        self._frame.offer((FIXED_FRAME, *frames), view.target_frame)
        if type(view) is not self._type:
            self._type = type(view)
            self._replace_numbers(view)
        for name, control in self._numbers.items():
            control.show(getattr(view, name))

    def _replace_numbers(self, view: View) -> None:
        for control in self._numbers.values():
            control.widget.remove()
        with self._box:
            self._numbers = {
                each.path: self._add(each, each.of(view))
                for each in properties_of(type(view))
                if each.path != "target_frame"
            }

    def _add(self, declared: Property, value: Any) -> Control:
        label, edit, hint = declared.label, self._edit(declared.path), declared.help
        if isinstance(value, tuple):
            point: Any = self._gui.add_vector3(label, _rounded(value), step=0.1, hint=hint)
            return Control(point, edit, _rounded, tuple)
        number = self._gui.add_number(label, _rounded(value), step=10.0**-DIGITS, hint=hint)
        number.precision = DIGITS
        return Control(number, edit, _rounded, float)

    def _edit(self, key: str) -> Edit:
        return lambda value, _: self._send(ChangeView(key, value), self._browser)


def _rounded(value: Any) -> Any:
    """Numbers as they are shown; small ones keep digits that count."""
    if isinstance(value, tuple):
        return tuple(_rounded(part) for part in value)
    least = -math.floor(math.log10(abs(value))) if value else 0
    return round(float(value), max(DIGITS, min(least + 1, 6)))
