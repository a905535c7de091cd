"""How large a picture may be."""

from __future__ import annotations

from webviz.api.errors import Error

SMALLEST, LARGEST = 16, 8192
"""Edges of a picture in pixels; more a browser without a GPU cannot draw."""


def check_size(size: tuple[int, int]) -> None:
    """Refuse what is no size of a picture.

    Raises:
        Error: one sentence.
    """
    if not all(SMALLEST <= edge <= LARGEST for edge in size):
        raise Error(
            f"A picture has {SMALLEST} to {LARGEST} pixels a side, not {size[0]} x {size[1]}."
        )
