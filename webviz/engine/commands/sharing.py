"""Commands that share what is shown as one file."""

from __future__ import annotations

from dataclasses import dataclass

from webviz.engine.commands.command import Command


@dataclass(frozen=True)
class ListMoment(Command):
    """Answer with what `ShareMoment` would write, one line per part."""


@dataclass(frozen=True)
class ShareMoment(Command):
    """Begin to write the moment that is shown, and the time around it, as one HTML file.

    Args:
        path: of the file, only for programs; "" is one in the working folder, named by the time.
    """

    path: str = ""


@dataclass(frozen=True)
class StopSharing(Command):
    """Stop writing such a file, and remove it."""
