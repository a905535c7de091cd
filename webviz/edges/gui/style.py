"""Style sheets that make of viser's widgets a panel as RViz has it.

Each belongs to an HTML element in a folder and is for the widgets that follow it there; a browser
that does not know `:has` shows them as viser does. They are made of constants and numbers only.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from webviz.api.status import Level
from webviz.edges.gui.text import COLORS, note_html

WHOLE = 24
"""The columns of a line in a grid of rows."""


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


def row_style(name: str, spans: Sequence[int]) -> str:
    """The widgets that follow are beside each other, without labels.

    It holds for the whole tab, dialog or folder with a label that it is the first widget of; a
    folder without a label is no container of its own.

    Args:
        name: of this style, without spaces, as part of a class; every container has its own.
        spans: how many of 24 columns each widget has, `WHOLE` for a line of its own as it is; so
            have those that come later.
    """
    box = f":has(> div > .webviz-row-{name})"
    rules = [_ROW.replace("BOX", box)]
    column = 0
    for index, span in enumerate(spans):
        if span != WHOLE:
            cell = f"{box} > :nth-child({index + 2})"
            left, right = column == 0, column + span == WHOLE
            rules.append(_CELL.replace("CELL", cell))
            rules.append(
                f"{cell} {{ grid-column: span {span}; "
                f"margin: 0 {0.4 * right}em 0 {0.4 * left}em !important; }}"
            )
        column = (column + span) % WHOLE
    return f'<div class="webviz-row-{name}"><style>{"".join(rules)}</style></div>'


def failure_html(sentence: str) -> str:
    """A sentence on top of the tab that it is the last widget of, which others' places count."""
    style = (
        ":has(> div > .webviz-failure) { display: grid; } :has(> .webviz-failure) { order: -1; }"
    )
    return f'<div class="webviz-failure"><style>{style}</style>{note_html(sentence, True)}</div>'


def picks_style() -> str:
    """Check boxes on the left of their labels, with little space between."""
    return f'<div class="webviz-picks"><style>{_PICKS}</style></div>'


def panel_style(title: str) -> str:
    """What holds for the whole panel, on screens that are touched too, and what the page is called.

    Args:
        title: text for an attribute, escaped.
    """
    return f'<div class="webviz-panel" data-page-title="{title}"><style>{_PANEL}</style></div>'


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
@media (pointer: coarse) {{
  {_LIST_BOX} {{ grid-template-columns: 2.6em minmax(0, 1fr); max-height: none; }}
  {_LIST_BOX} button {{ height: 2.6rem !important; }}
}}
"""

_ROW = """
BOX { display: grid; grid-template-columns: repeat(24, minmax(0, 1fr)); align-items: start; }
BOX > * { grid-column: 1 / -1; min-width: 0; }
BOX > :first-child { display: none; }
"""
_CELL = """
CELL { padding: 0 0.25em 0.5em !important; }
CELL > div > :first-child:not(:last-child) { display: none; }
CELL button { height: 1.625rem !important; padding: 0 0.2em; font-size: 0.75rem; }
@media (pointer: coarse) { CELL button { height: 2.6rem !important; } }
"""

_PICKS_BOX = ":has(> div > .webviz-picks)"
_PICKS = f"""
{_PICKS_BOX} {{ max-height: 45vh; overflow-y: auto; padding: 0.6em 0.4em 0.2em; }}
{_PICKS_BOX} > :first-child {{ display: none; }}
{_PICKS_BOX} > div {{ padding-bottom: 0.35em; }}
{_PICKS_BOX} > div > div {{ flex-direction: row-reverse; gap: 0.6em; }}
{_PICKS_BOX} > div > div > :first-child {{ flex: 1; padding: 0; }}
{_PICKS_BOX} p, {_PICKS_BOX} label {{ color: inherit !important; letter-spacing: 0; }}
{_PICKS_BOX} > div > div > :last-child {{ display: flex; flex: none !important; }}
"""

_PANEL = """
.webviz-block {
  margin: 0; padding: 0 0.75em 0.75em; font-size: 0.75em; line-height: 1.45;
  overflow-x: auto; white-space: pre;
}
.webviz-table { width: 100%; border-collapse: collapse; font-size: 0.85em; line-height: 1.35; }
.webviz-table td { padding: 0.15em 0.9em; vertical-align: top; overflow-wrap: anywhere; }
.webviz-table td:last-child {
  text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap;
}
.webviz-table small { opacity: 0.65; }
@media (max-width: 36em) {
  [style*="width: 20em"]:has(.webviz-panel) { width: 100vw !important; }
}
@media (pointer: coarse) {
  input.mantine-Input-input { height: 2.5rem !important; min-height: 2.5rem !important; }
  .mantine-Checkbox-root { --checkbox-size: 1.4rem !important; }
  .mantine-Modal-body button { height: 2.6rem !important; }
}
"""
