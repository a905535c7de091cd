"""Style sheets that make of viser's widgets a list of displays as RViz has it.

Each belongs to an HTML element in a folder and is for the widgets that follow it there; a browser
that does not know `:has` shows them as viser does. They are made of constants and numbers only.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from webviz.gui.text import COLORS
from webviz.status import Level


class Look(NamedTuple):
    """How one row of the list of displays looks."""

    level: Level
    enabled: bool
    selected: bool
    depth: int = 0


def list_style(rows: Sequence[Look]) -> str:
    """Two columns: check boxes without labels, and buttons that look like lines of text."""
    rules = [_LIST]
    for index, row in enumerate(rows):
        # The element itself is the first child; two follow for each row.
        button = f"{_LIST_BOX} > :nth-child({2 * index + 3}) button"
        if row.selected:
            rules.append(f"{button} {{ background: rgba(80, 130, 200, 0.45) !important; }}")
        if color := COLORS[row.level]:
            rules.append(f"{button} {{ color: {color}; }}")
        if row.depth:
            rules.append(f"{button} {{ padding-left: {0.4 + 1.1 * row.depth:.1f}em; }}")
        if not row.enabled:
            rules.append(f"{button} {{ opacity: 0.55; }}")
    return f'<div class="webviz-list"><style>{"".join(rules)}</style></div>'


def row_style() -> str:
    """A choice and a button beside each other."""
    return f'<div class="webviz-row"><style>{_ROW}</style></div>'


_LIST_BOX = ":has(> div > .webviz-list)"
_LIST = f"""
{_LIST_BOX} {{
  display: grid; grid-template-columns: 2.1em minmax(0, 1fr); align-items: center;
  max-height: 38vh; overflow-y: auto; padding: 0.5em 0 0.1em;
}}
{_LIST_BOX} > :first-child {{ display: none; }}
{_LIST_BOX} > * {{ padding-bottom: 0 !important; margin: 0 !important; }}
{_LIST_BOX} > div > div > :first-child:not(:last-child) {{ display: none; }}
{_LIST_BOX} button {{
  background: transparent !important; color: inherit; border: 0;
  height: 1.7em !important; padding: 0 0.4em;
}}
{_LIST_BOX} button:hover {{ background: rgba(128, 128, 128, 0.25) !important; }}
{_LIST_BOX} button > span {{ justify-content: start; }}
{_LIST_BOX} button > span > span {{
  display: block; height: auto; text-box: normal; line-height: 1.5;
  overflow: hidden; text-overflow: ellipsis;
}}
"""

_ROW_BOX = ":has(> div > .webviz-row)"
_ROW = f"""
{_ROW_BOX} {{ display: flex; padding-right: 0.6em; }}
{_ROW_BOX} > :first-child {{ display: none; }}
{_ROW_BOX} > :nth-child(2) {{ flex: 1; }}
{_ROW_BOX} > :nth-child(2) > div > :first-child:not(:last-child) {{ display: none; }}
{_ROW_BOX} > :nth-child(3) {{ margin: 0 !important; }}
{_ROW_BOX} button {{ height: 1.625rem !important; padding: 0 1em; }}
"""
