"""Style sheets that make viser's widgets a list of displays as in RViz."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from webviz.gui.text import COLORS
from webviz.status import Level


class Look(NamedTuple):
    """How one row of the list of displays looks."""

    selected: bool
    level: Level


def list_style(rows: Sequence[Look]) -> str:
    """An element whose style sheet is for the widgets that follow it in its folder.

    Two columns: a check box without its label, and a button that looks like a line of text. A
    browser that does not know `:has` shows them below each other.
    """
    rules = [_LIST]
    for index, row in enumerate(rows):
        # The element itself is the first child, then come two for each row.
        button = f"{_BOX} > :nth-child({2 * index + 3}) button"
        if row.selected:
            rules.append(f"{button} {{ background: {_SELECTED} !important; }}")
        if color := COLORS[row.level]:
            rules.append(f"{button} {{ color: {color} !important; }}")
    return f'<div class="webviz-list"><style>{"".join(rules)}</style></div>'


_SELECTED = "rgba(80, 130, 200, 0.45)"

_BOX = ":has(> div > .webviz-list)"

_LIST = f"""
{_BOX} {{
  display: grid; grid-template-columns: 2em 1fr; align-items: center;
  max-height: 38vh; overflow-y: auto; padding: 0.2em 0.3em 0 0;
}}
{_BOX} > :first-child {{ display: none; }}
{_BOX} > * {{ padding-bottom: 0 !important; margin: 0 !important; }}
{_BOX} > div > div > :first-child:not(:last-child) {{ display: none; }}
{_BOX} button {{
  background: transparent !important; height: 1.7em !important; padding: 0 0.4em; border: 0;
}}
{_BOX} button:hover {{ background: rgba(128, 128, 128, 0.25) !important; }}
{_BOX} button > span {{ justify-content: start; }}
"""
