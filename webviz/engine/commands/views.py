"""What is about views."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from webviz.api.views import View
from webviz.engine.commands.command import Command


class ViewCommand(Command):
    """What is about views.

    It acts in the browser that sends it, and in every one if a program does. With an id as
    `browser` it acts there, as a program may want.
    """


@dataclass(frozen=True)
class ShowView(ViewCommand):
    """Look at the scene in another way.

    Args:
        view: or the name of a saved one.
        browser: see `ViewCommand`.
    """

    view: View | str
    browser: int | None = None


@dataclass(frozen=True)
class ChangeView(ViewCommand):
    """Change a property of what is seen, and keep what is looked at.

    Args:
        key: of the view: "type", "target_frame", "distance" and so on.
        value: of the property; the name of a type for "type".
        browser: see `ViewCommand`.
    """

    key: str
    value: Any
    browser: int | None = None


@dataclass(frozen=True)
class ResetView(ViewCommand):
    """Go back to where a view of this type begins, as RViz's Zero does."""

    browser: int | None = None


@dataclass(frozen=True)
class FocusDisplay(ViewCommand):
    """Look at all that a display, or what is in a group, draws.

    Args:
        display: id of the display or group.
        browser: see `ViewCommand`.
    """

    display: str
    browser: int | None = None


@dataclass(frozen=True)
class SaveView(ViewCommand):
    """Keep what a browser shows, under a name.

    Args:
        name: of the view; one that has it is replaced.
        browser: see `ViewCommand`; for a program without it, the one that came last.
        view: instead of what a browser shows.
    """

    name: str
    browser: int | None = None
    view: View | None = None


@dataclass(frozen=True)
class RenameView(ViewCommand):
    """Give a saved view another name."""

    name: str
    new_name: str


@dataclass(frozen=True)
class RemoveView(ViewCommand):
    """Forget a saved view."""

    name: str


@dataclass(frozen=True)
class StartWithView(ViewCommand):
    """Let browsers and screenshots begin with what a browser shows.

    Args:
        browser: see `ViewCommand`; for a program without it, the one that came last.
        view: instead of what a browser shows, or the name of a saved one.
    """

    browser: int | None = None
    view: View | str | None = None


@dataclass(frozen=True)
class SaveImage(ViewCommand):
    """Let a browser download what it shows as a PNG.

    Args:
        browser: see `ViewCommand`.
        name: of the file; "" is made of the date and the time.
    """

    browser: int | None = None
    name: str = ""
