"""The tree of frames as an SVG picture, in the manner of tf2_tools view_frames."""

from __future__ import annotations

import unicodedata
from collections.abc import Sequence
from xml.sax.saxutils import escape

import msgspec

from webviz.data.names import readable
from webviz.data.transforms.diagnosis import Diagnosis, FrameReport, facts
from webviz.data.transforms.layout import Edge, FramePlace, TreeLayout, lay_out
from webviz.data.words import counted

EDGE = 24
"""Around the picture; all lengths are pixels."""
HEAD = 76
BOX_HEIGHT, ROW = 56, 68
GAP = 72
"""Space between columns."""
LINE = 18
CHARACTER = 7.6
"""Width of a usual bold character at 13 pixels; those of East Asia are twice as wide."""
NARROW = 6.2
"""The same of one that is not bold, at 12 pixels."""
MIN_WIDTH, PADDING = 120, 22
MAX_CHARACTERS = 48
MAX_PROBLEMS = 40
STYLE = """\
text { font: 12px "Liberation Sans", Arial, Helvetica, sans-serif; fill: #57606a }
.title { font-size: 18px; font-weight: bold; fill: #1f2328 }
.name { font-size: 13px; font-weight: bold; fill: #1f2328 }
rect { fill: #f6f8fa; stroke: #8c959f; rx: 6px }
path { fill: none; stroke: #0969da; stroke-width: 1.6 }
.static path { stroke: #8c959f; stroke-dasharray: 5 4 }
.fault rect { fill: #ffebe9; stroke: #cf222e; stroke-width: 2 }
.fault path { stroke: #cf222e; stroke-width: 2 }
.fault text.fact, .problem { fill: #cf222e }
"""


class TreePicture(msgspec.Struct, frozen=True):
    """A drawn tree.

    Args:
        svg: the document, UTF-8 when written.
        width, height: in pixels.
    """

    svg: str
    width: int
    height: int


def draw_tree(diagnosis: Diagnosis, title: str, notes: Sequence[str] = ()) -> TreePicture:
    """Draw a tree of frames with rates, ages, publishers and, in red, faults.

    Names come from other machines: they are escaped, and never markup.

    Args:
        diagnosis: the tree.
        title: above the picture.
        notes: sentences below it.
    """
    return _Drawing(diagnosis, lay_out(diagnosis)).picture(title, notes)


class _Drawing:
    def __init__(self, diagnosis: Diagnosis, layout: TreeLayout) -> None:
        self._diagnosis = diagnosis
        self._layout = layout
        self._reports = {report.frame: report for report in diagnosis.frames}
        widths: dict[int, float] = {}
        for frame, place in layout.places.items():
            lines = [_short(frame), *_lines(self._reports.get(frame))]
            width = max(MIN_WIDTH, PADDING + CHARACTER * max(map(_length, lines)))
            widths[place.column] = max(widths.get(place.column, 0.0), width)
        self._widths = [widths[column] for column in sorted(widths)]
        self._lefts = [EDGE + sum(self._widths[:n]) + GAP * n for n in range(len(self._widths))]

    def picture(self, title: str, notes: Sequence[str]) -> TreePicture:
        problems = self._diagnosis.problems
        limited = problems[:MAX_PROBLEMS]
        if len(problems) > len(limited):
            limited.append(f"And {len(problems) - len(limited)} more.")
        texts = [*((text, "problem") for text in limited), *((text, "") for text in notes)]
        bottom = HEAD + ROW * self._layout.rows
        height = round(bottom + LINE * len(texts) + EDGE)
        right = self._lefts[-1] + self._widths[-1] if self._widths else 0.0
        longest = max(NARROW * _length(text) for text, _ in [*texts, (title, "")])
        width = round(max(640.0, right + EDGE, longest + 2 * EDGE))
        lines = [
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}">',
            f"<style>{STYLE}</style>",
            f'<rect width="{width}" height="{height}" style="fill:#ffffff;stroke:none"/>',
            _text(title, EDGE, EDGE + 14, "title"),
            _text(self._summary(len(problems)), EDGE, EDGE + 34),
            *(self._edge(edge) for edge in self._layout.edges),
            *(self._box(frame, place) for frame, place in self._layout.places.items()),
            *(_text(t, EDGE, bottom + LINE * (n + 1), kind) for n, (t, kind) in enumerate(texts)),
            "</svg>",
        ]
        return TreePicture("\n".join(lines) + "\n", width, height)

    def _summary(self, problems: int) -> str:
        if not self._layout.places:
            return "No transforms arrived on /tf or /tf_static."
        static = sum(report.is_static for report in self._diagnosis.frames)
        counts = [
            counted(len(self._layout.places), "frame"),
            f"{len(self._diagnosis.frames) - static} moving (blue)",
            f"{static} static (dashed)",
            f"{counted(problems, 'fault')} (red)" if problems else "no faults",
        ]
        return ", ".join(counts)

    def _box(self, frame: str, place: FramePlace) -> str:
        report = self._reports.get(frame)
        x, y = self._lefts[place.column], _top(place)
        own = [*report.problems] if report else []
        if report is None and len(self._diagnosis.roots) > 1:
            own = ["No transform connects this tree with the others."]
        lines = [
            f'<g class="{_kind(report, bool(own))}">',
            f"<title>{chr(10).join(map(_escaped, [frame, *_lines(report), *own]))}</title>",
            f'<rect x="{x:.0f}" y="{y:.0f}" width="{self._widths[place.column]:.0f}" '
            f'height="{BOX_HEIGHT}"/>',
            _text(_short(frame), x + PADDING / 2, y + 19, "name"),
            *(
                _text(text, x + PADDING / 2, y + 34 + 14 * number, "fact")
                for number, text in enumerate(_lines(report))
            ),
            "</g>",
        ]
        return "".join(lines)

    def _edge(self, edge: Edge) -> str:
        start, end = self._layout.places[edge.parent], self._layout.places[edge.child]
        x1 = self._lefts[start.column] + self._widths[start.column]
        y1, x2, y2 = (
            _top(start) + BOX_HEIGHT / 2,
            self._lefts[end.column],
            _top(end) + BOX_HEIGHT / 2,
        )
        report = self._reports[edge.child]
        bend = GAP / 2 if x2 > x1 else GAP
        return (
            f'<g class="{_kind(report, edge.is_extra or bool(report.problems))}">'
            f'<path d="M{x1:.0f} {y1:.0f} C{x1 + bend:.0f} {y1:.0f} {x2 - bend:.0f} {y2:.0f} '
            f'{x2:.0f} {y2:.0f}"/></g>'
        )


def _lines(report: FrameReport | None) -> Sequence[str]:
    """Return the lines below the name of a frame."""
    if report is None:
        return ("root",)
    texts = facts(report)
    who = [texts.pop()] if report.publishers else []
    return [_short(line) for line in (", ".join(texts), *who)]


def _kind(report: FrameReport | None, is_faulty: bool) -> str:
    kind = "static" if report is not None and report.is_static else "moving"
    return f"{kind} fault" if is_faulty else kind


def _top(place: FramePlace) -> float:
    return HEAD + ROW * place.row


def _text(text: str, x: float, y: float, kind: str = "") -> str:
    named = f' class="{kind}"' if kind else ""
    return f'<text x="{x:.0f}" y="{y:.0f}"{named}>{_escaped(text)}</text>'


def _escaped(text: str) -> str:
    """Return a text in one line, without markup, and without characters that XML does not have."""
    return escape("".join(map(_legal, readable(text, "\N{REPLACEMENT CHARACTER}"))))


def _legal(character: str) -> str:
    is_missing = unicodedata.category(character) in ("Cc", "Cs", "Cn")
    return "\N{REPLACEMENT CHARACTER}" if is_missing else character


def _short(text: str) -> str:
    """Return a text without its middle if it is too long: names differ in their ends."""
    half = MAX_CHARACTERS // 2
    return text if len(text) <= MAX_CHARACTERS else f"{text[:half]}…{text[1 - half :]}"


def _length(text: str) -> int:
    return sum(1 + (unicodedata.east_asian_width(character) in "WF") for character in text)
