"""The tree of frames as a line of text."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

LISTED = 40
"""Frames listed by name; the rest is counted."""


def outline(names: Sequence[str], parents: NDArray[np.int64]) -> str:
    """Each frame with its children in parentheses, such as `map (odom (base (laser, wheel)))`.

    A loop, which has no root, begins with one of its frames: `a (b (c (a, again)))`.

    Args:
        names: frame ids.
        parents: int64 (N,), place in `names` of each frame's parent, -1 for roots.
    """
    children: dict[int, list[int]] = {}
    for place, parent in enumerate(parents.tolist()):
        children.setdefault(parent, []).append(place)
    for places in children.values():
        places.sort(key=lambda place: names[place])
    text, listed = "", set[int]()
    # Not recursive: a chain of frames may be longer than Python's stack.
    by_name = sorted(range(len(names)), key=lambda place: names[place])
    pending = [iter([*children.get(-1, ()), *by_name])]
    while pending:
        place = next(pending[-1], None)
        if place is None or len(listed) == LISTED:
            pending.pop()
            text += ")" if pending else ""
            continue
        if place in listed:
            text += f"{names[place]}, again" if len(pending) > 1 else ""
            continue
        text += ("" if not text or text.endswith(" (") else ", ") + names[place]
        listed.add(place)
        if place in children:
            text += " ("
            pending.append(iter(children[place]))
    text = text.replace(" ()", "")
    rest = len(names) - len(listed)
    return text + (f" and {rest} more" if rest else "")
