"""Widgets of panels: recorded here and drawn by pages."""

from __future__ import annotations

import json
import re
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import islice
from typing import Any

from webviz.api.panel import Act, Edit, Slide

MAX_TEXT = 20_000
"""Characters of a text, and of what browsers enter."""
MAX_LINES = 1000
"""Lines of a text, and rows of a table."""
MAX_CELL = 1000
MAX_SLIDES = 300
MAX_HTML = 500_000
MAX_PARTS = 4000
"""Parts of a custom widget."""
SETTLE_S = 0.5
"""Time a field keeps what a browser entered before it shows the panel's value."""

# Half characters, as bytes of another encoding become, cannot be sent.
_UNSENDABLE = re.compile("[\ud800-\udfff]")


class Widget:
    """One widget.

    Args:
        values: what pages need to draw it; replaced as a whole, so that any thread may read them.
    """

    def __init__(self, **values: Any) -> None:
        self.values: Mapping[str, Any] = values
        self.parts: Mapping[str, Any] = {}
        """Values that are sent one by one, by key: the same objects until they change."""

    def set(self, **values: Any) -> None:
        """Change some of the values."""
        self.values = {**self.values, **values}

    def use(self, value: Any, browser: int | None) -> None:
        """Do what a browser did with it."""
        raise ValueError("This widget takes no input.")


class AreaWidget(Widget):
    """A place for text; see `webviz.api.panel.Area`."""

    def __init__(self) -> None:
        super().__init__(kind="area")

    def text(self, text: str) -> None:
        """Show a paragraph."""
        self.values = {"kind": "area", "text": clean(text)}

    def lines(self, text: str) -> None:
        """Show lines in letters of one width."""
        lines = text.split("\n")
        more = len(lines) - MAX_LINES
        texts = [clean(line, MAX_CELL) for line in lines[:MAX_LINES]]
        texts += [f"… and {more} more lines"] if more > 0 else []
        self.values = {"kind": "area", "lines": texts}

    def table(self, rows: Iterable[Sequence[str]]) -> None:
        """Show texts in rows and columns."""
        cells = [[clean(cell, MAX_CELL) for cell in row] for row in islice(rows, MAX_LINES)]
        self.values = {"kind": "area", "table": cells}

    def html(self, markup: str) -> None:
        """Show HTML."""
        if len(markup) > MAX_HTML:
            raise ValueError(f"HTML of {len(markup)} characters; the limit is {MAX_HTML}.")
        self.values = {"kind": "area", "html": clean(markup, MAX_HTML)}


class ButtonWidget(Widget):
    """A button; see `webviz.api.panel.Button`."""

    def __init__(self, label: str, act: Act, hint: str, width: float) -> None:
        super().__init__(kind="button", label=clean(label), hint=clean(hint), width=width)
        self._act = act

    @property
    def label(self) -> str:
        """Return the label."""
        return self.values["label"]

    @label.setter
    def label(self, label: str) -> None:
        self.set(label=clean(label))

    def use(self, value: Any, browser: int | None) -> None:
        """Press it."""
        self._act(browser)


class FieldWidget(Widget):
    """A value that browsers edit; see `webviz.api.panel.Field`."""

    def __init__(self, kind: str, label: str, value: Any, edit: Edit, hint: str) -> None:
        super().__init__(kind=kind, label=clean(label), value=value, hint=clean(hint))
        self._edit = edit
        self._entered_s = -SETTLE_S

    @property
    def value(self) -> Any:
        """Return the current value."""
        return self.values["value"]

    def show(self, value: Any) -> None:
        """Show this value, unless another one has just been entered."""
        if time.monotonic() - self._entered_s > SETTLE_S:
            self.set(value=clean(value) if isinstance(value, str) else value)

    def use(self, value: Any, browser: int | None) -> None:
        """Enter a value."""
        if type(value) is not type(self.value):
            raise ValueError("This value does not fit the widget.")
        if isinstance(value, str) and len(value) > MAX_TEXT:
            raise ValueError(f"At most {MAX_TEXT} characters.")
        self._entered_s = time.monotonic()
        self.set(value=value)
        self._edit(value, browser)


class ChoiceWidget(FieldWidget):
    """One of several texts; see `webviz.api.panel.Choice`."""

    def __init__(self, label: str, value: str, edit: Edit, hint: str) -> None:
        super().__init__("choice", label, value, edit, hint)
        self.set(options=[value])

    def offer(self, values: Sequence[str], current: str) -> None:
        """Offer these values, and the current one even if it is not among them."""
        self.set(options=list(dict.fromkeys(clean(value) for value in (*values, current))))
        self.show(current)

    def use(self, value: Any, browser: int | None) -> None:
        """Choose a value."""
        if value not in self.values["options"]:
            raise ValueError(f"{str(value)[:100]} is no longer available.")
        super().use(value, browser)


class SlidersWidget(Widget):
    """Sliders by name; see `webviz.api.panel.Sliders`."""

    def __init__(self, edit: Callable[[str, float, int | None], object]) -> None:
        super().__init__(kind="sliders", slides=[])
        self._edit = edit

    def show(self, slides: Sequence[Slide]) -> None:
        """Show these."""
        slide_values = [
            {
                "name": clean(each.name, MAX_CELL),
                "value": each.value,
                "low": each.low,
                "high": each.high,
                "unit": each.unit,
            }
            for each in slides[:MAX_SLIDES]
        ]
        if slide_values != self.values["slides"]:
            self.set(slides=slide_values)

    def use(self, value: Any, browser: int | None) -> None:
        """Move one: its new value, a space, and its name."""
        text, _, name = value.partition(" ") if isinstance(value, str) else ("", "", "")
        slide = next((each for each in self.values["slides"] if each["name"] == name), None)
        if slide is None:
            raise ValueError(f"The slider {name[:100]} is gone.")
        try:
            number = float(text)
        except ValueError:
            raise ValueError(f"Expected a number, got {text[:100]}.") from None
        if not slide["low"] <= number <= slide["high"]:
            raise ValueError(f"{number:g} is not in {slide['low']:g} to {slide['high']:g}.")
        self._edit(name, number, browser)


class CustomWidget(Widget):
    """A widget that the module of its panel draws; see `webviz.api.panel.Custom`."""

    def __init__(
        self, kind: str, values: Mapping[str, Any], use: Callable[[Any, int | None], object]
    ) -> None:
        super().__init__(kind=f"own {clean(kind, MAX_CELL)}")
        self._use = use
        self._cache: dict[str, tuple[Mapping[str, Any], Any]] = {}
        self.show(values)

    def show(
        self, values: Mapping[str, Any], parts: Mapping[str, Mapping[str, Any]] | None = None
    ) -> None:
        """Show these values and parts.

        Raises:
            ValueError: they are not JSON, or too large.
        """
        parts = parts or {}
        if len(parts) > MAX_PARTS:
            raise ValueError(f"Expected at most {MAX_PARTS} parts.")
        part_cache: dict[str, tuple[Mapping[str, Any], Any]] = {}
        for key, part in parts.items():
            cached = self._cache.get(key)
            part_cache[key] = cached if cached and cached[0] is part else (part, _as_json(part))
        self.set(values=_as_json(values))
        self._cache = part_cache
        self.parts = {key: part for key, (_, part) in part_cache.items()}

    def use(self, value: Any, browser: int | None) -> None:
        """Pass on what the module sent, as JSON."""
        if not isinstance(value, str) or len(value) > MAX_TEXT:
            raise ValueError(f"Expected at most {MAX_TEXT} characters of JSON.")
        try:
            entered = json.loads(value)
        except (ValueError, RecursionError):
            raise ValueError("Expected JSON.") from None
        self._use(entered, browser)


class Shortcut(Widget):
    """A command of the list of commands."""

    def __init__(self, label: str, act: Act, key: str) -> None:
        super().__init__(label=clean(label), key=key)
        self._act = act

    def use(self, value: Any, browser: int | None) -> None:
        """Do it."""
        self._act(browser)


def _as_json(values: Mapping[str, Any]) -> Any:
    """Plain values that can be sent.

    Raises:
        ValueError: they are not JSON, or too large.
    """
    try:
        encoded = json.dumps(dict(values), allow_nan=False, ensure_ascii=False)
    except (TypeError, ValueError, RecursionError) as error:
        raise ValueError(f"These values are not JSON: {error}.") from None
    if len(encoded) > MAX_HTML:
        raise ValueError(f"Expected values of at most {MAX_HTML} characters of JSON.")
    return json.loads(_UNSENDABLE.sub("\N{REPLACEMENT CHARACTER}", encoded))


def clean(text: str, length: int = MAX_TEXT) -> str:
    """Text that can be sent and is not endless."""
    text = str(text)
    text = text if len(text) <= length else text[: length - 1] + "…"
    return _UNSENDABLE.sub("\N{REPLACEMENT CHARACTER}", text)
