"""The tree of frames laid out in columns: roots left, children right of their parents."""

from __future__ import annotations

from collections.abc import Mapping

import msgspec

from webviz.data.transforms.diagnosis import Diagnosis, FrameReport


class FramePlace(msgspec.Struct, frozen=True):
    """The place of a frame in the picture.

    Attributes:
        column: number of transforms above the frame.
        row: rows of frames do not overlap within a column; a parent is halfway between its first
            and its last child.
    """

    column: int
    row: float


class Edge(msgspec.Struct, frozen=True):
    """A transform from a parent to a child.

    Attributes:
        is_extra: whether the child has its place below another frame: it closes a loop, or comes
            from a publisher that disagrees about the parent.
    """

    parent: str
    child: str
    is_extra: bool = False


class TreeLayout(msgspec.Struct, frozen=True):
    """The layout of a tree.

    Attributes:
        places: of all frames, each right of its parent, in the order of a walk through the tree.
        edges: between them.
        rows: how many the picture has.
    """

    places: Mapping[str, FramePlace]
    edges: tuple[Edge, ...]
    rows: int


def lay_out(diagnosis: Diagnosis) -> TreeLayout:
    """Lay out a tree of frames; leaves take one row each, in the order of their names."""
    children: dict[str, list[FrameReport]] = {}
    for report in sorted(diagnosis.frames, key=lambda report: report.frame):
        children.setdefault(report.parent, []).append(report)
    columns: dict[str, int] = {}
    rows: dict[str, float] = {}
    edges: list[Edge] = []
    next_row = 0
    starts = [*diagnosis.roots, *(loop[0] for loop in diagnosis.loops)]
    # Not recursive: a chain of frames may be longer than Python's stack. A frame comes twice, the
    # second time when all frames below it have a row.
    pending = [(start, 0, False) for start in reversed(starts)]
    while pending:
        frame, column, is_done = pending.pop()
        below = [each.frame for each in children.get(frame, ()) if each.frame != frame]
        if is_done:
            own = [rows[each] for each in below if each in rows and columns[each] == column + 1]
            rows[frame] = (own[0] + own[-1]) / 2 if own else next_row
            next_row += not own
        elif frame not in columns:
            columns[frame] = column
            edges += [Edge(frame, each, each in columns) for each in below]
            pending.append((frame, column, True))
            pending += [(each, column + 1, False) for each in reversed(below)]
    for report in diagnosis.frames:
        others = [parent for parent in report.parents if parent != report.parent]
        edges += [Edge(parent, report.frame, is_extra=True) for parent in others]
    places = {frame: FramePlace(column, rows[frame]) for frame, column in columns.items()}
    return TreeLayout(places, tuple(edge for edge in edges if edge.parent in places), next_row)
