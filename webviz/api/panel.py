"""The base class of panels: tabs of the page that show the viewer and send commands.

    class Robots(Panel):
        \"\"\"The known frames.\"\"\"

        title = "Frames"

        def build(self, ui, send):
            ui.button("Reset", lambda browser: send(Reset(), browser))
            self.frames = ui.area()

        def show(self, frames):
            self.frames.table([(frame,) for frame in frames])

All browsers share a panel. Commands are those of `webviz.commands`. Properties are declared as
those of displays, edited in the tab, and kept in the config under `panels`.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Literal, Protocol, TypeVar

from webviz.api.chart import Chart, Remove, SeekTo
from webviz.api.declared import Declared
from webviz.api.lookback import Lookback

T = TypeVar("T")
Modifier = Literal["cmd/ctrl", "cmd/ctrl+shift"]
Act = Callable[[int | None], object]
"""The callback of a button. It gets the id of the browser, in a thread of its own."""
Edit = Callable[[Any, int | None], object]
"""The callback of an edited value. It gets the id of the browser if known."""


class Send(Protocol):
    """Sends commands to the viewer; from any thread, without blocking."""

    def __call__(self, command: Any, browser: int | None = None) -> None:
        """Send a command of `webviz.commands`, on behalf of a browser."""
        ...


class Area(Protocol):
    """A place for text. Each of its methods replaces the previous content."""

    def text(self, text: str) -> None:
        """Show a paragraph of plain text, "" for none."""
        ...

    def lines(self, text: str) -> None:
        """Show plain text with a monospaced font; very long text is cut off."""
        ...

    def table(self, rows: Iterable[Sequence[str]]) -> None:
        """Show texts in rows and columns."""
        ...

    def html(self, markup: str) -> None:
        """Show HTML. Untrusted text must be escaped."""
        ...


class Button(Protocol):
    """A button."""

    @property
    def label(self) -> str:
        """Its text, which may be changed."""
        ...

    @label.setter
    def label(self, label: str) -> None: ...


class Field(Protocol[T]):
    """A value that browsers can edit."""

    @property
    def value(self) -> T:
        """The current value."""
        ...

    def show(self, value: T) -> None:
        """Show this value, unless the field is being edited."""
        ...


class Choice(Field[str], Protocol):
    """One of several texts."""

    def offer(self, values: Sequence[str], current: str) -> None:
        """Offer these values and show the current one, which may be another."""
        ...


@dataclass(frozen=True)
class Slide:
    """One slider of `Sliders`.

    Args:
        name: its label, unique among them.
        value: where it is.
        low, high: its ends.
        unit: such as "rad", "" for none.
    """

    name: str
    value: float
    low: float
    high: float
    unit: str = ""


class Sliders(Protocol):
    """Sliders by name, whose number may change."""

    def show(self, slides: Sequence[Slide]) -> None:
        """Show these sliders, in this order; very many are cut off."""
        ...


class Custom(Protocol):
    """A widget that the module of the panel draws."""

    def show(
        self, values: Mapping[str, Any], parts: Mapping[str, Mapping[str, Any]] | None = None
    ) -> None:
        """Show these values: texts, numbers, switches, and lists and mappings of them.

        Args:
            values: sent as a whole when one of them changes.
            parts: by key; each is sent once, and again only if another object has its key. With
                them long lists grow without being sent again.

        Raises:
            ValueError: they are not, or are too large.
        """
        ...


class Ui(Protocol):
    """The widgets of a panel, one below the other in the order of the calls.

    Labels, values and tooltips are shown as plain text.
    """

    def area(self) -> Area:
        """Add an empty place for text, tables or HTML."""
        ...

    def button(self, label: str, act: Act, hint: str = "", width: float = 1.0) -> Button:
        """Add a button; `width` is its share of the line."""
        ...

    def checkbox(self, label: str, value: bool, edit: Edit, hint: str = "") -> Field[bool]:
        """Add a check box."""
        ...

    def field(self, label: str, value: str, edit: Edit, hint: str = "") -> Field[str]:
        """Add a line of text."""
        ...

    def choice(self, label: str, value: str, edit: Edit, hint: str = "") -> Choice:
        """Add a dropdown; `Choice.offer` fills it."""
        ...

    def sliders(self, edit: Callable[[str, float, int | None], object]) -> Sliders:
        """Add an empty place for sliders; `Sliders.show` fills it.

        Args:
            edit: called with name, value and browser on each move.
        """
        ...

    def chart(self, remove: Remove, seek: SeekTo | None = None) -> Chart:
        """Add a chart of curves over time.

        Args:
            remove: called when a browser removes a curve.
            seek: called when a browser points at a time to go to; None if that is not possible.
        """
        ...

    def widget(
        self, kind: str, values: Mapping[str, Any], use: Callable[[Any, int | None], object]
    ) -> Custom:
        """Add a widget of the panel's own module (`Panel.module`), which draws it.

        Args:
            kind: its name in the module.
            values: as those of `Custom.show`.
            use: called with what the module sends, decoded JSON from a browser, and the browser.
        """
        ...

    def command(
        self, label: str, act: Act, key: str = "", modifier: Modifier | None = None
    ) -> None:
        """Add a command to the list of Ctrl+K.

        Args:
            label: its name there.
            act: its callback.
            key: its keyboard shortcut, "" for none.
            modifier: of the shortcut.
        """
        ...


class Panel(Declared, kw_only=True, dict=True):
    """Base of all panels. Its exceptions are shown in its tab and do not affect other panels."""

    kind = "panel"
    opens: ClassVar[Literal["at start", "side", "below"]] = "at start"
    """The place where it opens: as a tab of each viewer whose config lists no panels ("at start"),
    or once the config or a user adds it: as a tab or, for wide ones, below the scene."""

    icon: ClassVar[str] = "sidebar"
    """An icon as that of a display (`Display.icon`), for the list of panels."""
    rviz_tool: ClassVar[str] = ""
    """The class of a tool that does the same in RViz; files with that tool open the panel."""
    always_reads: ClassVar[bool] = False
    """True if it also reads its topics while its tab is closed, as a log does.

    `take` is then called before `build`.
    """

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        if cls.__dict__.get("on_request") and cls.opens == "at start":  # as before webviz 0.3
            cls.opens = "side"

    def build(self, ui: Ui, send: Send) -> None:
        """Build the tab. Called once, before the first `show`."""

    def show(self, *args: Any, **kwargs: Any) -> None:
        """Show what its parameters name of the viewer: `show(self, frames, clock)`.

        These are fields of `webviz.State`, read-only. A parameter with a default may be one that
        not every viewer has.

        Called by the frame loop a few times a second while the tab is open in a browser, so it must
        be fast.
        """

    def subscriptions(self) -> Mapping[str, str]:
        """Return the topics to read while the tab is open: message types by full name."""
        return {}

    def lookback(self, topic: str) -> Lookback:
        """Return which past messages of one of these topics make up what is shown.

        A seek in a recording reads these. By default the newest.
        """
        return Lookback(count=1)

    def take(self, *args: Any, **kwargs: Any) -> None:
        """Take a message of one of these topics: `take(self, topic, message)`.

        The topic has its full name, as in `subscriptions`; the message is decoded and read-only.
        Two more parameters may be named: `received_ns`, when it came, in ROS time; and `is_past`,
        whether it is remembered and came before what the panel has begun to show (`begun`).

        Called by the frame loop, oldest first.
        """

    @property
    def uses(self) -> tuple[str, ...]:
        """The services and actions it sends to: they may be written unless the config says no."""
        return ()

    def begun(self) -> Collection[str]:
        """Return topics of which it shows something new since the last call, such as a curve.

        `take` gets what is remembered of them, with `is_past`; it may have had some already.
        """
        return ()

    def refuse(self, topic: str, reason: str) -> None:
        """Note why a message of one of these topics cannot be decoded."""

    def start_over(self) -> None:
        """Discard received data: time has gone back, or a user asks for it."""

    def target_frames(self) -> frozenset[str]:
        """Return the frames that what the page draws of the panel follows while the tab is open."""
        return frozenset()

    def publications(self) -> Mapping[str, str]:
        """Return the topics to publish on while the tab is open: message types by full name.

        Messages are sent by the command `webviz.commands.Publish`. Other topics are refused unless
        an owner allows them, and their first messages get lost while subscribers connect.
        """
        return {}
