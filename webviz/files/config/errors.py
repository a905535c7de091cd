"""Errors in configs, and hints at valid words."""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable
from typing import Any

from webviz.api.errors import Error
from webviz.data.words import listed, shortened

MAX_HINTS = 40
"""Valid words that an error lists; a tree of transforms may have a thousand frames."""
MAX_SHOWN = 60
"""Characters of a value in an error."""


class ConfigError(Error):
    """A file cannot be used; one sentence that names the file and the place in it."""


def nearest(word: str, valid: Iterable[str]) -> str:
    """Return a hint at the closest valid word, or the list of all."""
    valid = sorted(valid)
    if not valid:
        return "none are known"
    close = difflib.get_close_matches(word, valid, n=1)
    if close:
        return f"did you mean `{close[0]}`?"
    return f"known are: {listed(valid, MAX_HINTS)}"


def unknown_key(key: str, valid: Iterable[str]) -> str:
    """Return the clause for an unknown key."""
    return f"unknown key, {nearest(key, valid)}"


def choices(values: Iterable[object]) -> str:
    """Return the valid values, such as "a, b or c"."""
    *most, last = map(str, values)
    return f"{', '.join(most)} or {last}" if most else last


def excerpt(value: Any) -> str:
    """Return a value as written in a config file, shortened."""
    if value is None:
        return "nothing"
    if isinstance(value, str):
        return f"`{_short(value)}`"
    if isinstance(value, float):
        return f"{value:g}"
    try:
        return _short(json.dumps(value, default=str, ensure_ascii=False))
    except TypeError:  # a key is a date, or a list
        return _short(str(value))


def _short(text: str) -> str:
    return shortened("".join(letter if letter.isprintable() else " " for letter in text), MAX_SHOWN)
