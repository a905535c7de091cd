"""Fields of panels that a button reads later."""

from __future__ import annotations

from typing import Any

from webviz.api.errors import Error
from webviz.data.words import number_in


def keep(value: Any, browser: int | None) -> None:
    """Let the widget keep its value."""


def finite(text: str, remedy: str) -> float:
    """Return the number in a field.

    Args:
        text: as entered.
        remedy: what to do if it is not a finite number; a sentence.

    Raises:
        Error: it is not one.
    """
    number = number_in(text)
    if number is None:
        raise Error(f"`{text[:20]}` is not a number. {remedy}")
    return number
