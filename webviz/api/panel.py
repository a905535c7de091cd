"""What a panel is: a tab of the page that shows the viewer and asks things of it.

    class Robots(Panel):
        \"\"\"Which frames there are.\"\"\"

        title = "Frames"

        def build(self, ui, send):
            ui.button("Reset", lambda browser: send(Reset(), browser))
            self.frames = ui.area()

        def show(self, state):
            self.frames.table([(frame,) for frame in state.frames])

All browsers share a panel. Commands are those of `webviz.commands`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, ClassVar, Literal, Protocol, TypeVar

from webviz.api.declared import Declared

T = TypeVar("T")
Modifier = Literal["cmd/ctrl", "cmd/ctrl+shift"]
Act = Callable[[int | None], object]
"""What a button does. It gets the id of the browser, in a thread of its own."""
Edit = Callable[[Any, int | None], object]
"""What becomes of a new value. It gets the id of the browser if that is known."""


class Send(Protocol):
    """Asks something of the viewer; returns at once, from any thread."""

    def __call__(self, command: Any, browser: int | None = None) -> None:
        """Send a command of `webviz.commands`, on behalf of a browser."""
        ...


class Area(Protocol):
    """A place for text. Each of its methods replaces what it showed before."""

    def text(self, text: str) -> None:
        """Show a paragraph as it is, "" for none."""
        ...

    def lines(self, text: str) -> None:
        """Show lines as they are, in letters of one width; of very many the first."""
        ...

    def table(self, rows: Iterable[Sequence[str]]) -> None:
        """Show texts in rows and columns."""
        ...

    def html(self, markup: str) -> None:
        """Show HTML. What comes from elsewhere must have been escaped."""
        ...


class Button(Protocol):
    """A button."""

    label: str


class Field(Protocol[T]):
    """A value that browsers can edit."""

    @property
    def value(self) -> T:
        """What the field holds now."""
        ...

    def show(self, value: T) -> None:
        """Show this value, unless somebody is editing the field."""
        ...


class Choice(Field[str], Protocol):
    """One of several texts."""

    def offer(self, values: Sequence[str], current: str) -> None:
        """Offer these values and show the current one, which need not be among them."""
        ...


class Ui(Protocol):
    """What a panel is built of: widgets below each other, in the order of the calls.

    Labels, values and tooltips are shown as plain text.
    """

    viser: Any
    """The `viser.ViserServer`, for widgets that are not here; they depend on viser's version."""

    def area(self) -> Area:
        """Add a place for text, tables or HTML, empty at first."""
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
        """Add a list to choose from; `Choice.offer` fills it."""
        ...

    def command(
        self, label: str, act: Act, key: str = "", modifier: Modifier | None = None, icon: str = ""
    ) -> None:
        """Add a command to the palette of Ctrl+K.

        Args:
            label: its name there.
            act: what it does.
            key: calls it, with the modifier if there is one.
            modifier: to hold meanwhile.
            icon: name of a Tabler icon, such as "refresh".
        """
        ...


class Panel(Declared, kw_only=True, dict=True):
    """Base of all panels. What it raises stands in its tab, and the other panels go on."""

    kind: ClassVar[str] = "panel"
    place: ClassVar[int] = 100
    """Tabs with a lower number come first; those with the same one are sorted by name."""

    def build(self, ui: Ui, send: Send) -> None:
        """Add what the tab holds. Called once, before the first `show`."""

    def show(self, state: Any) -> None:
        """Show the viewer as it is, a `webviz.State` to read.

        Called by the frame loop some times a second, so it must not take long.
        """
