"""Commands that share what is shown as one file."""

from __future__ import annotations

from webviz.engine.commands.command import Command


class ListMoment(Command, frozen=True):
    """Answer with what `ShareMoment` would write, one line per part."""


class ShareMoment(Command, frozen=True):
    """Begin to write the moment that is shown, and the time around it, as one HTML file.

    Args:
        path: of the file, only for programs; "" is one in the working folder, named by the time.
    """

    path: str = ""


class StopSharing(Command, frozen=True):
    """Stop writing such a file, and remove it."""
