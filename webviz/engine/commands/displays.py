"""Commands for displays and their handles."""

from __future__ import annotations

from webviz.api.handles import Drag
from webviz.engine.commands.command import Command


class DragHandle(Command, frozen=True):
    """Do something with a handle; see `webviz.api.handles.Drag`.

    Args:
        display: id of the display that has it.
        drag: what is done.
    """

    display: str
    drag: Drag
