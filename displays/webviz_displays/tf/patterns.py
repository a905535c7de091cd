"""Regular expressions that people enter, without those that may take forever."""

from __future__ import annotations

import re
from collections.abc import Iterator
from re import _constants as kinds  # pyright: ignore[reportAttributeAccessIssue]
from re import _parser as parser  # pyright: ignore[reportAttributeAccessIssue]
from typing import Any

MAX_REPEATS = 3
"""One after the other: the time grows with the length of a name to this power, plus one."""
REPEATS = (kinds.MAX_REPEAT, kinds.MIN_REPEAT, getattr(kinds, "POSSESSIVE_REPEAT", None))


def compiled(text: str) -> re.Pattern[str]:
    """A regular expression.

    Python matches by trying all ways, and nothing else of the program runs meanwhile. `(a+)+$`
    takes hours to find that it does not match 40 letters.

    Raises:
        re.error: it is invalid, or may take too long; the message says why.
    """
    pattern = re.compile(text)
    if _repeats(parser.parse(text)) > MAX_REPEATS:
        raise re.error("its repetitions could take forever")
    return pattern


def _repeats(parts: Any) -> int:
    """How many repetitions follow one another; more than allowed if there are any in one."""
    total = 0
    for kind, value in parts:
        inner = list(_inner(value))
        if kind is kinds.BRANCH:
            total += max(map(_repeats, inner), default=0)
            continue
        total += sum(map(_repeats, inner))
        if kind in REPEATS and value[1] > 1:
            is_nested = any(map(_repeats, inner)) or any(map(_has_branch, inner))
            total += MAX_REPEATS + 1 if is_nested else 1
    return total


def _has_branch(parts: Any) -> bool:
    return any(
        kind is kinds.BRANCH or any(map(_has_branch, _inner(value))) for kind, value in parts
    )


def _inner(value: Any) -> Iterator[Any]:
    """The parts within what the parser says of one part."""
    if isinstance(value, parser.SubPattern):
        yield value
    elif isinstance(value, tuple | list):
        for each in value:
            yield from _inner(each)
