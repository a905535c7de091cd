"""Messages as text in the style of `ros2 topic echo`, with a limit on its length."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import islice
from typing import Any

import numpy as np

_ARRAY_HEAD = 6
"""How many numbers of an array are shown."""
_LIST_HEAD = 10
"""How many elements of a sequence of messages are shown."""
_STRING_HEAD = 120
"""How many characters of a string are shown: robot descriptions have a million."""


def to_text(message: Any, max_lines: int = 100) -> str:
    """Show a message as YAML-like text.

    Long arrays, sequences and strings are abbreviated, with their full length.

    Args:
        message: What `decode` returned.
        max_lines: How many lines at most; a longer text ends with a line "...".
    """
    lines = list(islice(_lines(message, ""), max_lines + 1))
    if len(lines) > max_lines:
        lines[max_lines - 1 :] = ["..."]
    return "\n".join(lines)


def _lines(message: Any, indent: str) -> Iterator[str]:
    for name in _names(message):
        value = getattr(message, name)
        if (inline := _inline(value)) is not None:
            yield f"{indent}{name}: {inline}"
        elif _names(value):
            yield f"{indent}{name}:"
            yield from _lines(value, indent + "  ")
        else:
            yield f"{indent}{name}:"
            yield from _elements(value, indent)


def _elements(sequence: Any, indent: str) -> Iterator[str]:
    for element in islice(sequence, _LIST_HEAD):
        if (inline := _inline(element)) is not None:
            yield f"{indent}- {inline}"
        else:
            for number, line in enumerate(_lines(element, "")):
                yield f"{indent}{'  ' if number else '- '}{line}"
    if len(sequence) > _LIST_HEAD:
        yield f"{indent}- ... ({len(sequence)} in all)"


def _inline(value: Any) -> str | None:
    """A value that fits on a line, else None."""
    if isinstance(value, str):
        more = f" ... ({len(value)} characters)" if len(value) > _STRING_HEAD else ""
        return repr(value[:_STRING_HEAD]) + more
    if isinstance(value, np.ndarray):
        head = ", ".join(_number(number) for number in value.ravel()[:_ARRAY_HEAD].tolist())
        shape = " x ".join(map(str, value.shape))
        more = f", ... ({shape} {value.dtype})" if value.size > _ARRAY_HEAD else ""
        return f"[{head}{more}]"
    if isinstance(value, tuple) and not _names(value):
        return f"[{', '.join(map(_number, value))}]"
    if _names(value):
        return None
    if hasattr(value, "__len__"):
        return None if len(value) else "[]"
    return _number(value)


def _number(value: Any) -> str:
    """Nine significant digits: what a float32 needs, and millimetres in UTM coordinates."""
    return f"{value:.9g}" if isinstance(value, float) else str(value)


def _names(value: Any) -> tuple[str, ...]:
    """Names of the fields of a message; empty for anything else."""
    if hasattr(type(value), "__getitem__") and not hasattr(value, "_fields"):
        return ()  # a sequence, also if it is built as a struct of arrays
    return getattr(value, "__struct_fields__", None) or getattr(value, "_fields", ())
