"""Messages between the server and its pages: JSON objects whose `type` is the class's name."""

from __future__ import annotations

from typing import Annotated, Any, ClassVar

import msgspec

Number = Annotated[int, msgspec.Meta(ge=0, lt=1 << 53)]
"""Integers both JavaScript and JSON can hold."""


class ToPage(msgspec.Struct, frozen=True, tag=True):
    """A message from the server to a page."""

    is_latched: ClassVar[bool] = False
    """True if only the newest of a kind counts: pages that join receive it, and it replaces
    older ones that wait to be sent."""


class FromPage(msgspec.Struct, frozen=True, tag=True, forbid_unknown_fields=True):
    """A message from a page to the server; it may come from any program."""


class Hello(FromPage, frozen=True):
    """The first message of a page.

    Args:
        key: received over viser's connection of the same page.
    """

    key: str


class Identity(ToPage, frozen=True):
    """The first message to a page: what it may do.

    Args:
        role: "watcher", "operator" or "owner"; see `webviz.server.access.rules`.
        name: of the token of its browser, "" if none is asked for.
    """

    is_latched = True

    role: str
    name: str


class SyncRequest(ToPage, frozen=True):
    """Asks for a `SyncReply` after everything that was sent before."""

    token: str


class SyncReply(FromPage, frozen=True):
    """Says that all has been done that came before the `SyncRequest` with the same token."""

    token: str


class Ping(FromPage, frozen=True):
    """Asks for a `Pong`, by which the page measures the round trip to the server."""


class Pong(ToPage, frozen=True):
    """Answers a `Ping`."""

    is_latched = True


class Heartbeat(ToPage, frozen=True):
    """Says that the server is there; at least every second something does.

    Args:
        wall: its time in seconds since 1970; clocks of browsers may be wrong.
    """

    is_latched = True

    wall: float


class PlaceCamera(ToPage, frozen=True):
    """Puts the camera where a view says.

    Args:
        number: of this request; see `ViewReport`.
        view: its type.
        options: fields of the view that its camera does not show, by name.
        frame: name of the node that is followed, "" for none.
        position, look_at: of the camera and of what it looks at, in metres, in the coordinates of
            the view.
        scale: pixels per metre of a view without perspective.
    """

    number: int
    view: str
    options: dict[str, str | bool]
    frame: str
    position: list[float]
    look_at: list[float]
    scale: float | None


class StartView(PlaceCamera, frozen=True):
    """The same for a page that has just joined; one that was here before stays as it is."""


class ViewReport(FromPage, frozen=True):
    """Says which view a page has, when it has moved its camera or changed its size.

    Args:
        number: of the last request it obeyed.
        view, options: of the last view that it obeyed.
        width, height: of its picture in CSS pixels.
    """

    number: int
    view: str
    options: dict[str, str | bool]
    width: float
    height: float


MAX_PANES = 64
"""Largest number of panes that one page may show."""
Width = Annotated[int, msgspec.Meta(ge=0, le=1 << 16)]
"""Width of a picture on a screen in pixels."""
DisplayId = Annotated[str, msgspec.Meta(max_length=200)]


class ShowPictures(FromPage, frozen=True):
    """Says which displays' pictures a page shows now, and how wide.

    Args:
        widths: by id of the display, in pixels of the screen.
    """

    widths: Annotated[dict[DisplayId, Width], msgspec.Meta(max_length=MAX_PANES)]


class FramesShown(FromPage, frozen=True):
    """Says that a page can take the next pictures.

    Args:
        numbers: of the newest picture it has shown, by id of the display.
    """

    numbers: Annotated[dict[DisplayId, Number], msgspec.Meta(max_length=MAX_PANES)]


class ReadPixel(FromPage, frozen=True):
    """Asks for the value of a pixel of the newest picture of a display."""

    display: DisplayId
    x: Number
    y: Number


class PixelValue(ToPage, frozen=True):
    """Answers a `ReadPixel`; the text is "" if the value is not known."""

    display: str
    x: int
    y: int
    text: str


class SaveCanvas(ToPage, frozen=True):
    """Lets a page download what it shows as a PNG of that name, "" for one made of the time."""

    name: str


class ShownTool(msgspec.Struct, frozen=True):
    """A tool in the toolbar, as the feature that has the tools describes it."""

    id: str
    name: str
    tooltip: str
    shortcut: str
    gesture: str
    icon: str
    surface: bool
    stays: bool
    asks: bool
    refusal: str
    several: tuple[str, ...]


class Tools(ToPage, frozen=True):
    """The toolbar, in order."""

    is_latched = True

    tools: tuple[ShownTool, ...]


class Published(ToPage, frozen=True):
    """A message that a gesture published.

    Args:
        number: of the `CommandRequest` with the gesture.
        topic, message_type: as chosen.
        values: by field.
    """

    number: int
    topic: str
    message_type: str
    values: msgspec.Raw


Share = Annotated[float, msgspec.Meta(ge=-1, le=1)]
"""Share of the highest speed of a vehicle along one axis."""


class Drive(FromPage, frozen=True):
    """The heartbeat of a page with the controls of a vehicle: what is held there.

    Args:
        tool: id of the tool.
        beat: the newest that the page has received in a `DrivingReport`, 0 for none.
        linear, lateral, angular: ahead, to the left and counter-clockwise.
    """

    tool: str
    beat: Number
    linear: Share
    lateral: Share
    angular: Share


class DrivingReport(ToPage, frozen=True):
    """Answers a `Drive`.

    Args:
        tool: id of the tool.
        beat: proves, when it comes back, that the page is alive.
        driver: id of the browser that drives, None if it is free.
        problem: why commands do not reach the robot, with a remedy; "" if they do.
    """

    is_latched = True

    tool: str
    beat: Number
    driver: int | None
    problem: str


class Shell(ToPage, frozen=True):
    """Shows what is around the scene. Without it, as for pictures, a page has the scene only.

    Args:
        debug: whether viser's own panel is shown too.
    """

    is_latched = True

    debug: bool = False


class Watch(FromPage, frozen=True):
    """Asks for the values of a store, now and whenever they change; see `Values`."""

    store: str


class Unwatch(FromPage, frozen=True):
    """Ends a `Watch`."""

    store: str


class Values(ToPage, frozen=True):
    """Changes of a store that the page watches.

    Args:
        store: its name.
        all: whether these are all values, and others that the page knows are gone.
        set: new values by key.
        gone: keys that are no longer there.
    """

    store: str
    all: bool
    set: dict[str, msgspec.Raw]
    gone: tuple[str, ...]


class CommandRequest(FromPage, frozen=True):
    """Asks for a change; the only message by which a page does something that others notice.

    Args:
        number: of the request, for the page to know its `CommandResult`.
        command: name of one of `webviz.server.access.rules.commands`.
        arguments: its fields.
        step: of several that are undone together, the number of the first; else 0.
    """

    number: Number
    command: str
    arguments: dict[str, Any]
    step: Number = 0


class CommandResult(ToPage, frozen=True):
    """Outcome of a `CommandRequest`; what goes on, such as a tool with a goal, has several.

    Args:
        number, command: of the request.
        level: "ok", "warn" or "error".
        text: a sentence, "" if there is nothing to say.
        result: what it made, by name: the id of a new `display`; the `link` and `code` of an
            invitation.
    """

    number: int
    command: str
    level: str
    text: str
    result: dict[str, str]


class Dismissed(ToPage, frozen=True):
    """The last message to a page whose visit the owner has ended.

    Args:
        text: for its user, sentences without markup.
    """

    text: str


class Download(ToPage, frozen=True):
    """Lets a page download a text as a file of that name."""

    name: str
    text: str
