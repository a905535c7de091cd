"""Commands for what a browser selects in the scene."""

from __future__ import annotations

import msgspec

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
