"""Commands for what a browser selects in the scene."""

from __future__ import annotations

import msgspec

from webviz.engine.commands.command import Command

Position = tuple[float, float, float]

Pick = tuple[int, int | None, Position, tuple[int, int, int] | None]
"""One thing in a picture.

The id that the browser gave it; its number in the node, None for meshes and images; where it is, or
was clicked on a mesh or image, in the coordinates that were sent (the start of a line, any position
along an arrow); and the colour of a point, None if all have the same.
"""


class Picks(msgspec.Struct, frozen=True):
    """Things of one node.

    Args:
        group, key: of the node in the scene.
        items: see `Pick`.
    """

    group: str
    key: str
    items: tuple[Pick, ...]


class Select(Command, frozen=True):
    """Select things for the browser that sends this, in place of its previous selection.

    Args:
        picks: what is selected anew.
        keep: ids of what was selected before and remains so.
        total: how many things there were to select.
    """

    picks: tuple[Picks, ...] = ()
    keep: tuple[int, ...] = ()
    total: int = 0


class Identify(Command, frozen=True):
    """Answer with one line about a thing, "" if it does not exist any more."""

    picks: Picks


class InspectSelections(Command, frozen=True):
    """Report on what browsers have selected.

    Args:
        holders: ids of the browsers that may have a selection.
        viewers: those that show its values.
        is_picking: whether any browser is about to select.
    """

    holders: frozenset[int] = frozenset()
    viewers: frozenset[int] = frozenset()
    is_picking: bool = False
