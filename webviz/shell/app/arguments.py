"""Paths and numbers that programs give to a viewer, refused in one sentence if they are none."""

from __future__ import annotations

import os
from numbers import Real
from pathlib import Path
from typing import Any

from webviz.api.errors import Error
from webviz.engine.commands import mistaken


def absolute(path: Any, name: str) -> str:
    """Return an absolute path.

    Args:
        path: text or an `os.PathLike`.
        name: of the argument, for the error.

    Raises:
        Error: it is neither.
    """
    if not isinstance(path, str | os.PathLike):
        raise Error(mistaken(name, "a path", path))
    return str(Path(path).absolute())


def number(value: Any, name: str) -> float:
    """Return a number.

    Args:
        value: a number, also one of numpy.
        name: of the argument, for the error.

    Raises:
        Error: it is none.
    """
    if not isinstance(value, Real):
        raise Error(mistaken(name, "a number", value))
    return float(value)
