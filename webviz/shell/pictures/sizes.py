"""Limits for the size of pictures."""

from __future__ import annotations

from webviz.api.errors import Error

SMALLEST, LARGEST = 16, 8192
"""Edges of a picture in pixels; browsers without a GPU cannot draw larger ones."""


def check_size(size: tuple[int, int]) -> None:
    """Check the size of a picture.

    Raises:
        Error: it is too small or too large.
    """
    if not all(SMALLEST <= edge <= LARGEST for edge in size):
        raise Error(
            f"A picture must have {SMALLEST} to {LARGEST} pixels per side, not {size[0]} x "
            f"{size[1]}."
        )
