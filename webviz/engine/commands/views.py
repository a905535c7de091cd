"""Commands for views."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from webviz.api.views import View
from webviz.engine.commands.command import Command


class ViewCommand(Command):
    """A command for views.

    It acts on the browser with the id `browser`; without one, on the browser that sends it, or on
    all browsers if a program sends it.
    """


@dataclass(frozen=True)
class ShowView(ViewCommand):
    """Show a view.

    Args:
        view: a view, or the name of a saved one.
        browser: see `ViewCommand`.
    """

    view: View | str
    browser: int | None = None


@dataclass(frozen=True)
class ChangeView(ViewCommand):
    """Change a property of the current view, with as little camera movement as possible.

    Args:
        key: name of the property: "type", "target_frame", "distance" and so on.
        value: its new value; a name of `VIEW_TYPES` for "type".
        browser: see `ViewCommand`.
    """

    key: str
    value: Any
    browser: int | None = None


@dataclass(frozen=True)
class ResetView(ViewCommand):
    """Reset the view to the defaults of its type, as RViz's Zero does."""

    browser: int | None = None


@dataclass(frozen=True)
class FocusDisplay(ViewCommand):
    """Fit the view to everything that a display or group draws.

    Args:
        display: id of the display or group.
        browser: see `ViewCommand`.
    """

    display: str
    browser: int | None = None


@dataclass(frozen=True)
class FocusFrame(ViewCommand):
    """Look at the origin of a frame, from the same direction.

    Args:
        frame: its id.
        browser: see `ViewCommand`.
    """

    frame: str
    browser: int | None = None


@dataclass(frozen=True)
class SaveView(ViewCommand):
    """Save the current view under a name.

    Args:
        name: of the view; replaces a saved view of that name.
        browser: see `ViewCommand`; for a program, by default the one that connected last.
        view: instead of the current view.
    """

    name: str
    browser: int | None = None
    view: View | None = None


@dataclass(frozen=True)
class RenameView(ViewCommand):
    """Rename a saved view."""

    name: str
    new_name: str


@dataclass(frozen=True)
class RemoveView(ViewCommand):
    """Remove a saved view."""

    name: str


@dataclass(frozen=True)
class StartWithView(ViewCommand):
    """Make the current view the default of browsers and screenshots.

    Args:
        browser: see `ViewCommand`; for a program, by default the one that connected last.
        view: instead of the current view; a view or the name of a saved one.
    """

    browser: int | None = None
    view: View | str | None = None


@dataclass(frozen=True)
class SaveImage(ViewCommand):
    """Let a browser download its picture as a PNG.

    Args:
        browser: see `ViewCommand`.
        name: of the file; "" is one with date and time.
    """

    browser: int | None = None
    name: str = ""
