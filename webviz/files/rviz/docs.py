"""The page on .rviz files, made from those given to `make docs`."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from webviz.api.panel import Panel
from webviz.api.registry import plugin_types
from webviz.api.tool import Tool
from webviz.files.config import read_text
from webviz.files.rviz.displays import NO_DISPLAY
from webviz.files.rviz.document import read
from webviz.files.rviz.report import Report, percent
from webviz.files.rviz.rest import SUPPORTED

PAGE = Path(__file__).parents[3] / "displays/docs/config/rviz.md"
COMMAND = '`make docs RVIZ="FILE.rviz ..."`'

INTRO = """\
# RViz's files

`webviz -d nav2.rviz` opens a file of RViz2 as RViz2 would show it, and `webviz convert` converts in
both directions. Unsupported parts are reported once, on the page and in the terminal, and kept: a
file that was opened and saved has lost no key, and values differ at most in the last digit of
single precision. What RViz's format cannot hold, such as robots and the panel Plot, is reported
when saving.

- Missing keys have RViz2's default: a display without `Enabled` is off, and a TwistStamped without
  `Hide Small Values` hides them. Without `Background Color`, though, the scene follows the theme of
  each page.
- RViz's default QoS becomes `auto`, because RViz writes it whether chosen or not; other values are
  explicit choices. A robot's description is always subscribed with transient local, as in RViz.
- RViz has no automatic QoS. It gets best effort for sensors, which hears every publisher, and
  transient local for maps; `Automatic QoS: true` beside it makes it automatic again here. RViz
  ignores that key, and drops it when it saves the file.
- Out-of-range values are clamped and reported with their line.
- Classes, topics and QoS of ROS 1's RViz are accepted, and written as those of ROS 2.
- Displays of RViz plug-ins are kept, and shown once a webviz plug-in names their class.
- The last of duplicate keys counts, and scalars are read as RViz does: `007` and `on` stay
  unchanged.
"""

WHY = """\
## Not carried over

Unsupported displays stay in the list with a status. Properties count if they affect the scene; the
layout of RViz's panels does not, nor does the shape that RViz draws at the focal point while the
view is turned. A file is complete for `webviz convert --check` if every display, tool, view and
panel, and all these properties, are supported. Unsupported tools and panels stay in the file
unchanged; these are supported: {}. The key `?` has the bindings that `Help` lists, and transforms
are those of tf2, the usual choice of `Transformation`.
"""


def page(paths: Iterable[Path]) -> str:
    """Return the page, with counts of these files."""
    reports = {path.name: read(read_text(path), path.name)[1] for path in paths}
    whole = Report()
    for report in reports.values():
        whole.notes += report.notes
        whole.total += report.total
        whole.carried += report.carried
    kinds = list(next(iter(reports.values())).total) if reports else []
    lines = [INTRO, "## Carried over", "", f"Of {len(reports)} public files:", ""]
    rows = [_counts(name, report, kinds) for name, report in reports.items()]
    rows.append(_counts("**all**", whole, kinds))
    rows.append(("", *(percent(whole.carried[kind], whole.total[kind]) for kind in kinds)))
    lines += table(("file", *kinds), rows)
    classes = [*SUPPORTED["Panels"], *SUPPORTED["Tools"]]
    for base in (Tool, Panel):
        classes += [cls.rviz for cls in plugin_types(base).values() if cls.rviz]
    classes += [cls.rviz_tool for cls in plugin_types(Panel).values() if cls.rviz_tool]
    classes += [cls.rviz_panel for cls in plugin_types(Tool).values() if cls.rviz_panel]
    lines += [
        "",
        WHY.format(", ".join(f"`{re.split('/|::', cls, maxsplit=1)[1]}`" for cls in classes)),
    ]
    missing = Counter(note.what for note in whole.notes if note.reason == NO_DISPLAY)
    if missing:
        rows = [(f"`{cls}`", str(count)) for cls, count in sorted(missing.items())]
        lines += [*table(("unsupported display", "count"), rows), ""]
    return "\n".join([*lines, f"Written by {COMMAND}.", ""])


def _counts(name: str, report: Report, kinds: Sequence[str]) -> tuple[str, ...]:
    return name, *(f"{report.carried[kind]} of {report.total[kind]}" for kind in kinds)


def table(head: tuple[str, ...], rows: Iterable[tuple[str, ...]]) -> list[str]:
    """Lines of a Markdown table."""
    lines = [head, ("---",) * len(head), *rows]
    return [f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in row)} |" for row in lines]
