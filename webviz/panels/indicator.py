"""The panel Indicator: a value as a lamp and a word, by rules."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Annotated, Any

import msgspec

from webviz.api.declared import Prop
from webviz.api.offer import Offer
from webviz.api.panel import Send, Ui
from webviz.data.messages.paths import FILTERS, as_number
from webviz.data.names import readable
from webviz.engine.state import PanelTab
from webviz.panels.one_path import PathPanel

COLORS = ("green", "yellow", "orange", "red", "blue", "grey")
MAX_RULES = 50
MAX_TEXT = 100
_RULE = re.compile(r"""\s*([=!<>]=|<|>)\s*("[^"]*"|'[^']*'|\S+?)\s*:\s*([a-z]+)\b\s*(.*)""")

Rule = tuple[str, bool | float | str, str, str]
"""Comparison, limit, color and label."""


class Indicator(PathPanel):
    """A value as a lamp with a label, which the first rule that fits chooses."""

    opens = "side"
    icon = "sun"
    module = "indicator.js"

    rules: Annotated[
        list[str],
        Prop(
            help="Rules such as `< 20: red Low` or `== 'IDLE': grey`; colours are green, yellow, "
            "orange, red, blue and grey."
        ),
    ] = msgspec.field(default_factory=list)

    def build(self, ui: Ui, send: Send) -> None:
        """Show the path and the lamp."""
        self.build_path(ui, send)
        self.lamp = ui.widget("indicator", {}, lambda value, browser: None)

    def show(self, offers: Mapping[str, Offer], panels: Sequence[PanelTab]) -> None:
        """Show the value, and the first rule that fits."""
        problem = self.follow(offers, panels)
        if not problem and len(self.values) != 1:
            problem = f"Expected one value, got {len(self.values)}. Add [0] or a filter."
        rules: list[Rule] = []
        for text in self.rules[:MAX_RULES]:
            rule = parse(text)
            if isinstance(rule, str):
                problem = rule
            else:
                rules.append(rule)
        value = self.values[0] if len(self.values) == 1 else None
        color, label = judged(value, rules) if value is not None else ("grey", "")
        self.lamp.show({"color": color, "label": label, "problem": problem})


def parse(text: str) -> Rule | str:
    """Return a rule, or why it is not one."""
    match = _RULE.fullmatch(text[:400])
    if match is None or match[3] not in COLORS:
        colors = ", ".join(COLORS)
        return f"`{text[:80]}` is not a rule. Write it like `< 20: red Low`; colours are {colors}."
    operator, limit, color, label = match.groups()
    return operator, _limit(limit), color, readable(label[:MAX_TEXT])


def judged(value: Any, rules: list[Rule]) -> tuple[str, str]:
    """Return the color and label of a value; grey and the value itself if no rule fits."""
    number = as_number(value)
    text = readable(str(value)[:MAX_TEXT]) if number is None else f"{number:.6g}"
    for operator, limit, color, label in rules:
        own = value if isinstance(limit, str) else number
        fits_type = isinstance(own, str) if isinstance(limit, str) else own is not None
        if fits_type and FILTERS[operator](own, limit):
            return color, label or text
    return "grey", text


def _limit(text: str) -> bool | float | str:
    if text[0] in "\"'":
        return text[1:-1]
    if text in ("true", "false"):
        return text == "true"
    try:
        return float(text)
    except ValueError:
        return text
