"""Where a display can go from its place in the list."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

from webviz.engine.commands import MoveDisplay

GROUP = "Group"


class Place(NamedTuple):
    """One line of the list.

    Args:
        id: of the display.
        depth: in how many groups it is.
        type: name of the display type; `GROUP` can hold displays.
    """

    id: str
    depth: int
    type: str


@dataclass(frozen=True)
class Moves:
    """A command for each direction, None where there is no way.

    Args:
        up: before the one above, in the same group.
        down: behind the one below, in the same group.
        into: to the end of the next group above, or else of the next one below.
        out: behind the group it is in.
    """

    up: MoveDisplay | None = None
    down: MoveDisplay | None = None
    into: MoveDisplay | None = None
    out: MoveDisplay | None = None


def moves_of(id: str, places: Iterable[Place]) -> Moves:
    """What can be done with the display `id`; each group stands before what is in it."""
    parents: dict[str, str] = {}
    siblings: dict[str, list[Place]] = {}
    branch = [""]
    for place in places:
        del branch[place.depth + 1 :]
        parents[place.id] = branch[-1]
        siblings.setdefault(branch[-1], []).append(place)
        branch.append(place.id)
    if id not in parents:
        return Moves()
    parent = parents[id]
    around = siblings[parent]
    index = next(i for i, place in enumerate(around) if place.id == id)
    above, below = around[:index], around[index + 1 :]
    group = next((place.id for place in (*reversed(above), *below) if place.type == GROUP), "")
    return Moves(
        up=MoveDisplay(id, parent, above[-1].id) if above else None,
        down=MoveDisplay(id, parent, _second(below)) if below else None,
        into=MoveDisplay(id, group) if group else None,
        out=_behind(id, parent, parents[parent], siblings) if parent else None,
    )


def _behind(id: str, group: str, grandparent: str, siblings: dict[str, list[Place]]) -> MoveDisplay:
    around = siblings[grandparent]
    index = next(i for i, place in enumerate(around) if place.id == group)
    return MoveDisplay(id, grandparent, _second(around[index:]))


def _second(places: list[Place]) -> str:
    """What a display goes before to come right behind the first of these; "" is the end."""
    return places[1].id if len(places) > 1 else ""
