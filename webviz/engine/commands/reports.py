"""Commands for bug reports."""

from __future__ import annotations

from webviz.engine.commands.command import Command
from webviz.engine.commands.files import FileCommand
from webviz.engine.commands.selection import Picks
from webviz.files.report import ReportedPick


class ListReport(FileCommand, frozen=True):
    """Answer with what a bug report would contain, one member per line.

    Args:
        with_names: whether names of hosts, users and home folders would be in it.
    """

    with_names: bool = False


class SaveReport(FileCommand, frozen=True):
    """Write a bug report of the moment that is shown.

    Args:
        picture: PNG or JPEG in base64, "" for none.
        selection: of the page that sends this.
        with_names: keep names of hosts, users and home folders.
        path: of the file, only for programs; "" is one in the working folder, named by the time.
    """

    picture: str = ""
    selection: tuple[Picks, ...] = ()
    with_names: bool = False
    path: str = ""


class RestoreSelection(Command, frozen=True):
    """Let pages that join select what was selected when a report was made."""

    picks: tuple[ReportedPick, ...]
