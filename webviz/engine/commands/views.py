"""Commands for views."""

from __future__ import annotations

from typing import Any

from webviz.api.views import View
from webviz.engine.commands.command import Command


class ViewCommand(Command, frozen=True):
    """A command for views.

    It acts on the browser with the id `browser`; without one, on the browser that sends it, or on
    all browsers if a program sends it.
    """


class ShowView(ViewCommand, frozen=True):
    """Show a view.

    Args:
        view: a view, or the name of a saved one.
        browser: see `ViewCommand`.
    """

    view: View | str
    browser: int | None = None


class ChangeView(ViewCommand, frozen=True):
    """Change a property of the current view, with as little camera movement as possible.

    Args:
        key: name of the property: "type", "target_frame", "distance" and so on.
        value: its new value; a name of `VIEW_TYPES` for "type".
        browser: see `ViewCommand`.
    """

    key: str
    value: Any
    browser: int | None = None


class ResetView(ViewCommand, frozen=True):
    """Reset the view to the defaults of its type, as RViz's Zero does."""

    browser: int | None = None


class FocusDisplay(ViewCommand, frozen=True):
    """Fit the view to everything that a display or group draws.

    Args:
        display: id of the display or group.
        browser: see `ViewCommand`.
    """

    display: str
    browser: int | None = None


class FocusFrame(ViewCommand, frozen=True):
    """Look at the origin of a frame, from the same direction.

    Args:
        frame: its id.
        browser: see `ViewCommand`.
    """

    frame: str
    browser: int | None = None


class SaveView(ViewCommand, frozen=True):
    """Save the current view under a name.

    Args:
        name: of the view; replaces a saved view of that name.
        browser: see `ViewCommand`; for a program, by default the one that connected last.
        view: instead of the current view.
    """

    name: str
    browser: int | None = None
    view: View | None = None


class RenameView(ViewCommand, frozen=True):
    """Rename a saved view."""

    name: str
    new_name: str


class RemoveView(ViewCommand, frozen=True):
    """Remove a saved view."""

    name: str


class StartWithView(ViewCommand, frozen=True):
    """Make the current view the default of browsers and screenshots.

    Args:
        browser: see `ViewCommand`; for a program, by default the one that connected last.
        view: instead of the current view; a view or the name of a saved one.
    """

    browser: int | None = None
    view: View | str | None = None


class SaveImage(ViewCommand, frozen=True):
    """Let a browser download its picture as a PNG.

    Args:
        browser: see `ViewCommand`.
        name: of the file; "" is one with date and time.
    """

    browser: int | None = None
    name: str = ""
