"""Arguments of programs that start a viewer, refused in one sentence if they are wrong."""

from __future__ import annotations

import logging
import os
import re
from collections.abc import Iterable
from numbers import Real
from pathlib import Path
from typing import Any

import msgspec

from webviz.api.errors import Error
from webviz.engine.commands import mistaken
from webviz.files.config.model import Name

log = logging.getLogger("webviz")
FACTORS = {"": 1.0, "k": 1e3, "M": 1e6, "G": 1e9}
"""Decimal prefixes of ISO 80000."""
LEAST_BITS = 100e3
_RATE = re.compile(r"(\d+(?:\.\d*)?)\s*([kMG]?)bit/s")


def bytes_per_second(text: str) -> float:
    """Return the rate of a link in bytes a second, of a text such as "5Mbit/s".

    Raises:
        Error: the text is not such a rate, or the rate is below 100 kbit/s.
    """
    match = _RATE.fullmatch(text.strip())
    if match is None:
        raise Error(f"{text!r} is not the rate of a link. Write it as 5Mbit/s or 500kbit/s.")
    bits = float(match[1]) * FACTORS[match[2]]
    if not LEAST_BITS <= bits < float("inf"):
        raise Error(f"The rate of the link is {text}; the least is 100kbit/s.")
    return bits / 8


def check_names(names: Iterable[str]) -> None:
    """Refuse what is no name or pattern of a topic, service or action.

    Raises:
        Error: one is invalid.
    """
    for name in names:
        try:
            msgspec.convert(name, Name)
        except msgspec.ValidationError:
            raise Error(
                f"{name!r} is not a valid name to publish on. Use one such as /cmd_vel or /arm/*."
            ) from None


def report_everything(names: Iterable[str]) -> None:
    """Log a warning for each pattern that matches every name, whatever its namespace."""
    for name in names:
        if not name.strip("/*"):
            log.warning(
                "The pattern %s lets operators publish and call everything. List names instead, "
                "such as /cmd_vel or /arm/*.",
                name,
            )


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
