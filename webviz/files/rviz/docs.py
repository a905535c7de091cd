"""The page on .rviz files, from those that are given to `make docs`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from webviz.api.registry import plugin_types
from webviz.api.tool import Tool
from webviz.files.config import read_text
from webviz.files.rviz.displays import NO_DISPLAY
from webviz.files.rviz.document import read
from webviz.files.rviz.report import Report, percent
from webviz.files.rviz.rest import SAME_HERE, WHY_NOT

PAGE = Path(__file__).parents[3] / "displays/docs/config/rviz.md"
COMMAND = '`make docs RVIZ="FILE.rviz ..."`'

INTRO = """\
# RViz's files

`webviz -d nav2.rviz` opens a file of RViz2 as RViz2 would show it, and `webviz convert` makes a
config of it, or the other way round. What has no counterpart here is told once, on the page and in
the terminal, and is kept: a file that was opened and written again has lost no key, and no value
but in the last digit of single precision.

- What a file leaves out has RViz2's default: a display that does not say `Enabled` is off.
- QoS that is RViz's default is `auto` here, as RViz writes it whether somebody chose it or not; all
  else is taken as chosen. A robot's description is always asked for as latched, as RViz does.
- Values out of range are brought into it, and the line in the file is told.
- Classes, topics and QoS of ROS 1's RViz are understood, and written as those of ROS 2.
- A display of a plug-in of RViz is kept, and comes alive once a plug-in of webviz names its class.
- Of a key that is there twice the last one counts; numbers and words are RViz's, so that `007` and
  `on` stay as they are.
"""

WHY = """\
## What is not carried over

Displays that are not here yet are rows of the list that say so. Properties count where they have an
effect: how RViz's panel looks does not. Tools without a counterpart, and panels, stay in the file
as they are:
"""


def page(paths: Iterable[Path]) -> str:
    """The page, with what is carried over of these files."""
    reports = {path.name: read(read_text(path), path.name)[1] for path in paths}
    whole = Report()
    for report in reports.values():
        whole.notes += report.notes
        whole.total += report.total
        whole.carried += report.carried
    kinds = list(next(iter(reports.values())).total) if reports else []
    lines = [INTRO, "## What is carried over", "", f"Of {len(reports)} public files:", ""]
    lines += _table(("file", *kinds), [_counts(name, r, kinds) for name, r in reports.items()])
    lines.append(_row((*_counts("**all**", whole, kinds),)))
    lines.append(_row(("", *(percent(whole.carried[kind], whole.total[kind]) for kind in kinds))))
    lines += ["", WHY]
    here = [f"`{name}`" for names in SAME_HERE.values() for name in names]
    reasons = [(f"`{name}`", reason.partition(";")[0]) for name, reason in WHY_NOT.items()]
    here += [f"`{cls.rviz.partition('/')[2]}`" for cls in plugin_types(Tool).values()]
    told = "carried over: tabs and tools of the page, and what the mouse does"
    rows = [(", ".join(here), told), *reasons]
    lines += [*_table(("tool or panel", "why"), rows), ""]
    missing = Counter(note.what for note in whole.notes if note.reason == NO_DISPLAY)
    if missing:
        rows = [(f"`{cls}`", str(count)) for cls, count in sorted(missing.items())]
        lines += [*_table(("display that is not here yet", "how many"), rows), ""]
    return "\n".join([*lines, f"Written by {COMMAND}.", ""])


def _counts(name: str, report: Report, kinds: Sequence[str]) -> tuple[str, ...]:
    return name, *(f"{report.carried[kind]} of {report.total[kind]}" for kind in kinds)


def _table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> list[str]:
    return [_row(head), _row(("---",) * len(head)), *map(_row, rows)]


def _row(cells: tuple[str, ...]) -> str:
    return f"| {' | '.join(cells)} |"
