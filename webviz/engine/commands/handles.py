"""Commands for what browsers grip and move."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.api.handles import Grip
from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class GripHandle(Command):
    """Do something with a handle; see `webviz.api.handles.Grip`.

    Args:
        display: id of the display that has it.
        grip: what is done.
    """

    display: str
    grip: Grip
