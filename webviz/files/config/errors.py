"""Errors in configs, and hints at valid words."""

from __future__ import annotations

import difflib
from collections.abc import Iterable

from webviz.api.errors import Error
from webviz.data.words import listed

MAX_HINTS = 40
"""Valid words that an error lists; a tree of transforms may have a thousand frames."""


class ConfigError(Error):
    """A file cannot be used; one sentence that names the file and the place in it."""


def nearest(word: str, valid: Iterable[str]) -> str:
    """A hint at the closest valid word, or the list of all."""
    valid = sorted(valid)
    if not valid:
        return "none are known"
    close = difflib.get_close_matches(word, valid, n=1)
    if close:
        return f"did you mean `{close[0]}`?"
    return f"known are: {listed(valid, MAX_HINTS)}"
