"""Fields of panels that a button reads later."""

from __future__ import annotations

import math
from typing import Any

from webviz.api.errors import Error


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
    try:
        number = float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise Error(f"`{text[:20]}` is not a number. {remedy}")
    return number
