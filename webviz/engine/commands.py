"""What people ask of a viewer: queued by the panel, services or Python, done by the frame loop."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from webviz.api.declared import Color
from webviz.api.views import View


@dataclass(frozen=True)
class SetProperty:
    """Change a property of a display; nested ones have a dotted path, such as `topic.name`."""

    display: str
    path: str
    value: Any


def nobody(id: str) -> None:
    """Tell nobody the id of a display that was made."""


@dataclass(frozen=True)
class AddDisplay:
    """Add a display at the end of the list, or of a group.

    Args:
        type: name of the display type.
        values: its properties, as in a config file.
        group: where to; "" is the list itself.
        made: called with the id of the new display by the frame loop, so it must not block.
    """

    type: str
    values: dict[str, Any] = field(default_factory=dict)
    group: str = ""
    made: Callable[[str], None] = nobody


@dataclass(frozen=True)
class RemoveDisplay:
    """Remove a display, or a group with all that is in it."""

    display: str


@dataclass(frozen=True)
class DuplicateDisplay:
    """Add a copy right behind a display, or a group with all that is in it.

    Args:
        display: what to copy.
        made: called with the id of the copy by the frame loop, so it must not block.
    """

    display: str
    made: Callable[[str], None] = nobody


@dataclass(frozen=True)
class MoveDisplay:
    """Put a display or a group elsewhere in the list.

    Args:
        display: what to move.
        group: where to; "" is the list itself.
        before: goes before this one of that group; "" is the end.
    """

    display: str
    group: str = ""
    before: str = ""


@dataclass(frozen=True)
class SetFixedFrame:
    """Choose the frame that everything is drawn in."""

    frame: str


@dataclass(frozen=True)
class SetBackground:
    """Choose the colour behind the scene."""

    color: Color


@dataclass(frozen=True)
class SetFrameRate:
    """Choose how often in a second the scene may change."""

    hz: float


@dataclass(frozen=True)
class Reset:
    """Forget transforms and messages, as RViz's Reset does."""


@dataclass(frozen=True)
class Pause:
    """Let time stand still on the page, or go on; messages wait meanwhile."""

    paused: bool = True


@dataclass(frozen=True)
class Open:
    """Show what a config file says instead of what is shown."""

    path: str


@dataclass(frozen=True)
class Load:
    """Show what the text of a config says instead of what is shown.

    Args:
        text: YAML, or RViz's if the name ends with .rviz.
        name: of the file it came from; it is not read or written.
    """

    text: str
    name: str


@dataclass(frozen=True)
class Save:
    """Write what is shown to a file, "" to where it came from."""

    path: str = ""


@dataclass(frozen=True)
class Export:
    """Hand what is shown to somebody as the text of a config, such as a browser that downloads it.

    Args:
        deliver: called with that text by the frame loop, so it must not block.
        name: of the file it is for; RViz's text if it ends with .rviz, else YAML.
    """

    deliver: Callable[[str], None]
    name: str = ""


@dataclass(frozen=True)
class ShowView:
    """Look at the scene in another way.

    Args:
        view: or the name of a saved one.
        browser: id of the browser whose camera moves, None for every one.
    """

    view: View | str
    browser: int | None = None


@dataclass(frozen=True)
class ChangeView:
    """Change a property of what is seen, and keep what is looked at.

    Args:
        key: of the view: "type", "target_frame", "distance" and so on.
        value: of the property; the name of a type for "type".
        browser: id of the browser whose camera moves, None for every one.
    """

    key: str
    value: Any
    browser: int | None = None


@dataclass(frozen=True)
class ResetView:
    """Go back to where a view of this type begins, as RViz's Zero does."""

    browser: int | None = None


@dataclass(frozen=True)
class FocusDisplay:
    """Look at all that a display, or what is in a group, draws.

    Args:
        display: id of the display or group.
        browser: id of the browser whose camera moves, None for every one.
    """

    display: str
    browser: int | None = None


@dataclass(frozen=True)
class SaveView:
    """Keep what a browser shows, under a name.

    Args:
        name: of the view; one that has it is replaced.
        browser: id of the browser, None for the one that came last.
        view: instead of what a browser shows.
    """

    name: str
    browser: int | None = None
    view: View | None = None


@dataclass(frozen=True)
class RenameView:
    """Give a saved view another name."""

    name: str
    new_name: str


@dataclass(frozen=True)
class RemoveView:
    """Forget a saved view."""

    name: str


@dataclass(frozen=True)
class StartWithView:
    """Let browsers and screenshots begin with what a browser shows.

    Args:
        browser: id of the browser, None for the one that came last.
        view: instead of what a browser shows, or the name of a saved one.
    """

    browser: int | None = None
    view: View | str | None = None


@dataclass(frozen=True)
class SaveImage:
    """Let a browser download what it shows as a PNG.

    Args:
        browser: id of the browser, None for every one.
        name: of the file; "" is made of the date and the time.
    """

    browser: int | None = None
    name: str = ""


@dataclass(frozen=True)
class InspectTopic:
    """Follow a topic that need not be shown: its rate and its last message; "" is none."""

    topic: str


@dataclass(frozen=True)
class InspectTransforms:
    """Report on the tree of transforms, or no longer."""

    inspect: bool = True


@dataclass(frozen=True)
class Refresh:
    """Show a new state at once, since somebody asked a panel for something else of it."""


@dataclass(frozen=True)
class ReloadPlugin:
    """Load a file with displays again, after it was saved."""

    path: Path


ViewCommand = (
    ShowView
    | ChangeView
    | ResetView
    | FocusDisplay
    | SaveView
    | RenameView
    | RemoveView
    | StartWithView
    | SaveImage
)
"""What is about views."""

FileCommand = Open | Load | Save | Export
"""What reads or writes configs; it is done beside the frame loop, in order."""

Command = (
    SetProperty
    | AddDisplay
    | RemoveDisplay
    | DuplicateDisplay
    | MoveDisplay
    | SetFixedFrame
    | SetBackground
    | SetFrameRate
    | Reset
    | Pause
    | FileCommand
    | ViewCommand
    | InspectTopic
    | InspectTransforms
    | Refresh
    | ReloadPlugin
)
