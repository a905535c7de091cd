"""Text from ROS for the panel: frame ids, topic names and sentences may hold anything at all.

viser shows labels, options and tooltips as text, so `plain` suffices there. What goes into an HTML
element passes through `escape`; nothing goes into Markdown.
"""

from __future__ import annotations

import html
import re
from collections.abc import Mapping

import viser

from webviz.api.status import Level, Status

MAX_LINE = 300
MAX_STATUSES = 40
MAX_LINES = 1000

# Control characters, line ends, marks that reverse what follows, and lone surrogates.
_UNSENDABLE = re.compile("[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069\ud800-\udfff]")

# RViz's colours for warnings and errors, brightened for a dark background.
COLORS = {Level.OK: "", Level.WARN: "#e0a030", Level.ERROR: "#ff6b6b"}
_NOTE = "padding:0 0.75em 0.6em;font-size:0.85em;line-height:1.4;overflow-wrap:anywhere"
MARKS = {Level.OK: "", Level.WARN: "▲", Level.ERROR: "✖"}


def plain(text: str, length: int = MAX_LINE) -> str:
    """Text as one line that can be sent and read from left to right, and is not endless."""
    text = text if len(text) <= length else text[: length - 1] + "…"
    return _UNSENDABLE.sub(" ", text)


def escape(text: str) -> str:
    """Text for an HTML element or attribute, shown literally."""
    return html.escape(plain(text), quote=True)


def note_html(text: str, is_warning: bool = False) -> str:
    """A sentence between controls, "" for none."""
    if not text:
        return ""
    color = f"color:{COLORS[Level.WARN]}" if is_warning else "opacity:0.75"
    return f'<div style="{_NOTE};{color}">{escape(text)}</div>'


def block_html(text: str) -> str:
    """Many lines, shown literally with letters of one width; of very many the first."""
    lines = text.split("\n")
    shown = "\n".join(html.escape(plain(line)) for line in lines[:MAX_LINES])
    if more := len(lines) - MAX_LINES:
        shown += f"\n… and {more} more lines" if more > 0 else ""
    return f'<pre class="webviz-block">{shown}</pre>'


class StatusLines:
    """Statuses in a panel: a line each, coloured by level; of very many the worst ones.

    Args:
        gui: viser's GUI; the lines go into the folder that is open.
    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._shown: dict[str, Status] = {}
        self._lines = gui.add_html("", visible=False)

    def show(self, statuses: Mapping[str, Status]) -> None:
        """Show these from now on."""
        if statuses != self._shown:
            self._shown = dict(statuses)
            self._lines.content = statuses_html(statuses)
            self._lines.visible = bool(statuses)


def statuses_html(statuses: Mapping[str, Status]) -> str:
    """One line for each status, coloured by level; of very many the worst are shown."""
    lines = list(statuses.items())
    if len(lines) > MAX_STATUSES:
        lines = sorted(lines, key=lambda line: -line[1].level)[:MAX_STATUSES]
    rows = [_row(key, status) for key, status in lines]
    if more := len(statuses) - len(lines):
        rows.append(f"<div>… and {more} more</div>")
    return f'<div class="webviz-statuses" style="{_NOTE}">{"".join(rows)}</div>'


def _row(key: str, status: Status) -> str:
    color = COLORS[status.level]
    style = f' style="color:{color}"' if color else ""
    mark = f"{MARKS[status.level]} " if MARKS[status.level] else ""
    return f"<div{style}><b>{mark}{escape(key)}:</b> {escape(status.text)}</div>"
