"""The tree of frames as a line of text."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

LISTED = 40
"""Frames listed by name; the rest is counted."""


def outline(names: Sequence[str], parents: NDArray[np.int64]) -> str:
    """Each frame with its children in parentheses, such as `map (odom (base (laser, wheel)))`.

    Args:
        names: frame ids.
        parents: int64 (N,), place in `names` of each frame's parent, -1 for roots.
    """
    children: dict[int, list[int]] = {}
    for place, parent in enumerate(parents.tolist()):
        children.setdefault(parent, []).append(place)
    for places in children.values():
        places.sort(key=lambda place: names[place])
    text, listed = "", 0
    # Not recursive: a chain of frames may be longer than Python's stack.
    pending = [iter(children.get(-1, ()))]
    while pending:
        place = next(pending[-1], None)
        if place is None or listed == LISTED:
            pending.pop()
            text += ")" if pending else ""
            continue
        text += ("" if not text or text.endswith(" (") else ", ") + names[place]
        listed += 1
        if place in children:
            text += " ("
            pending.append(iter(children[place]))
    text = text.replace(" ()", "")
    return text + (f" and {len(names) - listed} more" if listed < len(names) else "")
